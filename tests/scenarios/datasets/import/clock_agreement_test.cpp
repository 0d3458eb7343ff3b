#include "scenarios/datasets/import/clock_agreement.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/errors.h"

namespace vsslam {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::ThrowsMessage;

constexpr int64_t kMs = 1'000'000, kStart_ns = 1'700'000'000'000 * kMs;

/// Messages every `every_ms`, that arrive `delay_ms` after their end; what `clock` makes of the time is their stamp.
template <class Clock>
ReceivedStream stream(const std::string& sensor, int64_t every_ms, int64_t delay_ms, Clock&& clock,
                      int64_t from_ms = 0, int64_t until_ms = 10'000) {
  ReceivedStream made{sensor, "/" + sensor, {}};
  for (int64_t ms = from_ms; ms < until_ms; ms += every_ms)
    made.messages.push_back({Time{kStart_ns + (ms + delay_ms) * kMs}, Time{kStart_ns + clock(ms) * kMs}});
  return made;
}

constexpr auto kRight = [](int64_t ms) { return ms; };

int64_t shift_ms(const ClockPlan& plan, const std::string& sensor, size_t message) {
  return plan.shift_of(sensor, message).ns / kMs;
}

TEST(Clocks, ThatAgreeStayAsTheyAre) {
  const ClockPlan plan = plan_clocks(
      {stream("imu", 10, 1, kRight), stream("lidar", 100, 80, kRight), stream("camera", 50, 400, kRight)},
      "a.bag");
  EXPECT_TRUE(plan.shifts.empty());
  EXPECT_THAT(plan.notes, IsEmpty());
  EXPECT_EQ(plan.window.ns, 1'000 * kMs);
}

TEST(Clocks, ThatAllDifferFromTheRecordersAreOne) {
  for (const double rate : {1.0, 0.7}) {  // as a simulation's may
    const auto simulated = [&](int64_t ms) {
      return static_cast<int64_t>(rate * static_cast<double>(ms)) - 1'600'000'000'000;
    };
    const ClockPlan plan =
        plan_clocks({stream("imu", 10, 1, simulated), stream("lidar", 100, 30, simulated)}, "a.bag");
    EXPECT_TRUE(plan.shifts.empty());
    EXPECT_THAT(plan.notes, IsEmpty());
  }
}

TEST(Clocks, OneOfItsOwnIsMovedToWhereTheOthersAre) {
  for (const int64_t off_ms :
       std::initializer_list<int64_t>{-1'600'000'000'000, -40'000, -3'000, 300, 3'000, 3'600'000}) {
    const auto own = [&](int64_t ms) { return ms + off_ms; };
    const ClockPlan plan = plan_clocks({stream("imu", 10, 2, kRight), stream("lidar", 100, 2, own),
                                        stream("camera", 50, 2, own), stream("truth", 20, 2, kRight)},
                                       "a.bag");
    EXPECT_EQ(shift_ms(plan, "lidar", 0), -off_ms);
    EXPECT_EQ(shift_ms(plan, "camera", 99), -off_ms);
    EXPECT_EQ(shift_ms(plan, "imu", 7), 0);
    EXPECT_EQ(shift_ms(plan, "truth", 7), 0);
    ASSERT_EQ(plan.notes.size(), 2u) << off_ms;
    EXPECT_THAT(plan.notes[0], AllOf(HasSubstr("lidar (/lidar)"), HasSubstr("imu (/imu)"),
                                     HasSubstr(off_ms < 0 ? "behind" : "ahead of")));
    EXPECT_EQ(plan.window.ns, 1'000 * kMs);
  }
}

TEST(Clocks, TheOneThatIsNotTheRecordersIsMoved) {
  const auto own = [](int64_t ms) { return ms + 77'000; };
  const ClockPlan plan = plan_clocks({stream("imu", 10, 0, own), stream("lidar", 100, 0, kRight)}, "a.bag");
  EXPECT_EQ(shift_ms(plan, "imu", 0), -77'000);
  EXPECT_EQ(shift_ms(plan, "lidar", 0), 0);
}

TEST(Clocks, SetBackOrAheadAreSetRight) {
  for (const int64_t by_ms : std::initializer_list<int64_t>{-3'600'000, -400, 2'000, 86'400'000}) {
    const auto set = [&](int64_t ms) { return ms < 4'950 ? ms : ms + by_ms; };
    const ClockPlan plan = plan_clocks({stream("imu", 10, 1, set), stream("lidar", 100, 3, set)}, "a.bag");
    EXPECT_EQ(shift_ms(plan, "imu", 494), 0);
    EXPECT_EQ(shift_ms(plan, "imu", 495), -by_ms);
    EXPECT_EQ(shift_ms(plan, "lidar", 49), 0);
    EXPECT_EQ(shift_ms(plan, "lidar", 50), -by_ms);
    ASSERT_EQ(plan.notes.size(), 1u);
    EXPECT_THAT(plan.notes[0], AllOf(HasSubstr("imu (/imu), lidar (/lidar)"),
                                     HasSubstr(by_ms < 0 ? "set back by" : "set ahead by")));
  }
}

TEST(Clocks, SetToTheRecordersTimeAreRightFromThenOn) {
  const auto set = [](int64_t ms) { return ms < 4'950 ? ms - 1'600'000'000'000 : ms; };
  const ClockPlan plan = plan_clocks({stream("imu", 10, 1, kRight), stream("lidar", 100, 1, set)}, "a.bag");
  EXPECT_EQ(shift_ms(plan, "lidar", 0), 1'600'000'000'000);
  EXPECT_EQ(shift_ms(plan, "lidar", 50), 0);
  EXPECT_EQ(shift_ms(plan, "imu", 999), 0);
}

TEST(Clocks, OneStreamsStepIsItsOwn) {
  const auto set = [](int64_t ms) { return ms < 4'950 ? ms : ms - 5'000; };
  const ClockPlan plan = plan_clocks({stream("imu", 10, 1, kRight), stream("lidar", 100, 3, set)}, "a.bag");
  EXPECT_EQ(shift_ms(plan, "lidar", 50), 5'000);
  EXPECT_EQ(shift_ms(plan, "imu", 999), 0);
}

TEST(Clocks, DelaysAreWaitedForAndNoSteps) {
  ReceivedStream lidar = stream("lidar", 100, 10, kRight);
  for (size_t i = 40; i < 60; ++i)  // all at once, when the network is back
    lidar.messages[i].recorded = Time{kStart_ns + (6'000 + static_cast<int64_t>(i)) * kMs};
  const ClockPlan burst = plan_clocks({stream("imu", 10, 1, kRight), lidar}, "a.bag");
  EXPECT_TRUE(burst.shifts.empty());
  EXPECT_NEAR(burst.window.seconds(), 2.04 + 0.25, 0.02);
  EXPECT_THAT(burst.notes,
              ElementsAre(AllOf(HasSubstr("lidar (/lidar): arrives up to 2.0"), HasSubstr("waited for"))));
  const ClockPlan late =
      plan_clocks({stream("imu", 10, 1, kRight), stream("lidar", 100, 3'000, kRight)}, "a.bag");
  EXPECT_TRUE(late.shifts.empty());
  EXPECT_NEAR(late.window.seconds(), 3.0 + 0.25, 0.02);
}

TEST(Clocks, PausesAreNoSteps) {
  const auto paused = [](ReceivedStream s) {
    for (size_t i = s.messages.size() / 2; i < s.messages.size(); ++i) {
      s.messages[i].recorded = s.messages[i].recorded + Duration{100'000 * kMs};
      s.messages[i].end = s.messages[i].end + Duration{100'000 * kMs};
    }
    return s;
  };
  EXPECT_TRUE(
      plan_clocks({paused(stream("imu", 10, 1, kRight)), paused(stream("lidar", 100, 1, kRight))}, "a.bag")
          .shifts.empty());
}

TEST(Clocks, AStrayStampIsNoStep) {
  ReceivedStream imu = stream("imu", 10, 1, kRight);
  imu.messages[500].end = imu.messages[500].end + Duration{1'000'000 * kMs};
  imu.messages[700].end = imu.messages[700].end - Duration{2'000 * kMs};
  EXPECT_TRUE(plan_clocks({imu, stream("lidar", 100, 1, kRight)}, "a.bag").shifts.empty());
}

TEST(Clocks, ReceiptsThatSayNothingLeaveAnErrorThatNamesBoth) {
  ReceivedStream imu = stream("imu", 10, 1, kRight),
                 lidar = stream("lidar", 100, 1, [](int64_t ms) { return ms - 500'000; });
  const auto fails = [](const ReceivedStream& a, const ReceivedStream& b) {
    EXPECT_THAT(
        [&] {
          plan_clocks({a, b}, "a.bag");
        },
        ThrowsMessage<InputError>(
            AllOf(HasSubstr("a.bag"), HasSubstr("imu (/imu"), HasSubstr("lidar (/lidar"))));
  };
  for (ReceivedStream* s : {&imu, &lidar})
    for (Receipt& m : s->messages) m.recorded = Time{0};
  fails(imu, lidar);
  for (ReceivedStream* s : {&imu, &lidar})
    for (Receipt& m : s->messages) m.recorded = m.end;
  fails(imu, lidar);
}

TEST(Clocks, ASensorThatWasOffMayBeOff) {
  EXPECT_TRUE(
      plan_clocks({stream("imu", 10, 1, kRight, 0, 3'000), stream("lidar", 100, 1, kRight, 6'000, 10'000)},
                  "a.bag")
          .shifts.empty());
}

}  // namespace
}  // namespace vsslam

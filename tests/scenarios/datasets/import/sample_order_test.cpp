#include "scenarios/datasets/import/sample_order.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

namespace vsslam {
namespace {

constexpr int64_t kEpoch_ns = 1'700'000'000'000'000'000;
using ::testing::ElementsAre;

/// Hands out what it was given, and remembers how much.
class GivenSamples : public Recording {
 public:
  void imu(int64_t ms) { add(ImuSample{at(ms), Vec3::Zero(), Vec3::Zero(), std::nullopt}, ms); }
  void wheels(int64_t ms) { add(WheelSample{at(ms), 0, 0}, ms); }
  void scan(int64_t ms, int64_t end_ms, size_t points = 1) {
    add(LidarScan{at(ms), at(end_ms), std::vector<LidarPoint>(points)}, end_ms);
  }
  void image(int64_t ms, int64_t end_ms) { add(CameraFrame{at(ms), 0, 0, {}}, end_ms); }
  const RecordingFacts& facts() const override { return facts_; }
  std::optional<RecordedSample> next() override {
    return taken == samples_.size() ? std::nullopt : std::optional(samples_[taken++]);
  }
  Duration window() const override { return needs; }
  size_t taken = 0;
  Duration needs{1'000'000'000};

 private:
  static Time at(int64_t ms) { return {kEpoch_ns + ms * 1'000'000}; }
  void add(Sample sample, int64_t end_ms) { samples_.push_back({std::move(sample), at(end_ms)}); }
  RecordingFacts facts_;
  std::vector<RecordedSample> samples_;
};

/// "i100" for an IMU sample that ended after 100 ms.
std::vector<std::string> order_of(SampleOrder& order) {
  std::vector<std::string> names;
  while (const auto sample = order.next())
    names.push_back(std::string(1, "iwlc"[sample->sample.index()]) +
                    std::to_string(sample->end.ns / 1'000'000));
  return names;
}

TEST(SampleOrder, SortsByEndAndTiesBySensor) {
  GivenSamples given;
  given.image(95, 100), given.scan(0, 100), given.imu(110), given.wheels(100), given.imu(100), given.imu(50);
  SampleOrder order(given);
  EXPECT_THAT(order_of(order), ElementsAre("i50", "i100", "w100", "l100", "c100", "i110"));
}

TEST(SampleOrder, CountsFromTheWholeSecondOfTheEarliestStamp) {
  GivenSamples given;
  given.imu(3400), given.scan(2900, 3500);
  SampleOrder order(given);
  const auto imu = order.next();
  EXPECT_EQ(order.epoch().ns, kEpoch_ns + 2'000'000'000);
  EXPECT_EQ(stamp_of(imu->sample).ns, 1'400'000'000);
  const auto lidar = order.next();
  EXPECT_EQ(stamp_of(lidar->sample).ns, 900'000'000);
  EXPECT_EQ(std::get<LidarScan>(lidar->sample).end.ns, 1'500'000'000);
}

TEST(SampleOrder, DropsWhatComesTooLateAndDuplicates) {
  GivenSamples given;
  given.imu(0), given.imu(1200), given.imu(1200), given.imu(1300), given.imu(2600), given.imu(100);
  given.imu(2700), given.scan(2500, 2600, 0);
  SampleOrder order(given);
  EXPECT_THAT(order_of(order), ElementsAre("i0", "i1200", "i1300", "i2600", "i2700"));
  EXPECT_EQ(order.counts(0).used, 5);
  EXPECT_EQ(order.counts(0).duplicates, 1);
  EXPECT_EQ(order.counts(0).late, 1);
  EXPECT_EQ(order.counts(2).empty, 1);
}

TEST(SampleOrder, HoldsNoMoreThanTheWindow) {
  GivenSamples given;
  for (int i = 0; i < 1000; ++i) given.imu(10 * i);
  SampleOrder order(given, Duration{100'000'000});
  for (size_t used = 1; order.next(); ++used) ASSERT_LE(given.taken, used + 11);
  EXPECT_EQ(order.counts(0).used, 1000);
}

TEST(SampleOrder, WaitsAsLongAsTheRecordingNeedsButNotBeyondItsMemory) {
  GivenSamples given;
  given.needs = Duration{5'000'000'000};
  for (int i = 0; i <= 300; ++i) {
    given.imu(10 * i);
    if (i >= 210 && i % 10 == 0) given.scan(10 * i - 2100, 10 * i - 2000);
  }
  SampleOrder patient(given);
  order_of(patient);
  EXPECT_EQ(patient.counts(2).used, 10);
  EXPECT_EQ(patient.counts(2).late, 0);
  given.taken = 0;
  SampleOrder short_of_memory(given, std::nullopt, 1000);
  order_of(short_of_memory);
  EXPECT_EQ(short_of_memory.counts(2).late, 10);
  EXPECT_EQ(short_of_memory.counts(0).used, 301);
}

TEST(SampleOrder, AStampThatRunsAheadAloneIsDropped) {
  GivenSamples given;
  given.imu(0), given.imu(10), given.wheels(4'000'000), given.imu(20), given.imu(2030);
  given.imu(60'000), given.imu(60'010), given.wheels(60'010), given.scan(100'000, 100'100);
  SampleOrder order(given);
  EXPECT_THAT(order_of(order), ElementsAre("i0", "i10", "i20", "i2030", "i60000", "i60010", "w60010"));
  EXPECT_EQ(order.counts(1).stray, 1);
  EXPECT_EQ(order.counts(2).stray, 1);  // the last of all
  EXPECT_EQ(order.counts(0).late, 0);
}

TEST(SampleOrder, CountsGapsWithTheirPlace) {
  GivenSamples given;
  for (int i = 0; i < 20; ++i) given.scan(100 * i, 100 * i + 99);
  for (int i = 40; i < 60; ++i) given.scan(100 * i, 100 * i + 99);
  for (int i = 62; i < 70; ++i) given.scan(100 * i, 100 * i + 99);  // two missing are no gap
  for (int i = 75; i < 80; ++i) given.scan(100 * i, 100 * i + 99);
  SampleOrder order(given);
  order_of(order);
  EXPECT_EQ(order.counts(2).gaps, 2);
  EXPECT_NEAR(order.counts(2).longest_gap_s, 2.1, 1e-9);
  EXPECT_EQ(order.counts(2).first_gap->ns, kEpoch_ns + 1'900'000'000);
}

}  // namespace
}  // namespace vsslam

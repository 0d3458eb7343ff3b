#include "scenarios/datasets/import/decoders/cloud_decoder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <numbers>

#include "core/errors.h"
#include "scenarios/datasets/messages/sample_messages.h"

namespace vsslam {
namespace {

using Field = PointCloudMessage::Field;
using ::testing::ElementsAre;
using ::testing::FloatNear;
using ::testing::HasSubstr;
using ::testing::Property;
using ::testing::ThrowsMessage;

/// A cloud of rows of numbers, one number per field, written in the fields' types.
struct CloudText {
  PointCloudMessage cloud;

  explicit CloudText(const std::vector<std::pair<std::string, uint8_t>>& fields) {
    cloud.header.stamp = Time{1'700'000'000'000'000'000};
    for (const auto& [name, type] : fields) {
      cloud.fields.push_back({name, cloud.point_step, type, 1});
      cloud.point_step += bytes(type);
    }
  }
  static uint32_t bytes(uint8_t type) {
    return type <= Field::u8 ? 1 : type <= Field::u16 ? 2 : type == Field::f64 ? 8 : 4;
  }
  template <class T>
  void put(double value) {
    const T typed = static_cast<T>(value);
    const auto* from = reinterpret_cast<const uint8_t*>(&typed);
    cloud.data.insert(cloud.data.end(), from, from + sizeof typed);
  }
  CloudText& point(const std::vector<double>& values) {
    for (size_t i = 0; i < values.size(); ++i) {
      switch (cloud.fields[i].datatype) {
        case Field::u8:
          put<uint8_t>(values[i]);
          break;
        case Field::u16:
          put<uint16_t>(values[i]);
          break;
        case Field::u32:
          put<uint32_t>(values[i]);
          break;
        case Field::f32:
          put<float>(values[i]);
          break;
        default:
          put<double>(values[i]);
      }
    }
    ++cloud.width;
    cloud.row_step = cloud.width * cloud.point_step;
    return *this;
  }
};

const std::vector<std::pair<std::string, uint8_t>> kXyz = {
    {"x", Field::f32}, {"y", Field::f32}, {"z", Field::f32}};

std::vector<std::pair<std::string, uint8_t>> xyz_and(std::vector<std::pair<std::string, uint8_t>> more) {
  more.insert(more.begin(), kXyz.begin(), kXyz.end());
  return more;
}

std::vector<float> times(const LidarScan& scan) {
  std::vector<float> result;
  for (const LidarPoint& p : scan.points) result.push_back(p.time_s);
  return result;
}

std::array<float, 6> values(const LidarPoint& p) {
  return {p.x, p.y, p.z, p.intensity, static_cast<float>(p.ring), p.time_s};
}

LidarScan decoded(const PointCloudMessage& cloud) {
  return CloudDecoder({}).decode(cloud, "here");
}

TEST(CloudDecoder, GivesBackOurOwnScanToTheBit) {
  LidarScan scan{Time{1'700'000'000'012'345'678}, {}, {}};
  for (int i = 0; i < 32; ++i)
    scan.points.push_back({0.1f + static_cast<float>(i), -0.3f, 0.7f, static_cast<float>(i),
                           static_cast<uint16_t>(i % 16), 0.1f * static_cast<float>(i) / 32.0f + 2.304e-6f});
  const LidarScan back = decoded(cloud_message(scan, "lidar"));
  EXPECT_EQ(back.stamp, scan.stamp);
  EXPECT_EQ(back.end, scan.stamp + Duration::from_seconds(scan.points.back().time_s));
  ASSERT_EQ(back.points.size(), scan.points.size());
  for (size_t i = 0; i < scan.points.size(); ++i)
    EXPECT_EQ(values(back.points[i]), values(scan.points[i])) << i;
}

TEST(CloudDecoder, ReadsTimesOfEveryKind) {
  const double epoch_s = 1.7e9;
  const auto twice = [](const char* name, uint8_t type, double first, double last) {
    return decoded(CloudText(xyz_and({{"ring", Field::u8}, {name, type}}))
                       .point({5, 0, 0, 0, first})
                       .point({5, 1, 0, 1, last})
                       .cloud);
  };
  EXPECT_THAT(times(twice("time", Field::f32, 0, 0.0625)), ElementsAre(0, 0.0625f));
  EXPECT_THAT(times(twice("t", Field::u32, 0, 62'500'000)), ElementsAre(0, 0.0625f));
  EXPECT_THAT(times(twice("offset_time", Field::u32, 0, 62'500'000)), ElementsAre(0, 0.0625f));
  EXPECT_THAT(times(twice("time", Field::f32, 0, 62'500)), ElementsAre(0, 0.0625f));  // microseconds
  EXPECT_THAT(times(twice("timestamp", Field::f64, epoch_s, epoch_s + 0.0625)), ElementsAre(0, 0.0625f));
  EXPECT_THAT(times(twice("timestamp", Field::f64, epoch_s * 1e9, (epoch_s + 0.0625) * 1e9)),
              ElementsAre(0, FloatNear(0.0625f, 3e-7f)));  // a double's step is 256 ns there
  // Another clock than the stamps': the first point is the stamp's.
  EXPECT_THAT(times(twice("timestamp", Field::f64, 777, 777.0625)), ElementsAre(0, 0.0625f));
}

/// The first times of some clouds 0.1 s apart, the first at `stamp_s`, with points' times from `first_s` on that go on by
/// `step_s` from cloud to cloud.
std::vector<float> first_times(double stamp_s, double first_s, double step_s) {
  CloudDecoder decoder({});
  std::vector<float> first;
  for (int i = 0; i < 4; ++i) {
    CloudText text(xyz_and({{"ring", Field::u8}, {"time", Field::f64}}));
    const double begin_s = first_s + step_s * i;
    text.point({5, 0, 0, 0, begin_s}).point({5, 1, 0, 1, begin_s + 0.0625});
    text.cloud.header.stamp = Time::from_seconds(stamp_s + 0.1 * i);
    first.push_back(decoder.decode(text.cloud, "here").points.front().time_s);
  }
  return first;
}

TEST(CloudDecoder, TimesThatGoOnAreNotCountedFromTheStamps) {
  const auto zero = FloatNear(0, 1e-6f);
  EXPECT_THAT(first_times(1.0, 1.0, 0.1), ElementsAre(zero, zero, zero, zero));  // a simulated clock
  EXPECT_THAT(first_times(0.0, 0.0, 0.1), ElementsAre(zero, zero, zero, zero));
  EXPECT_THAT(first_times(1.7e9, 0.0, 0.1), ElementsAre(zero, zero, zero, zero));  // since it was switched on
  EXPECT_THAT(first_times(1.7e9, 3.0, 0.1), ElementsAre(zero, zero, zero, zero));
  EXPECT_THAT(first_times(0.1, 0.0, 0.0), ElementsAre(zero, zero, zero, zero));
  const auto early = FloatNear(0.01f, 1e-6f);
  EXPECT_THAT(first_times(1.7e9, 0.01, 0.0), ElementsAre(early, early, early, early));
}

TEST(CloudDecoder, TimesThatAreAllTheSameAreASnapshot) {
  CloudDecoder decoder({});
  CloudText text(xyz_and({{"ring", Field::u8}, {"time", Field::f32}}));
  text.point({5, 0, 0, 0, 0}).point({0, 5, 0, 1, 0}).point({-5, 0, 0, 2, 0});
  const LidarScan scan = decoder.decode(text.cloud, "here");
  EXPECT_THAT(times(scan), ElementsAre(0, 0, 0));
  EXPECT_FALSE(scan.times_known);
  EXPECT_TRUE(scan.rings_known);
  EXPECT_EQ(scan.end, scan.stamp);
  EXPECT_THAT(decoder.notes(), ElementsAre(HasSubstr("all the same")));
}

/// A column of `lasers` lasers, every degree from -10 degrees on, and the next ones; each point with this ring.
LidarScan with_rings(int lasers, int sheet, const std::function<double(int)>& ring_of, std::string& note) {
  CloudDecoder decoder({.rings = sheet});
  CloudText text(xyz_and({{"ring", Field::f32}, {"time", Field::f32}}));
  for (int column = 0; column < 200; ++column)
    for (int laser = 0; laser < lasers; ++laser) {
      const double elevation = (laser - 10) * std::numbers::pi / 180, azimuth = -0.01 * column;
      text.point({9 * std::cos(elevation) * std::cos(azimuth), 9 * std::cos(elevation) * std::sin(azimuth),
                  9 * std::sin(elevation), ring_of(laser), 0.0005 * column});
    }
  LidarScan scan = decoder.decode(text.cloud, "here");
  note = decoder.notes().empty() ? "" : decoder.notes().front();
  return scan;
}

TEST(CloudDecoder, RingsThatSayNothingFollowFromTheElevation) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<std::function<double(int)>> wrong = {
      [](int) { return 0; }, [&](int) { return nan; }, [](int laser) { return laser + 1000; },
      [](int laser) { return laser - 3; }, [](int laser) { return 0.5 * laser; }};
  for (const int lasers : {16, 32, 64, 100})
    for (const auto& ring_of : wrong) {
      std::string note;
      const LidarScan scan = with_rings(lasers, lasers, ring_of, note);
      EXPECT_TRUE(scan.rings_known);  // the elevations gather cleanly
      EXPECT_THAT(note, HasSubstr("the field of rings says nothing"));
      ASSERT_EQ(scan.points.size(), static_cast<size_t>(200 * lasers));
      for (const LidarPoint& p : scan.points)
        ASSERT_NEAR(std::asin(p.z / 9) * 180 / std::numbers::pi, p.ring - 10, 1e-3);
    }
}

TEST(CloudDecoder, APointOfARingThatThereIsNotIsLeftOut) {
  std::string note;
  int read = 0;
  const LidarScan scan = with_rings(
      16, 16, [&](int laser) { return read++ == 500 ? 77 : laser; }, note);
  EXPECT_TRUE(scan.rings_known);
  EXPECT_EQ(scan.points.size(), 3199u);
  EXPECT_THAT(note, HasSubstr("left out"));
}

TEST(CloudDecoder, AnotherNumberOfLasersIsFoundByElevation) {
  CloudText text(kXyz);
  for (int column = 0; column < 100; ++column)
    for (int laser = 0; laser < 24; ++laser) {
      const double elevation = 0.02 * laser + 0.001 * laser * laser, azimuth = 0.01 * column;
      text.point({std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
                  std::sin(elevation)});
    }
  const LidarScan scan = CloudDecoder({.rings = 16}).decode(text.cloud, "here");
  int highest = 0;
  for (const LidarPoint& p : scan.points) highest = std::max<int>(highest, p.ring);
  EXPECT_EQ(highest, 23);
  EXPECT_TRUE(scan.rings_known);  // the elevations gather cleanly
  EXPECT_FALSE(scan.times_known);
}

TEST(CloudDecoder, MovesAStampFromTheLastPointToTheFirst) {
  const LidarScan scan = decoded(CloudText(xyz_and({{"ring", Field::u8}, {"time", Field::f32}}))
                                     .point({5, 0, 0, 0, -0.0625})
                                     .point({5, 1, 0, 0, 0})
                                     .cloud);
  EXPECT_EQ(scan.stamp.ns, 1'700'000'000'000'000'000 - 62'500'000);
  EXPECT_EQ(scan.end.ns, 1'700'000'000'000'000'000);
  EXPECT_THAT(times(scan), ElementsAre(0, 0.0625f));
}

TEST(CloudDecoder, SortsByTimeAndDropsWhatIsNoPoint) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  CloudText text(xyz_and({{"intensity", Field::u8}, {"ring", Field::u16}, {"time", Field::f32}}));
  text.point({5, 0, 0, 200, 3, 0.05}).point({nan, 0, 0, 1, 0, 0}).point({0, 0, 0, 1, 0, 0});
  text.point({6, 0, 0, 7, 2, 0.01}).point({6, 0, 0, 7, 2, nan});
  const LidarScan scan = decoded(text.cloud);
  EXPECT_THAT(times(scan), ElementsAre(0.01f, 0.05f));
  EXPECT_EQ(scan.points[1].intensity, 200);
  EXPECT_EQ(scan.points[1].ring, 3);
}

/// One revolution of a VLP-16, clockwise from `start_deg`, seen at 10 m; in order of firing or ring by ring.
PointCloudMessage revolution(double start_deg, bool by_ring) {
  CloudText text(kXyz);
  const auto add = [&](int column, int ring) {
    const double azimuth = (start_deg - column) * std::numbers::pi / 180,
                 elevation = (2 * ring - 15) * std::numbers::pi / 180;
    text.point({10 * std::cos(elevation) * std::cos(azimuth), 10 * std::cos(elevation) * std::sin(azimuth),
                10 * std::sin(elevation)});
  };
  if (by_ring) {
    for (int ring = 0; ring < 16; ++ring)
      for (int column = 0; column < 360; ++column) add(column, ring);
  } else {
    for (int column = 0; column < 360; ++column)
      for (int ring = 0; ring < 16; ++ring) add(column, ring);
  }
  return text.cloud;
}

TEST(CloudDecoder, DerivesTimesFromAzimuthAndRingsFromElevation) {
  for (const bool by_ring : {false, true}) {
    CloudDecoder decoder({});
    const LidarScan scan = decoder.decode(revolution(17, by_ring), "here");
    ASSERT_EQ(scan.points.size(), 5760u);
    for (size_t i = 0; i < scan.points.size(); ++i) {
      const LidarPoint& p = scan.points[i];
      const double azimuth_deg = std::atan2(p.y, p.x) * 180 / std::numbers::pi;
      const double turned_deg = std::remainder(17 - azimuth_deg - 3600 * p.time_s, 360);
      ASSERT_NEAR(turned_deg, 0, 1e-3) << i << by_ring;
      ASSERT_GE(p.time_s, i == 0 ? 0 : scan.points[i - 1].time_s);
      ASSERT_NEAR(std::asin(p.z / 10) * 180 / std::numbers::pi, 2 * p.ring - 15, 1e-3) << i;
    }
    EXPECT_EQ(decoder.notes().size(), 2u);
  }
}

TEST(CloudDecoder, TakesTheTurnsDurationFromTheStamps) {
  CloudDecoder decoder({});
  PointCloudMessage cloud = revolution(0, false);
  decoder.decode(cloud, "here");
  cloud.header.stamp = cloud.header.stamp + Duration{50'000'000};
  EXPECT_NEAR(decoder.decode(cloud, "here").points.back().time_s, 0.05 * 359 / 360, 1e-6);
}

TEST(CloudDecoder, UndistortedPointsAreOfTheStamp) {
  const LidarScan scan = CloudDecoder({.undistorted = true}).decode(revolution(0, true), "here");
  EXPECT_EQ(scan.points.back().time_s, 0);
  EXPECT_EQ(scan.end, scan.stamp);
}

TEST(CloudDecoder, SpreadsRingsOfOtherLidarsEvenly) {
  CloudText text(kXyz);
  for (int ring = 0; ring < 8; ++ring) text.point({std::cos(0.1 * ring), 0, std::sin(0.1 * ring)});
  const LidarScan scan = CloudDecoder({.rings = 8}).decode(text.cloud, "here");
  for (int ring = 0; ring < 8; ++ring) EXPECT_EQ(scan.points[static_cast<size_t>(ring)].ring, ring);
}

TEST(CloudDecoder, ManyRowsOfNothingAreNothing) {
  PointCloudMessage cloud = CloudText(xyz_and({{"ring", Field::u8}})).cloud;
  cloud.height = 4'294'967'295u;
  EXPECT_TRUE(decoded(cloud).points.empty());
}

TEST(CloudDecoder, MalformedCloudsAreErrorsWithAPlace) {
  const auto fails = [](const PointCloudMessage& cloud, const char* what) {
    EXPECT_THAT(
        [&] { CloudDecoder({}).decode(cloud, "a.bag: /points message 7"); },
        ThrowsMessage<InputError>(::testing::AllOf(HasSubstr("a.bag: /points message 7"), HasSubstr(what))));
  };
  const PointCloudMessage good =
      CloudText(xyz_and({{"ring", Field::u8}})).point({1, 2, 3, 4}).point({1, 2, 3, 5}).cloud;
  EXPECT_EQ(decoded(good).points.size(), 2u);
  PointCloudMessage bad = good;
  bad.data.pop_back();
  fails(bad, "25 bytes of data");
  bad = good;
  bad.width = 4'000'000'000u;
  fails(bad, "4000000000");
  bad = good;
  bad.height = 4'000'000'000u;
  fails(bad, "4000000000");
  bad = good;
  bad.fields[2].offset = 12;
  fails(bad, "\"z\"");
  bad = good;
  bad.fields[1].datatype = 9;
  fails(bad, "\"y\"");
  bad = good;
  bad.fields[0].name = "u";
  fails(bad, "u y z ring");
  bad = good;
  bad.is_bigendian = true;
  fails(bad, "big-endian");
  fails(CloudText(xyz_and({{"time", Field::f64}})).point({1, 2, 3, 0}).point({1, 2, 3, 1e30}).cloud, "span");
}

}  // namespace
}  // namespace vsslam

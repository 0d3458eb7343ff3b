#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "slam/inertial/imu_units.h"

namespace vsslam {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

ImuSample sample_at(int i, const Vec3& gyro, const Vec3& accel) {
  ImuSample sample;
  sample.stamp = Time{10'000'000 * int64_t{i}};
  sample.gyro_radps = gyro;
  sample.accel_mps2 = accel;
  return sample;
}

TEST(ImuUnits, TurnsGIntoMetresFromTheFirstSampleOn) {
  ImuUnits units(ImuCalibration{});
  for (int i = 0; i < 60; ++i) {
    const ImuSample repaired = units.repaired(sample_at(i, Vec3::Zero(), {0, 0.1, 1}));
    EXPECT_NEAR(repaired.accel_mps2.z(), 9.80665, 1e-9);
  }
  ASSERT_EQ(units.repairs_said().size(), 1u);
  EXPECT_THAT(units.repairs_said()[0], HasSubstr("given in g"));
}

TEST(ImuUnits, LeavesMetresAlone) {
  ImuUnits units(ImuCalibration{});
  for (int i = 0; i < 60; ++i)
    EXPECT_EQ(units.repaired(sample_at(i, Vec3::Zero(), {0, 0, 9.8})).accel_mps2.z(), 9.8);
  EXPECT_THAT(units.repairs_said(), IsEmpty());
}

TEST(ImuUnits, OneLightSampleIsNoUnit) {
  ImuUnits units(ImuCalibration{});
  units.repaired(sample_at(0, Vec3::Zero(), {0, 0, 1}));
  for (int i = 1; i < 60; ++i) units.repaired(sample_at(i, Vec3::Zero(), {0, 0, 9.8}));
  EXPECT_THAT(units.repairs_said(), IsEmpty());
  EXPECT_EQ(units.repaired(sample_at(60, Vec3::Zero(), {0, 0, 9.8})).accel_mps2.z(), 9.8);
}

TEST(ImuUnits, RatesBeyondAnyGyroscopeAreDegrees) {
  ImuUnits units(ImuCalibration{});
  for (int i = 0; i < 4; ++i) units.repaired(sample_at(i, {0, 0, 20}, {0, 0, 9.8}));  // a spike, as yet
  EXPECT_FALSE(units.newly_in_degrees());
  EXPECT_NEAR(units.repaired(sample_at(4, {0, 0, 20}, {0, 0, 9.8})).gyro_radps.z(), 0.349, 1e-3);
  EXPECT_TRUE(units.newly_in_degrees());
  EXPECT_FALSE(units.newly_in_degrees());  // told once
}

TEST(ImuUnits, RatesSlowerThanThatAreComparedWithTheLidar) {
  for (const double factor : {1.0, 57.3}) {
    ImuUnits units(ImuCalibration{});
    constexpr double kRate_radps = 0.1;
    for (int i = 0; i <= 600; ++i) {
      units.repaired(sample_at(i, {0, 0, factor * kRate_radps}, {0, 0, 9.8}));
      if (i > 0 && i % 10 == 0)
        units.compare(Time{10'000'000 * int64_t{i - 10}}, Time{10'000'000 * int64_t{i}},
                      SE3::from_rpy({0, 0, 0.1 * kRate_radps}, Vec3::Zero()));
    }
    EXPECT_EQ(units.newly_in_degrees(), factor > 1);
  }
}

}  // namespace
}  // namespace vsslam

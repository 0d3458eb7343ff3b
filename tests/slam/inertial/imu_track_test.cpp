#include "slam/inertial/imu_track.h"

#include <gtest/gtest.h>

namespace vsslam {
namespace {

ImuSample sample(int index, const Vec3& gyro_radps, const Vec3& accel_mps2) {
  return {Time{index * 10'000'000LL}, gyro_radps, accel_mps2, {}};
}

const Vec3 kTurning(0.1, 0, 0.4), kStanding(0.2, -0.1, 9.8);

TEST(ImuTrack, ASpikeGoesWholeHoweverItIsDirected) {
  for (const Vec3& direction : {Vec3(1, 0, 0), Vec3(1, -1, 1), Vec3(0.2, 0.6, -0.5)}) {
    ImuTrack track({});
    for (int i = 0; i < 5; ++i) {
      const bool spike = i == 2;
      track.add(sample(i, kTurning + (spike ? 1.0 : 0.0) * direction.normalized(),
                       kStanding + (spike ? 25.0 : 0.0) * direction.normalized()));
    }
    EXPECT_LT((track.samples()[2].gyro_radps - kTurning).norm(), 1e-12) << direction.transpose();
    EXPECT_LT((track.samples()[2].accel_mps2 - kStanding).norm(), 1e-12) << direction.transpose();
  }
}

TEST(ImuTrack, TheNewestSampleCountsOnceTheNextConfirmsIt) {
  ImuTrack track({});
  track.add(sample(0, kTurning, kStanding));
  track.add(sample(1, kTurning + Vec3(0, 0, 2), kStanding));
  EXPECT_EQ(track.samples()[1].gyro_radps, kTurning);
  track.add(sample(2, kTurning + Vec3(0, 0, 2.1), kStanding));
  EXPECT_EQ(track.samples()[1].gyro_radps, kTurning + Vec3(0, 0, 2));
  EXPECT_EQ(track.samples()[2].gyro_radps, kTurning + Vec3(0, 0, 2.1));
}

TEST(ImuTrack, AStepAndASmallBumpStay) {
  ImuTrack track({});
  const Vec3 bump = Vec3(1, 1, 1).normalized();
  for (int i = 0; i < 8; ++i)
    track.add(
        sample(i, kTurning + (i >= 4 ? 2.0 : 0.0) * Vec3::UnitZ(), kStanding + (i == 2 ? 15.0 : 0.0) * bump));
  EXPECT_NEAR(track.samples()[4].gyro_radps.z(), kTurning.z() + 2, 1e-12);
  EXPECT_LT((track.samples()[2].accel_mps2 - kStanding - 15 * bump).norm(), 1e-12);
}

}  // namespace
}  // namespace vsslam

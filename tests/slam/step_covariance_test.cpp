#include "slam/step_covariance.h"

#include <gtest/gtest.h>

#include <cmath>

namespace vsslam {
namespace {

// Along x only the priors tell, whose steps may err alike; along y only the scans do, both of them.
TEST(StepCovariance, ComesFromThePriorsWhereScansAreBlindAndElseFromBothScans) {
  StepCovariance step;
  Vec6 known = Vec6::Constant(1e-6);
  known[3] = 1;
  const SE3 T_step(Quat::Identity(), {0.1, 0, 0});
  step.add_key(SE3(), known.asDiagonal());
  Vec6 prior = Vec6::Constant(0.01);
  prior[3] = 4e-6;
  for (int scan = 0; scan < 10; ++scan) {
    step.add_prediction(SE3(), prior.asDiagonal(), 0.1, 0, false);
  }
  const Mat6 covariance = step.add_key(T_step, known.asDiagonal());
  EXPECT_NEAR(covariance(3, 3), 100 * 4e-6, 2e-6);
  EXPECT_NEAR(covariance(4, 4), 2e-6 + 1e-6 * 0.01, 1e-7);  // and the lever of the rotation
}

// The prior claims 4e-6 from scan to scan, and is off by a quarter of that variance: at the end of a scan it is off by
// 1e-6, a third of it on average, in both key scans.
TEST(StepCovariance, CountsByWhatScansWereBent) {
  StepCovariance step;
  const Mat6 known = 1e-8 * Mat6::Identity(), claimed = known + 4e-6 * Mat6::Identity();
  const Vec6 off = Vec6::Constant(std::sqrt(claimed(0, 0)) / 2);
  const auto scan = [&] {
    step.add_prediction(SE3(), claimed - known, 0.1, 0.1, false);
    step.add_registration(off, claimed, known);
  };
  for (int i = 0; i < 200; ++i) scan();
  step.add_key(SE3(), known);
  for (int i = 0; i < 200; ++i) scan();
  const Mat6 covariance = step.add_key(SE3(), known);
  for (int k = 0; k < 6; ++k) EXPECT_NEAR(covariance(k, k), 2 * (1e-6 / 3 + 1e-8), 2e-8) << k;
}

// Scans of a tenth of a second, a second apart: by a velocity that is unsure by 1 m/s they are bent by 10 cm.
TEST(StepCovariance, AVelocityBendsAScanByItsOwnTimeOnly) {
  StepCovariance step;
  const Mat6 known = 1e-8 * Mat6::Identity();
  step.add_key(SE3(), known);
  step.add_prediction(SE3(), Mat6::Identity(), 1, 0.1, false);
  const Mat6 covariance = step.add_key(SE3(), known);
  EXPECT_NEAR(std::sqrt(covariance(3, 3)), 0.1 / std::sqrt(3), 1e-3);
  EXPECT_NEAR(step.unseen()(3, 3), 2e-8, 1e-10);  // both scans saw how far it was
}

// An IMU of known noise errs as it claims even where the scans happen to agree with it, and its turns err anew each scan;
// its velocity's error lasts.
TEST(StepCovariance, BelievesTheNoiseOfAnImuThatWasMeasured) {
  StepCovariance step;
  const Mat6 known = Mat6::Identity(), prior = 1e-6 * Mat6::Identity();
  step.add_key(SE3(), known);
  for (int i = 0; i < 10; ++i) {
    step.add_prediction(SE3(), prior, 0.1, 0, true);
    step.add_registration(Vec6::Zero(), prior + 1e-9 * Mat6::Identity(), 1e-9 * Mat6::Identity());
  }
  const Mat6 covariance = step.add_key(SE3(), known);
  EXPECT_NEAR(covariance(0, 0), 10e-6, 1e-9);
  EXPECT_NEAR(covariance(3, 3), 100e-6, 2e-8);
}

}  // namespace
}  // namespace vsslam

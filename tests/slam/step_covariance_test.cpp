#include "slam/step_covariance.h"

#include <gtest/gtest.h>

namespace vsslam {
namespace {

// Along x only the priors tell, each step by itself; along y only the scans do, both of them.
TEST(StepCovariance, ComesFromThePriorsWhereScansAreBlindAndElseFromBothScans) {
  StepCovariance step;
  Vec6 known = Vec6::Constant(1e-6);
  known[3] = 1;
  const SE3 T_step(Quat::Identity(), {0.1, 0, 0});
  step.add_key(SE3(), known.asDiagonal());
  Mat6 pose = 1e-4 * Mat6::Identity();  // what was known before does not count
  Vec6 prior = Vec6::Constant(0.01);
  prior[3] = 4e-6;
  for (int scan = 0; scan < 10; ++scan) {
    const Mat6 predicted = pose + Mat6(prior.asDiagonal());
    step.add_prediction(SE3(), pose, predicted);
    pose = predicted;
  }
  const Mat6 covariance = step.add_key(T_step, known.asDiagonal());
  EXPECT_NEAR(covariance(3, 3), 10 * 4e-6, 1e-7);
  EXPECT_NEAR(covariance(4, 4), 2e-6 + 1e-6 * 0.01, 1e-7);  // and the lever of the rotation
}

}  // namespace
}  // namespace vsslam

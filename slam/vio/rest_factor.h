// Two frames between which the robot stood still: in place of the IMU factor.
#pragma once

#include <ceres/sized_cost_function.h>

#include "core/calibration.h"
#include "slam/vio/rest_detector.h"

namespace vsslam {

/// Variables: pose and motion of the frame in which rest began, pose and motion of the later frame; see
/// ImuFactor. Residuals, whitened: the motion between the frames, both velocities, what the gyroscope and the
/// accelerometer read on average, steps of the biases. Its size does not grow with the time of rest.
class RestFactor final : public ceres::SizedCostFunction<24, 7, 9, 7, 9> {
 public:
  RestFactor(const RestMeans& means, double between_s, const ImuCalibration& imu);
  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override;

 private:
  RestMeans means_;
  Vec3 up_force_vio_;  // specific force at rest
  Eigen::Matrix<double, 24, 1> weights_;
};

}  // namespace vsslam

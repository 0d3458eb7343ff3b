#include "slam/inertial/gyro_bias.h"

namespace vsslam {

void GyroBias::correct(const Vec3& rotation_error, const Mat3& observed, double dt_s) {
  constexpr double kLargestError = 0.05;  // rad between two scans: a slip of the registration, not a bias
  variance_ += walk_ * walk_ * dt_s;
  if (rotation_error.norm() > kLargestError || dt_s <= 0) return;
  const double measurement_variance = 2.0 * lidar_sigma_rad_ * lidar_sigma_rad_ / (dt_s * dt_s);
  const double gain = variance_ / (variance_ + measurement_variance);
  bias_radps_ -= gain * (observed * rotation_error) / dt_s;
  if (observed.trace() > 2.5) variance_ *= 1.0 - gain;
}

}  // namespace vsslam

#include "slam/inertial/gyro_bias.h"

namespace vsslam {

void GyroBias::correct(const Vec3& rotation_error, const Mat3& observed, double lidar_sigma_rad,
                       double dt_s) {
  constexpr double kLargestError = 0.05;  // rad between two scans: a slip of the registration, not a bias
  variance_ += walk_ * walk_ * dt_s;
  if (rotation_error.norm() > kLargestError || dt_s <= 0) return;
  const double measurement_variance = 2.0 * lidar_sigma_rad * lidar_sigma_rad / (dt_s * dt_s);
  const double gain = variance_ / (variance_ + measurement_variance);
  bias_radps_ -= gain * (observed * rotation_error) / dt_s;
  if (observed.trace() > 2.5) variance_ *= 1.0 - gain;
}

}  // namespace vsslam

// What the front end itself says of how it fared: what was not seen, not believed, lost, and repaired.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/time.h"

namespace vsslam {

struct OdometryHealth {
  int64_t scans = 0;
  double range_sigma_m = 0;  ///< the noise of ranges that the thresholds follow: set, or measured
  double voxel_m = 0;            ///< features were thinned by, at last
  int64_t scans_prior_only = 0;  ///< the LiDAR gave nothing: the prior alone gave the pose
  int64_t scans_blind = 0;       ///< that saw some direction worse than 5 cm: along it the prior decided
  int64_t steps = 0;               ///< from key scan to key scan
  int64_t steps_unsure = 0;        ///< of these, known no better than 10 cm
  double worst_step_sigma_m = 0;   ///< of all, along the direction that is known worst
  int64_t scans_unconverged = 0;
  int64_t prior_refused = 0;     ///< scans whose prior contradicted the LiDAR and was not believed
  std::optional<Eigen::Vector2d> imu_noise;  ///< densities believed at last: gyro rad/s/rtHz, accelerometer m/s^2/rtHz
  int64_t wheels_slipped = 0;    ///< scans since whose predecessor the wheels slid against the IMU and were not believed
  int64_t scans_ringless = 0;    ///< whose rings said nothing, and were derived or done without
  int64_t imu_repaired = 0;      ///< samples whose unit was wrong beyond doubt, and was set right
  /// A stretch of scans in which the pose was not known well enough to be worth a figure.
  struct LostSpan {
    Time begin, end;    ///< stamps of its first and last scan
    int64_t scans = 0;
    std::string why;    ///< "too few planes", "no overlap with the map", ...
  };
  std::vector<LostSpan> lost;
  std::vector<std::string> repairs;   ///< what was certain and set right, one line each, in order
  std::vector<std::string> warnings;  ///< what is doubtful or makes the result worthless, one line each, in order
};

}  // namespace vsslam

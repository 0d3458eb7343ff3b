// Settings of a rotating multi-beam LiDAR. Every source of error has its own switch: 0 or false turns it off
// and leaves all others as they were.
#pragma once

#include "core/config.h"
#include "sensors/lidar/laser_table.h"

namespace vsslam {

struct LidarConfig {
  enum class ReturnMode { strongest, last };

  LidarModel model = LidarModel::vlp16;
  double rate_hz = 10;  ///< revolutions per second
  ReturnMode return_mode = ReturnMode::strongest;
  double min_range_m = 0.9, max_range_m = 100;
  double range_step_m = 0.002;  ///< 0: not quantised
  bool pose_per_firing = true;  ///< false: the whole scan from the pose at its stamp

  double range_sigma_m = 0.007;       ///< random part, per return
  double laser_bias_sigma_m = 0.004;  ///< fixed per laser
  double incidence_bias_scale = 1;    ///< 1: as measured on an HDL-32E (Laconte et al., ICRA 2019)
  double intensity_sigma = 1;         ///< of the reflectivity byte

  double azimuth_step_deg = 0.01;            ///< of the reported azimuth
  double azimuth_jitter_sigma_deg = 0.005;   ///< of the reported azimuth, white, per data block
  double rotation_wander_sigma_deg = 0.037;  ///< of the true azimuth against even rotation
  double rotation_wander_time_s = 0.035;     ///< how fast it changes

  bool dropout = true;            ///< weak echoes are lost
  double detection_range_m = 45;  ///< where a surface of albedo 0.1, seen head-on, returns half of the time
  double detection_sigma = 0.15;  ///< noise of the received power against the threshold, relative

  int sub_rays = 1;  ///< rays per beam; more than 1: the beam has a footprint, and edges give mixed pixels
  double divergence_horizontal_mrad = 3.0, divergence_vertical_mrad = 1.5;  ///< full angle at 1/e^2
  double pulse_length_ns = 5;  ///< echoes nearer than half of this flight merge

  void fields(Fields& f);
  /// Geometry and timing of the device without any error.
  static LidarConfig ideal(LidarModel model = LidarModel::vlp16);
};

}  // namespace vsslam

// How noisy an IMU is where it is mounted: its sheet holds for a table, and a robot shakes it.
#pragma once

#include <deque>
#include <optional>

#include "core/calibration.h"
#include "core/samples.h"

namespace vsslam {

class ImuNoise {
 public:
  /// `factor` on the densities of `sheet` (gyro: rad/s/rtHz, accelerometer: m/s^2/rtHz); measured where it is nullopt.
  ImuNoise(const ImuCalibration& sheet, std::optional<double> factor);
  /// The samples from `from` to `to`, in order of time; once for each of them.
  void listen(const std::deque<ImuSample>& samples, Time from, Time to);
  /// Never below the sheet's, if measured.
  double gyro_radps_rthz() const { return gyro_density_; }
  double accel_mps2_rthz() const { return accel_density_; }

 private:
  double sheet_gyro_, sheet_accel_;
  bool measures_;
  double gyro_density_, accel_density_;
  double gyro_variance_ = 0, accel_variance_ = 0;  // of the densities' squares, running means
  int spans_ = 0;
};

}  // namespace vsslam

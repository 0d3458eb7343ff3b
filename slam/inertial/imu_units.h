// Sets right what is beyond doubt about an IMU's units.
#pragma once

#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "core/calibration.h"
#include "core/samples.h"
#include "core/se3.h"

namespace vsslam {

/// Specific force in g, rates in degrees.
class ImuUnits {
 public:
  explicit ImuUnits(const ImuCalibration& imu) : imu_(imu) {}

  /// The sample in m/s^2 and rad/s. The unit of the force follows from the first samples: nothing on earth that drives
  /// feels 0.5 to 2 m/s^2 at its start.
  ImuSample repaired(ImuSample sample);
  /// What the LiDAR saw the base turn from one scan to the next: tells whether the rates are in degrees.
  void compare(Time from, Time to, const SE3& T_base_from_to);

  /// Once, when it turned out that the rates are in degrees: from now on they are converted, and what was learnt from
  /// them is void.
  bool newly_in_degrees();
  /// The samples before the one that told, in the units that they turned out to have.
  const std::deque<ImuSample>& recent() const { return recent_; }
  bool repairs() const { return in_g_ || in_degrees_; }
  /// What was set right, one line each.
  const std::vector<std::string>& repairs_said() const { return repairs_said_; }

 private:
  void weigh(const ImuSample& sample);
  void watch_rates(double rate);
  void judge_rates();
  void take_as_degrees();
  std::optional<double> gyro_scale() const;  // over the LiDAR's; nothing before the robot has turned enough to tell
  std::optional<Vec3> turned(Time from, Time to) const;

  ImuCalibration imu_;
  bool in_g_ = false, in_degrees_ = false, rates_judged_ = false, newly_in_degrees_ = false;
  int weighed_ = 0, too_fast_ = 0;
  double force_sum_mps2_ = 0;
  std::deque<ImuSample> recent_;  // as they came, but for the units
  double dot_ = 0, lidar2_ = 0, gyro2_ = 0;  // rad^2, sums over pairs of scans
  std::vector<std::string> repairs_said_;
};

}  // namespace vsslam

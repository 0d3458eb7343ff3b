// Looks at the samples that a front end is given, and at what it makes of them. Knows no truth: the LiDAR, where it saw,
// is what the other sensors are compared with.
#pragma once

#include <array>
#include <deque>
#include <optional>
#include <vector>

#include "core/calibration.h"
#include "core/samples.h"
#include "scenarios/health/health.h"
#include "scenarios/health/motion_agreement.h"
#include "scenarios/health/sample_clock.h"
#include "slam/inertial/wheel_track.h"
#include "slam/scan_report.h"

namespace vsslam {

/// What the source of the samples says: what it dropped, set right and found doubtful.
struct SourceHealth {
  std::map<std::string, int64_t> imu_dropped{}, wheels_dropped{}, lidar_dropped{}, camera_dropped{};
  std::vector<std::string> repairs{}, warnings{};
};

/// Its memory does not grow with the run. Samples in the order in which the front end gets them.
class SensorDoctor {
 public:
  explicit SensorDoctor(const RigCalibration& rig) : rig_(rig) {}

  void add(const ImuSample& sample);
  void add(const WheelSample& sample);
  void add(const CameraFrame& image);
  void add(const LidarScan& scan, const ScanReport& report);

  /// The facts so far, with what follows from them.
  Health health(const OdometryHealth& odometry, const SourceHealth& source) const;

 private:
  struct ForceSum {
    Vec3 sum_base = Vec3::Zero();
    double sum_of_norms = 0;
    int64_t count = 0;
    void add(const ImuSample& sample, const Mat3& R_base_imu);
  };

  void compare_gyro(Time from, Time to, const Vec3& rotation_base);
  void compare_wheels(Time from, Time to, double forward_m, double yaw_rad);
  void weigh_force(Time from, Time to);
  void forget_before(Time stamp);
  ImuHealth imu_health() const;
  CameraHealth camera_health() const;
  void tell_times(const SampleClock& clock, SensorHealth& sensor) const;

  RigCalibration rig_;
  SampleClock imu_clock_, wheel_clock_, lidar_clock_, camera_clock_;
  // Since the last scan, or so long as a comparison may reach.
  std::deque<ImuSample> imu_;
  std::deque<WheelSample> wheels_;
  WheelTurns wheel_turns_;
  std::optional<StampedPose> last_odom_base_;  // of the last scan in which the LiDAR gave something
  ForceSum force_, force_at_rest_;
  MotionAgreement gyro_;
  std::array<MotionAgreement, 3> gyro_axis_;
  MotionAgreement travel_, yaw_;
  int64_t points_ = 0, without_points_ = 0;
  bool first_prior_only_ = false,
       first_unconverged_ = false;  // the first scan, which has no map to be matched with
  double grey_sum_ = 0;
  int64_t dark_ = 0, frozen_ = 0;
  std::vector<uint8_t> last_grey_;
};

}  // namespace vsslam

// What the other sensors say about the motion between and during scans: it undistorts the scan, is the first
// guess of its pose, and decides where the LiDAR is blind.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "core/calibration.h"
#include "core/config.h"
#include "core/samples.h"
#include "core/se3.h"
#include "slam/lidar/cloud.h"

namespace vsslam {

/// A short motion as knots T_begin_t of the base frame; the first is the identity at `begin`.
class MotionPath {
 public:
  explicit MotionPath(Time begin) : knots_{{begin, SE3()}} {}
  /// Stamps must increase; a knot at or before the last one is ignored.
  void append(Time stamp, const SE3& T_begin_t);

  const std::vector<StampedPose>& knots() const { return knots_; }
  const SE3& end_pose() const { return knots_.back().pose; }
  /// Geodesic between knots; constant velocity of the nearest piece beyond the last.
  SE3 at(Time stamp) const;
  /// The same motion with another end, end_pose() * exp(change), approached at a steady rate.
  MotionPath bent(const Vec6& change) const;

 private:
  std::vector<StampedPose> knots_;
};

/// The pose of a scan after its registration, and what of it the LiDAR has observed.
struct OdometryFix {
  Time stamp;
  SE3 T_odom_base;
  Mat6 covariance = 1e-6 * Mat6::Identity();     ///< of T_odom_base, right perturbation: LiDAR and prior together
  Mat3 observed_rotation = Mat3::Identity();     ///< projector on the observed directions, base frame
  Mat3 observed_translation = Mat3::Identity();  ///< likewise
};

/// What is known when the first scan arrives.
struct InitialState {
  SE3 T_odom_base;
  Vec3 gyro_bias_radps = Vec3::Zero();  ///< IMU frame
  double gyro_bias_sigma_radps = 0.01;
  bool at_rest = false;
  Vec3 accel_bias_mps2 = Vec3::Zero();  ///< IMU frame
  bool feels_gravity = true;            ///< else the accelerometer is worth nothing
};

/// vio: camera and IMU, wheel_imu while they restart; wheel_imu: IMU and wheels; imu: IMU; wheel: wheels; constant_velocity:
/// the LiDAR alone.
enum class PriorKind { vio, wheel_imu, imu, wheel, constant_velocity };

struct InertialConfig {
  double rest_gyro_radps = 0.02;  ///< IMU counts as at rest below this spread of the gyroscope ...
  double rest_accel_mps2 = 0.15;  ///< ... and of the accelerometer
  double spike_gyro_radps = 0.5;  ///< a single sample this far from its neighbours is replaced by the median
  double spike_accel_mps2 = 20.0;
  double max_gap_s = 0.12;                 ///< samples further apart are a dropout; nearer, a motion goes on between them
  double max_speed_mps = 30.0;             ///< beyond this a velocity estimate is discarded
  double max_turn_radps = 3.0;             ///< as fast as anything on the ground turns
  /// How a robot's velocity changes that nothing measures: a car brakes by 3 m/s^2, the Scout by 1.
  double unknown_accel_mps2 = 2.0, unknown_turn_radps2 = 2.0;
  /// On the densities of the sheet, which hold for an IMU on a table. Automatic: as noisy as its samples are, and no less
  /// than the sheet says.
  std::optional<double> imu_noise_factor;
  double gyro_scale_sigma = 0.005;      ///< share of each turn: scale and axes off (MEMS, factory calibrated: 0.2-1 %)
  double accel_bias_sigma_mps2 = 0.05;  ///< when the IMU is turned on (MTi-300: 0.02-0.05)
  /// Wheels slip and skid: error of the way, and of the turn, as shares of them.
  double wheel_slip = 0.03, wheel_turn_slip = 0.2;
  void fields(Fields& f);
};

/// How visual odometry fares.
struct VisualReport {
  int restarts = 0;  ///< so far
  SE3 T_start_base;  ///< the prior's motions since the first fix, one after another: what it is worth alone
};

/// Predicts motion of the base. Implementations survive missing sensors: what is not covered by samples is
/// continued at the velocity of the last two fixes.
class MotionPrior {
 public:
  virtual ~MotionPrior() = default;
  /// Called once, before the first path().
  virtual void start(const InitialState& state) = 0;
  virtual void add(const ImuSample&) {}
  virtual void add(const WheelSample&) {}
  virtual void add(const CameraFrame&) {}
  /// Motion from `begin`, the stamp of the last fix, to `end`. Never throws, always finite.
  virtual MotionPath path(Time begin, Time end) const = 0;
  /// Of T_odom_base at `end`: the last fix moved along path(last fix, end). Right perturbation [rotation; translation].
  virtual Mat6 covariance(Time end) const = 0;
  /// The same of the motion since the last fix alone.
  virtual Mat6 step_covariance(Time end) const = 0;
  /// Called once per scan, in order.
  virtual void correct(const OdometryFix& fix) = 0;
  /// The undistorted scan of the last fix.
  virtual void add_scan(Time /*stamp*/, const Cloud& /*points_lidar*/, const SE3& /*T_odom_base*/) {}
  /// Intervals between scans in which the wheels slid, and were not believed.
  virtual int64_t slips() const { return 0; }
  /// The densities that the IMU is believed to have now, of a prior that uses one: gyro rad/s/rtHz, accelerometer m/s^2/rtHz.
  virtual std::optional<Eigen::Vector2d> imu_noise() const { return std::nullopt; }
  /// Whether the robot is known to have stood between the last two fixes.
  virtual bool stood() const { return false; }
  /// Of a prior that sees.
  virtual std::optional<VisualReport> visual_report() const { return std::nullopt; }
};

/// Not for `vio`, see slam/vio_prior.h.
std::unique_ptr<MotionPrior> make_motion_prior(PriorKind kind, const InertialConfig& config,
                                               const RigCalibration& rig);

}  // namespace vsslam

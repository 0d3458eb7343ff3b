// The priors `imu` and `wheel_imu`: an error-state Kalman filter of the IMU's pose, velocity and biases (Sola 2017, arXiv
// 1711.02508) that preintegration carries from scan to scan, the way of the wheels measures and the registered scans
// correct. Where up is in odom is a part of the state, as in FAST-LIO2: odom is where the first scan was, and what that
// was tilted by is not known better than the accelerometer's bias.
#pragma once

#include "slam/inertial/dead_reckoning.h"
#include "slam/inertial/imu_noise.h"
#include "slam/inertial/imu_span.h"
#include "slam/inertial/motion_prior.h"

namespace vsslam {

class ImuPrior : public MotionPrior {
 public:
  ImuPrior(const InertialConfig& config, const RigCalibration& rig, bool use_wheels);

  void start(const InitialState& state) override;
  void add(const ImuSample& sample) override { imu_.add(sample); }
  void add(const WheelSample& sample) override { without_imu_.add(sample); }
  MotionPath path(Time begin, Time end) const override;
  Mat6 covariance(Time end) const override;
  Mat6 step_covariance(Time end) const override;
  void correct(const OdometryFix& fix) override;
  int64_t slips() const override { return slips_; }
  bool stood() const override { return stood_; }
  std::optional<Eigen::Vector2d> imu_noise() const override {
    return Eigen::Vector2d(noise_.gyro_radps_rthz(), noise_.accel_mps2_rthz());
  }
  const ImuBias& bias() const { return state_.bias; }
  const FixHistory& fixes() const { return without_imu_.fixes(); }

 private:
  static constexpr int kStates = 18;
  using Vec18 = Eigen::Matrix<double, kStates, 1>;
  using Mat18 = Eigen::Matrix<double, kStates, kStates>;
  /// Of the IMU's origin. Errors: [rotation; position; velocity; gyro bias; accel bias; gravity], rotation and position as
  /// right perturbations of T_odom_imu, velocity and gravity in odom. The gravity's length is known.
  struct State {
    SE3 T_odom_imu;
    Vec3 v_odom = Vec3::Zero();
    ImuBias bias;
    Vec3 gravity_odom = Vec3::Zero();
    Mat18 P = Mat18::Identity();
    /// All but the pose, which the registrations give.
    void add_to_rest(const Vec18& change);
  };
  static Mat18 transition(const ImuPreintegration& motion, const Mat3& R_before, const Mat3& R_after);
  static Eigen::Matrix<double, kStates, 9> noise_input(const ImuPreintegration& motion, const Mat3& R_before);
  Mat18 motion_noise(const ImuPreintegration& motion, const Mat3& R_before) const;
  void measure_noise(Time from, Time to);
  struct Prediction {
    State state;
    MotionPath path;
    bool slipped = false;  // the wheels, by five sigma: not believed
  };
  /// From `begin`, the stamp of the state. Nothing if samples of the IMU are missing.
  std::optional<Prediction> predict(const State& before, Time begin, Time end) const;
  /// F: the transition of the whole motion.
  void measure_way(const State& before, const ImuPreintegration& motion, const Mat18& F, Prediction& prediction) const;
  void note_slip(bool slipped, Time since, Time now);
  void restart(const OdometryFix& fix, double dt_s);
  bool stands(Time from, Time to);
  void stand_still();

  InertialConfig config_;
  ImuCalibration sheet_;  // its noise as believed
  ImuNoise noise_;
  ImuTrack imu_;
  DeadReckoning without_imu_;
  State state_;  // at the last fix
  bool feels_force_ = true;  // else the gyroscope alone tells, and velocity goes on
  int64_t slips_ = 0;
  std::optional<Time> slipping_since_;
  Time last_slip_{};
  ImuBias start_bias_;
  double gyro_bias_sigma_radps_ = 0.01;
  std::optional<ImuBias> rest_;  // what the IMU gives at rest, if it began so
  bool speed_was_known_ = false;
  bool stood_ = false;           // until the last fix
  int rest_scans_ = 0;           // that it is the mean of
};

}  // namespace vsslam

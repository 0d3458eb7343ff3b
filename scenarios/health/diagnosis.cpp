#include "scenarios/health/diagnosis.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

namespace vsslam {

namespace {

// In so many scans without the LiDAR the robot's path is the prior's, not this method's.
constexpr double kWorthlessShare = 0.5;
constexpr double kFollowedShare = 0.1;  // of the scans: so many more say nothing of what the prior says
// So long a robot at walking pace is not seen for half a metre.
constexpr double kLongGap_s = 0.5;
// Fewer intervals than this are a sensor's slowness, not a gap.
constexpr double kGapIntervals = 3;
// A fifth of the samples lost is more than a busy recorder loses.
constexpr double kDroppedShare = 0.2;
// At rest: the bias of a cheap accelerometer is 0.3 m/s^2 at most. Over a whole drive, vibration makes the mean larger.
constexpr double kGravityAtRest_mps2 = 0.5, kGravityMoving_mps2 = 2;
// A specific force in units of g is 1 within a few percent.
constexpr double kOneG_low = 0.8, kOneG_high = 1.2;
// No robot of this kind stands steeper; a swapped axis makes it 90, an inverted one 180.
constexpr double kTilt_deg = 30;
// Scale errors of gyroscopes are below 3 %, and the LiDAR's share of noise is about as large.
constexpr double kGyroScale = 0.15;
constexpr double kDegreesPerRadian = 180 / std::numbers::pi;
// Below it the two do not tell of the same rotation.
constexpr double kGyroCorrelation = 0.8;
// Tyres wear by 3 %, and slip takes some more.
constexpr double kTravelScale = 0.1;
// The track of a skid-steered robot depends on the floor by 10 to 15 %.
constexpr double kYawScale = 0.2;
// Visual odometry starts anew after each dark or frozen stretch.
constexpr double kDarkShare = 0.2, kFrozenShare = 0.05;

double share(int64_t part, int64_t whole) {
  return whole > 0 ? static_cast<double>(part) / static_cast<double>(whole) : 0;
}

bool off(double scale, double tolerance) {
  return scale > 1 + tolerance || scale < 1 / (1 + tolerance);
}

class Diagnosis {
 public:
  Diagnosis(const RigCalibration& rig, Health& health) : rig_(rig), health_(health) {}

  void all() {
    samples("imu", "samples", health_.imu);
    samples("wheels", "samples", health_.wheels);
    samples("lidar", "scans", health_.lidar);
    samples("camera", "images", health_.camera);
    gravity();
    gyroscope();
    wheels();
    camera();
    lidar();
    worth();
  }

 private:
  template <class... Args>
  void warn(fmt::format_string<Args...> text, Args&&... args) {
    health_.warnings.push_back(fmt::format(text, std::forward<Args>(args)...));
  }
  template <class... Args>
  void worthless(fmt::format_string<Args...> text, Args&&... args) {
    if (health_.worthless.empty()) health_.worthless = fmt::format(text, std::forward<Args>(args)...);
  }

  void samples(const char* name, const char* what, const SensorHealth& sensor) {
    const int64_t dropped = sensor.dropped_count(), all = sensor.used + dropped;
    if (share(dropped, all) > kDroppedShare)
      warn("{}: {} of {} {} dropped ({})", name, dropped, all, what, reasons(sensor));
    if (sensor.rate_hz && *sensor.longest_gap_s > kLongGap_s &&
        *sensor.longest_gap_s > kGapIntervals / *sensor.rate_hz)
      warn("{}: no {} for {:.1f} s, {:.1f} s after the start", name, what, *sensor.longest_gap_s,
           *sensor.longest_gap_at_s);
  }

  static std::string reasons(const SensorHealth& sensor) {
    std::string text;
    for (const auto& [reason, count] : sensor.dropped)
      if (count > 0) text += fmt::format("{}{} {}", text.empty() ? "" : ", ", reason, count);
    return text;
  }

  void gravity() {
    const ImuHealth& imu = health_.imu;
    const bool repaired = health_.odometry.imu_repaired > 0;
    if (!imu.gravity_mps2 || repaired) return;
    const double force_mps2 = *imu.gravity_mps2, expected_mps2 = rig_.imu.gravity_mps2;
    const double tolerance_mps2 = imu.gravity_at_rest ? kGravityAtRest_mps2 : kGravityMoving_mps2;
    const char* when = imu.gravity_at_rest ? "at rest" : "on average";
    if (force_mps2 > kOneG_low && force_mps2 < kOneG_high)
      warn("imu: the specific force {} is {:.3f}: in units of g? m/s^2 are expected", when, force_mps2);
    else if (std::abs(force_mps2 - expected_mps2) > tolerance_mps2)
      warn("imu: the specific force {} is {:.2f} m/s^2, not {:.2f}: check its unit, or give imu.gravity_mps2",
           when, force_mps2, expected_mps2);
    if (*imu.gravity_tilt_deg > kTilt_deg)
      warn(
          "imu: gravity points {:.0f} deg away from the base's -z{}: check the mount imu.T_base_imu in the "
          "sheet",
          *imu.gravity_tilt_deg, *imu.gravity_tilt_deg > 180 - kTilt_deg ? ", upside down" : "");
  }

  void gyroscope() {
    const ImuHealth& imu = health_.imu;
    if (!imu.gyro_scale || health_.odometry.imu_repaired > 0) return;
    const double size = std::abs(*imu.gyro_scale);
    bool inverted = false;
    for (size_t axis = 0; axis < 3; ++axis) {
      const auto& scale = imu.gyro_axis_scale[axis];
      if (!scale || *scale > -0.5 * size || *scale == 0) continue;
      inverted = true;
      warn(
          "imu: the gyroscope turns against the LiDAR about {}: an inverted axis? Check the mount "
          "imu.T_base_imu",
          "xyz"[axis]);
    }
    if (inverted) return;
    if (std::abs(*imu.gyro_correlation) < kGyroCorrelation) {
      warn(
          "imu: gyroscope and LiDAR do not tell of the same rotation (correlation {:.2f}): check mount and "
          "stamps",
          *imu.gyro_correlation);
    } else if (!off(size / kDegreesPerRadian, kGyroScale)) {
      warn("imu: the gyroscope's rates are {:.1f} times those of the LiDAR: in degrees? rad/s are expected",
           size);
    } else if (off(size, kGyroScale)) {
      warn("imu: the gyroscope's rates are {:.2f} times those of the LiDAR: check its unit and mount", size);
    }
  }

  void wheels() {
    const WheelsHealth& wheels = health_.wheels;
    const WheelCalibration& sheet = rig_.wheels;
    const bool radius_off = wheels.travel_scale && !follows_prior() && off(*wheels.travel_scale, kTravelScale);
    if (radius_off)
      warn(
          "wheels: they travel {:.2f} times as far as the LiDAR: wheels.wheel_radius_m is {:.4g}, {:.4g} "
          "would fit",
          *wheels.travel_scale, sheet.wheel_radius_m, sheet.wheel_radius_m / *wheels.travel_scale);
    if (!wheels.yaw_scale) return;
    const double turn = *wheels.yaw_scale / (radius_off ? *wheels.travel_scale : 1);
    if (off(turn, kYawScale))
      warn(
          "wheels: they turn {:.2f} times as far as the LiDAR{}: wheels.effective_track_m is {:.4g}, {:.4g} "
          "would fit",
          turn, radius_off ? ", with that radius" : "", sheet.effective_track_m, sheet.effective_track_m * turn);
  }

  void camera() {
    const CameraHealth& camera = health_.camera;
    if (share(camera.dark, camera.used) > kDarkShare)
      warn("camera: {} of {} images are dark (mean grey {:.0f} of 255)", camera.dark, camera.used,
           camera.grey_mean.value_or(0));
    if (share(camera.frozen, camera.used) > kFrozenShare)
      warn("camera: {} of {} images are frozen: byte for byte the one before", camera.frozen, camera.used);
  }

  void lidar() {
    if (health_.blind_share() > kBlindShare)
      warn("lidar: it gave nothing in {} of {} scans ({:.0f} %): there the prior alone is the pose",
           health_.odometry.scans_prior_only, health_.odometry.scans, 100 * health_.blind_share());
    if (follows_prior())
      warn("lidar: {} of {} scans saw one direction worse than 5 cm: along it the trajectory is the prior's",
           health_.odometry.scans_blind, health_.odometry.scans);
    if (health_.odometry.steps_unsure > 0)
      warn("odometry: {} of its {} steps from key scan to key scan are known no better than 10 cm, the worst to {:.2f} m: "
           "the LiDAR saw too little there, and nothing else told",
           health_.odometry.steps_unsure, health_.odometry.steps, health_.odometry.worst_step_sigma_m);
  }

  bool follows_prior() const { return share(health_.odometry.scans_blind, health_.odometry.scans) > kFollowedShare; }

  void worth() {
    const LidarHealth& lidar = health_.lidar;
    const int64_t all = lidar.used + lidar.dropped_count();
    int64_t lost = 0;
    for (const OdometryHealth::LostSpan& span : health_.odometry.lost) lost += span.scans;
    if (lidar.used == 0)
      worthless("not one scan was used");
    else if (health_.blind_share() > kWorthlessShare)
      worthless("the LiDAR gave nothing in {} of {} scans: the trajectory is the prior's",
                health_.odometry.scans_prior_only, health_.odometry.scans);
    else if (share(health_.odometry.steps_unsure, health_.odometry.steps) > kWorthlessShare)
      worthless("{} of {} steps of the odometry are guesses", health_.odometry.steps_unsure, health_.odometry.steps);
    else if (share(lost, health_.odometry.scans) > kWorthlessShare)
      worthless("the pose was lost in {} of {} scans", lost, health_.odometry.scans);
    else if (share(lidar.dropped_count(), all) > kWorthlessShare)
      worthless("only {} of {} scans were used ({})", lidar.used, all, reasons(lidar));
    else if (lidar.share_of_time && *lidar.share_of_time < kWorthlessShare)
      worthless("the LiDAR was silent for {:.0f} % of the time", 100 * (1 - *lidar.share_of_time));
  }

  const RigCalibration& rig_;
  Health& health_;
};

}  // namespace

void diagnose(const RigCalibration& rig, Health& health) {
  Diagnosis(rig, health).all();
}

}  // namespace vsslam

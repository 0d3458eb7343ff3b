// A robot in a ring of corridors made of points: its exact motion, what its IMU feels and what a perfect tracker
// would see, with and without noise.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <set>
#include <vector>

#include "core/rng.h"
#include "slam/vio/vio.h"

namespace vsslam::vio_world {

inline RigCalibration rig() {
  RigCalibration rig;
  rig.imu.T_base_imu = SE3::from_rpy({0.02, -0.01, 0.03}, {0.1, 0.05, 0.2});
  Mat3 R_base_optical;
  R_base_optical << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  rig.camera.T_base_camera = SE3(Quat(R_base_optical) * so3_exp({0.05, -0.02, 0.01}), {0.35, 0.02, 0.3});
  return rig;
}

/// Rests, drives along a square with round corners at a smooth speed, rests again.
class Drive {
 public:
  struct Options {
    double rest_s = 2;
    double speed_mps = 1;
    double speed_change = 0;  ///< amplitude of a slow oscillation of the speed, of the speed
    double half_side_m = 8;
    double duration_s = 60;
    double stop_s = 1e9;  ///< brakes then, for good
    double bump_m = 0;    ///< vertical and pitching motion, for observability
    double warm_s = 0;    ///< already this far into the drive at t = 0
  };
  explicit Drive(const Options& options) : options_(options) {
    const auto steps = static_cast<size_t>(std::lround((options.duration_s + options.warm_s + 1) / kStep));
    theta_.reserve(steps + 1);
    double theta = -0.3;
    for (size_t i = 0; i <= steps; ++i) {
      theta_.push_back(theta);
      theta = advance(theta, static_cast<double>(i) * kStep, kStep);
    }
  }

  SE3 T_world_base(double t) const {
    t += options_.warm_s;
    const double theta = theta_at(t);
    const double ahead = travelled(t);
    const double pitch = 0.5 * options_.bump_m * std::cos(1.7 * ahead);
    const double roll = 0.4 * options_.bump_m * std::sin(1.1 * ahead + 1);
    const Vec2 p = curve(theta);
    return SE3::from_rpy({roll, pitch, heading(theta)},
                         {p.x(), p.y(), options_.bump_m * std::sin(1.7 * ahead)});
  }
  double speed(double t) const {
    const double driven = t - options_.rest_s;
    double v = options_.speed_mps * ramp(driven / 2.0) * (1 - ramp((t - options_.stop_s) / 2.0));
    return v * (1 + options_.speed_change * std::sin(0.9 * std::max(0.0, driven)));
  }
  const Options& options() const { return options_; }

  Vec2 curve(double theta) const {
    const double c = std::cos(theta), s = std::sin(theta);
    return options_.half_side_m * std::pow(std::pow(c, 8) + std::pow(s, 8), -0.125) * Vec2(c, s);
  }
  Vec2 tangent(double theta) const {
    const double c = std::cos(theta), s = std::sin(theta);
    const double sum = std::pow(c, 8) + std::pow(s, 8);
    const double r = std::pow(sum, -0.125),
                 dr = -0.125 * std::pow(sum, -1.125) * 8 * (-std::pow(c, 7) * s + std::pow(s, 7) * c);
    return options_.half_side_m * Vec2(dr * c - r * s, dr * s + r * c);
  }
  double heading(double theta) const {
    const Vec2 d = tangent(theta);
    return std::atan2(d.y(), d.x());
  }

 private:
  static constexpr double kStep = 1e-3;
  static double ramp(double u) {  // smooth from 0 to 1
    u = std::clamp(u, 0.0, 1.0);
    return u * u * u * (10 + u * (-15 + 6 * u));
  }
  double travelled(double t) const { return std::max(0.0, t - options_.rest_s) * options_.speed_mps; }
  double rate(double theta, double t) const { return speed(t) / tangent(theta).norm(); }
  double advance(double theta, double t, double h) const {
    const double k1 = rate(theta, t), k2 = rate(theta + 0.5 * h * k1, t + 0.5 * h),
                 k3 = rate(theta + 0.5 * h * k2, t + 0.5 * h), k4 = rate(theta + h * k3, t + h);
    return theta + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
  }
  double theta_at(double t) const {
    if (t <= 0) return theta_.front();
    const auto i = std::min(static_cast<size_t>(t / kStep), theta_.size() - 1);
    const double begin = static_cast<double>(i) * kStep;
    return advance(theta_[i], begin, t - begin);
  }
  Options options_;
  std::vector<double> theta_;
};

struct Noise {
  bool imu = false;
  double feature_px = 0;      ///< on the image of the camera
  double depth_ratio = 0.01;  ///< of LiDAR depths
  Vec3 gyro_bias_radps = Vec3::Zero(), accel_bias_mps2 = Vec3::Zero();
  uint64_t seed = 1;
};

inline ImuSample imu_sample(const Drive& drive, const RigCalibration& rig, Time now, const Noise& noise) {
  const double t = now.seconds(), h = 2e-3;
  const auto pose = [&](double at) { return drive.T_world_base(at) * rig.imu.T_base_imu; };
  const SE3 a = pose(t - h), b = pose(t), c = pose(t + h);
  const Vec3 acceleration = (a.translation - 2 * b.translation + c.translation) / (h * h);
  ImuSample s{
      now,
      so3_log(a.rotation.conjugate() * c.rotation) / (2 * h) + noise.gyro_bias_radps,
      b.rotation.conjugate() * (acceleration + Vec3(0, 0, rig.imu.gravity_mps2)) + noise.accel_bias_mps2,
      {}};
  if (!noise.imu) return s;
  const RandomStream gyro(noise.seed, "gyro"), accel(noise.seed, "accel");
  for (int k = 0; k < 3; ++k) {
    const double root_rate = std::sqrt(rig.imu.rate_hz);
    s.gyro_radps[k] += rig.imu.gyro_noise_radps_rthz * root_rate * gyro.normal(now, static_cast<uint64_t>(k));
    s.accel_mps2[k] +=
        rig.imu.accel_noise_mps2_rthz * root_rate * accel.normal(now, static_cast<uint64_t>(k));
  }
  return s;
}

/// Points on walls, floor and ceiling along the drive, and a tracker that never errs.
class Eyes {
 public:
  Eyes(const Drive& drive, const RigCalibration& rig, const Noise& noise, double depth_share,
       int max_features = 150)
      : drive_(drive), rig_(rig), noise_(noise), depth_share_(depth_share), max_features_(max_features) {
    const RandomStream random(7, "landmarks");
    for (uint64_t i = 0; i < 3500; ++i) {
      const double theta = 2 * M_PI * random.uniform(i, 0), u = random.uniform(i, 1),
                   v = random.uniform(i, 2);
      const Vec2 p = drive.curve(theta);
      const Vec2 left = Eigen::Rotation2Dd(0.5 * M_PI) * drive.tangent(theta).normalized();
      const bool wall = random.uniform(i, 3) < 0.7;
      const double side = wall ? (u < 0.5 ? -1.6 : 1.4) : -1.6 + 3 * u;
      const double height = wall ? -0.2 + 2.8 * v : (v < 0.5 ? -0.2 : 2.6);
      const Vec2 at = p + side * left;
      points_.push_back({at.x(), at.y(), height});
    }
  }

  VisualFrame see(Time now) {
    const SE3 T_camera_world = (drive_.T_world_base(now.seconds()) * rig_.camera.T_base_camera).inverse();
    const RandomStream pixel(noise_.seed, "pixel"), depth(noise_.seed, "depth"), lidar(3, "lidar");
    std::map<size_t, int64_t> still;
    VisualFrame frame{now, {}};
    const auto add = [&](size_t point, int64_t id, const Vec3& p) {
      const double f = rig_.camera.fx_px;
      VisualFeature feature;
      feature.id = id;
      const auto key = static_cast<uint64_t>(id);
      feature.ray_camera =
          p.hnormalized() +
          noise_.feature_px / f * Vec2(pixel.normal(now, 2 * key), pixel.normal(now, 2 * key + 1));
      if (lidar.uniform(point) < depth_share_)
        feature.depth_m = p.z() * (1 + noise_.depth_ratio * depth.normal(now, key));
      frame.features.push_back(feature);
      still[point] = id;
    };
    for (const auto& [point, id] : tracks_)
      if (const auto p = visible(T_camera_world, points_[point])) add(point, id, *p);
    for (size_t k = 0; k < points_.size() && static_cast<int>(still.size()) < max_features_; ++k) {
      if (still.contains(k)) continue;
      if (const auto p = visible(T_camera_world, points_[k])) add(k, next_id_++, *p);
    }
    tracks_ = std::move(still);
    std::sort(frame.features.begin(), frame.features.end(),
              [](const auto& a, const auto& b) { return a.id < b.id; });
    return frame;
  }
  void lose_all() { tracks_.clear(); }

 private:
  std::optional<Vec3> visible(const SE3& T_camera_world, const Vec3& point) const {
    const Vec3 p = T_camera_world * point;
    if (p.z() < 0.6 || p.z() > 10) return std::nullopt;
    const double u = rig_.camera.fx_px * p.x() / p.z() + rig_.camera.cx_px,
                 v = rig_.camera.fy_px * p.y() / p.z() + rig_.camera.cy_px;
    if (u < 5 || v < 5 || u > rig_.camera.width_px - 5 || v > rig_.camera.height_px - 5) return std::nullopt;
    return p;
  }
  const Drive& drive_;
  RigCalibration rig_;
  Noise noise_;
  double depth_share_;
  int max_features_;
  std::vector<Vec3> points_;
  std::map<size_t, int64_t> tracks_;
  int64_t next_id_ = 0;
};

struct Ride {
  struct Step {
    Time stamp;
    std::optional<VioState> state;
    SE3 T_world_imu;
  };
  std::vector<Step> steps;
  double path_m = 0;
  int restarts = 0;

  /// Of the motion from the first tracked frame to the last, translation, of the path in between.
  double drift() const { return drift_between(first_tracked(), last_tracked()); }
  double drift_between(size_t a, size_t b) const {
    const SE3 estimated = steps[a].state->T_vio_imu.inverse() * steps[b].state->T_vio_imu;
    const SE3 truth = steps[a].T_world_imu.inverse() * steps[b].T_world_imu;
    double path = 0;
    for (size_t i = a + 1; i <= b; ++i)
      path += (steps[i].T_world_imu.translation - steps[i - 1].T_world_imu.translation).norm();
    return (estimated.translation - truth.translation).norm() / path;
  }
  size_t first_tracked() const {
    size_t i = 0;
    while (i + 1 < steps.size() && !steps[i].state) ++i;
    return i;
  }
  size_t last_tracked() const {
    size_t i = steps.size() - 1;
    while (i > 0 && !steps[i].state) --i;
    return i;
  }
  int tracked() const {
    return static_cast<int>(
        std::count_if(steps.begin(), steps.end(), [](const Step& s) { return s.state.has_value(); }));
  }
};

struct RideOptions {
  Noise noise;
  double depth_share = 0;
  VioConfig config;
  int imu_rate_hz = 100;
  int frame_rate_hz = 30;
  double begin_s = 0;
  std::function<bool(VisualFrame&)> keep_frame = [](VisualFrame&) { return true; };
  std::function<bool(ImuSample&)> keep_imu = [](ImuSample&) { return true; };
  std::function<void(VisualInertialOdometry&, Time, const VioState& truth)> before_frame = {};
  std::function<void(const VisualInertialOdometry&, Time)> after_frame = {};
};

/// The state as it truly is, in the world's frame.
inline VioState true_state(const Drive& drive, const RigCalibration& rig, Time now, const Noise& noise) {
  const double t = now.seconds(), h = 1e-4;
  const auto pose = [&](double at) { return drive.T_world_base(at) * rig.imu.T_base_imu; };
  return {now,
          pose(t),
          (pose(t + h).translation - pose(t - h).translation) / (2 * h),
          {noise.gyro_bias_radps, noise.accel_bias_mps2}};
}

inline Ride ride(const Drive& drive, const RideOptions& options) {
  const RigCalibration calibration = rig();
  VisualInertialOdometry vio(options.config, calibration);
  Eyes eyes(drive, calibration, options.noise, options.depth_share);
  Ride result;
  const int64_t imu_step = 1'000'000'000 / options.imu_rate_hz;
  int64_t next_imu = Time::from_seconds(options.begin_s).ns;
  const auto first_frame = static_cast<int64_t>(options.begin_s * options.frame_rate_hz) + 1;
  for (int64_t k = first_frame;; ++k) {
    const Time now{k * 1'000'000'000 / options.frame_rate_hz};
    if (now.seconds() > drive.options().duration_s) break;
    for (; next_imu <= now.ns; next_imu += imu_step) {
      ImuSample sample = imu_sample(drive, calibration, Time{next_imu}, options.noise);
      if (options.keep_imu(sample)) vio.add(sample);
    }
    VisualFrame frame = eyes.see(now);
    if (!options.keep_frame(frame)) continue;
    const VioState truth = true_state(drive, calibration, now, options.noise);
    if (options.before_frame) options.before_frame(vio, now, truth);
    const auto state = vio.add(frame);
    if (options.after_frame) options.after_frame(vio, now);
    if (!result.steps.empty())
      result.path_m += (truth.T_vio_imu.translation - result.steps.back().T_world_imu.translation).norm();
    result.steps.push_back({now, state, truth.T_vio_imu});
  }
  result.restarts = vio.restarts();
  return result;
}

}  // namespace vsslam::vio_world

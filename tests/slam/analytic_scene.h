// Scans, IMU and wheels of a robot in a scene of axis-aligned boxes, in closed form: enough of a VLP-16 to test
// the estimator without the simulator.
#pragma once

#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <vector>

#include "core/calibration.h"
#include "core/rng.h"
#include "core/samples.h"

namespace vsslam::testing_scene {

struct Box {
  Vec3 low, high;
};
using Scene = std::vector<Box>;

/// First hit of the ray with any box, from outside; infinity if none.
inline double cast_ray(const Scene& scene, const Vec3& origin, const Vec3& direction) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const Box& box : scene) {
    double enter = 0, leave = nearest;
    for (int k = 0; k < 3 && enter <= leave; ++k) {
      if (std::abs(direction[k]) < 1e-12) {
        if (origin[k] < box.low[k] || origin[k] > box.high[k]) leave = -1;
        continue;
      }
      const double a = (box.low[k] - origin[k]) / direction[k], b = (box.high[k] - origin[k]) / direction[k];
      enter = std::max(enter, std::min(a, b));
      leave = std::min(leave, std::max(a, b));
    }
    if (enter <= leave && enter > 1e-6) nearest = std::min(nearest, enter);
  }
  return nearest;
}

/// Hollow room: the inside is [low, high]; walls, floor and ceiling 0.2 m thick.
inline Scene hollow(const Vec3& low, const Vec3& high) {
  Scene scene;
  for (int k = 0; k < 3; ++k) {
    Box below{low.array() - 0.2, high.array() + 0.2}, above = below;
    below.high[k] = low[k];
    above.low[k] = high[k];
    scene.push_back(below);
    scene.push_back(above);
  }
  return scene;
}

/// Corridor along x, 2.4 m wide, 3 m high, from x = -half to half (200 m away is out of range: endless).
inline Scene corridor(double half_length_m) {
  return hollow({-half_length_m, -1.2, 0}, {half_length_m, 1.2, 3});
}

/// The corridor with door jambs on both walls every `spacing_m`, 0.3 m along the wall, 2.1 m high.
inline Scene jambed_corridor(double half_length_m, double spacing_m, double depth_m) {
  Scene scene = corridor(half_length_m);
  for (double x = -half_length_m + 1.0; x < half_length_m; x += spacing_m)
    for (const double side : {-1.0, 1.0}) {
      Box jamb{{x, side > 0 ? 1.2 - depth_m : -1.2, 0}, {x + 0.3, side > 0 ? 1.2 : -1.2 + depth_m, 2.1}};
      scene.push_back(jamb);
    }
  return scene;
}

/// 12 x 10 m room with a few cupboards.
inline Scene room() {
  Scene scene = hollow({-6, -5, 0}, {6, 5, 3});
  scene.push_back({{3, 2, 0}, {4, 3.2, 1.8}});
  scene.push_back({{-4, -3, 0}, {-3.2, -1, 1.2}});
  scene.push_back({{-1, 4.2, 0}, {1, 5, 2}});
  return scene;
}

/// T_scene_base as a function of seconds.
using Motion = std::function<SE3(double)>;

inline RigCalibration rig() {
  RigCalibration rig;
  rig.lidar.T_base_lidar = SE3(Quat::Identity(), {0.1, 0, 0.4});
  rig.imu.T_base_imu = SE3(Quat::Identity(), {-0.05, 0.02, 0.1});
  return rig;
}

struct Noise {
  double range_sigma_m = 0.007;
  double gyro_bias_radps = 0.002;
  bool imu = true;
  uint64_t seed = 1;
};

/// One revolution of 1809 firings of 16 beams, -15..15 deg, from azimuth 0 clockwise; a pose per firing.
inline LidarScan scan(const Scene& scene, const Motion& motion, const RigCalibration& rig, Time stamp,
                      const Noise& noise = {}, int column_step = 1) {
  constexpr double kCycle_s = 55.296e-6, kLaser_s = 2.304e-6;
  const RandomStream range_noise(noise.seed, "range");
  LidarScan scan;
  scan.stamp = stamp;
  scan.end = stamp + Duration::from_seconds(1808 * kCycle_s + 15 * kLaser_s);
  for (int column = 0; column < 1809; column += column_step) {
    const SE3 T_scene_lidar = motion(stamp.seconds() + column * kCycle_s) * rig.lidar.T_base_lidar;
    for (int ring = 0; ring < 16; ++ring) {
      const double time_s = column * kCycle_s;
      const double azimuth = -2 * std::numbers::pi * 10.0 * time_s;
      const double elevation = (-15.0 + 2.0 * ring) * std::numbers::pi / 180.0;
      const Vec3 beam_lidar(std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
                            std::sin(elevation));
      double range_m = cast_ray(scene, T_scene_lidar.translation, T_scene_lidar.rotation * beam_lidar);
      if (!(range_m < rig.lidar.max_range_m)) continue;
      range_m += noise.range_sigma_m * range_noise.normal(stamp, static_cast<uint64_t>(column * 16 + ring));
      const Eigen::Vector3f p = (range_m * beam_lidar).cast<float>();
      scan.points.push_back(
          {p.x(), p.y(), p.z(), 50, static_cast<uint16_t>(ring), static_cast<float>(time_s)});
    }
  }
  return scan;
}

/// By central differences of the motion.
inline ImuSample imu_sample(const Motion& motion, const RigCalibration& rig, Time stamp,
                            const Noise& noise = {}) {
  const double t = stamp.seconds(), h = 1e-4;
  const auto T = [&](double at_s) { return motion(at_s) * rig.imu.T_base_imu; };
  ImuSample sample;
  sample.stamp = stamp;
  sample.gyro_radps = so3_log(T(t - h).rotation.conjugate() * T(t + h).rotation) / (2 * h);
  const Vec3 a_scene = (T(t + h).translation - 2 * T(t).translation + T(t - h).translation) / (h * h);
  sample.accel_mps2 = T(t).rotation.conjugate() * (a_scene + Vec3(0, 0, rig.imu.gravity_mps2));
  if (!noise.imu) return sample;
  const RandomStream stream(noise.seed, "imu");
  const double root_rate = std::sqrt(rig.imu.rate_hz);
  for (uint64_t k = 0; k < 3; ++k) {
    sample.gyro_radps[static_cast<int>(k)] +=
        noise.gyro_bias_radps + rig.imu.gyro_noise_radps_rthz * root_rate * stream.normal(stamp, k);
    sample.accel_mps2[static_cast<int>(k)] +=
        rig.imu.accel_noise_mps2_rthz * root_rate * stream.normal(stamp, k + 3);
  }
  return sample;
}

/// Wheels that roll without slip on the differential drive of the calibration: integrate() in steps.
class Wheels {
 public:
  explicit Wheels(const RigCalibration& rig, double scale = 1.0) : wheels_(rig.wheels), scale_(scale) {}
  WheelSample advance(const Motion& motion, Time stamp) {
    const double from_s = sample_.stamp.seconds(), to_s = stamp.seconds();
    const SE3 T = motion(from_s).inverse() * motion(to_s);
    const double yaw = T.rpy().z();
    const double forward = scale_ * std::copysign(T.translation.norm(), T.translation.x());
    sample_.left_rad += (forward - 0.5 * yaw * wheels_.effective_track_m) / wheels_.wheel_radius_m;
    sample_.right_rad += (forward + 0.5 * yaw * wheels_.effective_track_m) / wheels_.wheel_radius_m;
    sample_.stamp = stamp;
    return sample_;
  }

 private:
  WheelCalibration wheels_;
  double scale_;
  WheelSample sample_;
};

/// Rest for a second, then along x with a gentle weave; speed ramps up in 1 s.
inline Motion weaving_drive(double start_x_m, double speed_mps) {
  return [=](double t) {
    const double u = std::max(t - 1.0, 0.0);
    const double distance = speed_mps * (u < 1 ? u * u * u * (1 - u / 2) : u - 0.5);  // smoothstep of speed
    const double s = distance * 0.25;
    const double y = 0.3 * (1 - std::cos(s)), slope = 0.3 * 0.25 * std::sin(s);
    return SE3::from_rpy({0, 0, std::atan(slope)}, {start_x_m + distance, y, 0.2});
  };
}

}  // namespace vsslam::testing_scene

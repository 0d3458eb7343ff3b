// Images of a textured plane in closed form: enough of a camera to test the visual front end without a renderer.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include "core/calibration.h"
#include "core/rng.h"
#include "core/samples.h"
#include "slam/vision/camera_model.h"

namespace vsslam::testing_vision {

/// A sum of plane waves: smooth, without repetition, with corners everywhere. Grey value at a place in metres.
class WaveTexture {
 public:
  explicit WaveTexture(uint64_t seed, double shortest_m = 0.18, double longest_m = 1.0) {
    const RandomStream random(seed, "waves");
    constexpr uint64_t kWaves = 10;
    for (uint64_t k = 0; k < kWaves; ++k) {
      const double u = (static_cast<double>(k) + 0.5) / kWaves;
      const double number = 2 * std::numbers::pi / (shortest_m * std::pow(longest_m / shortest_m, u));
      const double angle = 2 * std::numbers::pi * random.uniform(k, 0);
      waves_.push_back(
          {number * std::cos(angle), number * std::sin(angle), 2 * std::numbers::pi * random.uniform(k, 1)});
    }
  }
  double operator()(const Vec2& p) const {
    double sum = 0;
    for (const Wave& w : waves_) sum += std::sin(w.kx * p.x() + w.ky * p.y() + w.phase);
    return 128 + 22 * sum;
  }

 private:
  struct Wave {
    double kx, ky, phase;
  };
  std::vector<Wave> waves_;
};

/// 320 x 240, 80 deg wide.
inline CameraCalibration small_camera() {
  CameraCalibration c;
  c.width_px = 320;
  c.height_px = 240;
  c.fx_px = c.fy_px = 192.1;
  c.cx_px = 159.5;
  c.cy_px = 118.2;
  return c;
}

/// Where the ray of a pixel meets the plane z = 0 of odom.
inline Vec2 point_odom(const CameraModel& camera, const SE3& T_odom_camera, const Vec2& pixel_px) {
  const Vec2 ray = camera.ray_camera(pixel_px).value();
  const Vec3 direction_odom = T_odom_camera.rotation * Vec3(ray.x(), ray.y(), 1);
  const double range = -T_odom_camera.translation.z() / direction_odom.z();
  return (T_odom_camera.translation + range * direction_odom).head<2>();
}
inline Vec2 pixel_of(const CameraModel& camera, const SE3& T_odom_camera, const Vec2& p_odom) {
  const Vec3 p = T_odom_camera.inverse() * Vec3(p_odom.x(), p_odom.y(), 0);
  return camera.pixel_px(p.hnormalized());
}

/// A camera 4 m before the plane z = 0 of odom, looking along +z.
inline SE3 before_plane(const Vec3& rpy_rad = Vec3::Zero(), const Vec3& offset_m = Vec3::Zero()) {
  return SE3::from_rpy(rpy_rad, Vec3(0, 0, -4) + offset_m);
}

struct Picture {
  double gain = 1, offset_grey = 0;  ///< of the texture's grey value
  double noise_grey = 0;
};

inline uint8_t to_byte(double grey) {
  return static_cast<uint8_t>(std::clamp(std::lround(grey), 0l, 255l));
}

inline CameraFrame render(const WaveTexture& texture, const CameraCalibration& calibration,
                          const SE3& T_odom_camera, Time stamp, const Picture& picture = {}) {
  const CameraModel camera(calibration);
  const RandomStream random(1, "noise");
  CameraFrame frame{stamp, calibration.width_px, calibration.height_px, {}};
  for (int y = 0; y < frame.height_px; ++y)
    for (int x = 0; x < frame.width_px; ++x) {
      double grey =
          picture.gain * texture(point_odom(camera, T_odom_camera, Vec2(x, y))) + picture.offset_grey;
      if (picture.noise_grey > 0) grey += picture.noise_grey * random.normal(stamp, frame.grey.size());
      frame.grey.push_back(to_byte(grey));
    }
  return frame;
}

inline CameraFrame blank(const CameraCalibration& c, Time stamp, double grey, double noise_grey = 0) {
  const RandomStream random(2, "noise");
  CameraFrame frame{stamp, c.width_px, c.height_px, {}};
  const auto pixels = static_cast<uint64_t>(c.width_px) * static_cast<uint64_t>(c.height_px);
  for (uint64_t i = 0; i < pixels; ++i)
    frame.grey.push_back(to_byte(grey + noise_grey * random.normal(stamp, i)));
  return frame;
}

inline Time frame_time(int k) {
  return {k * int64_t{33'333'333}};
}

}  // namespace vsslam::testing_vision

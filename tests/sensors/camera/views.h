// Closed-form scenes for cameras, and small cameras to look at them.
#pragma once

#include <atomic>
#include <cmath>
#include <functional>
#include <limits>
#include <vector>

#include "sensors/camera/camera.h"
#include "tests/sensors/shapes.h"

namespace vsslam::views {

/// The plane z = distance of the world, shining with this luminance at (x, y) towards everybody.
inline ViewSource plane(double distance_m, std::function<double(double, double)> luminance_cdm2) {
  return [=](const SE3& T_world_camera, const ViewRays& rays, View& view) {
    const Mat3 R = T_world_camera.matrix3();
    const Vec3& origin = T_world_camera.translation;
    view.luminance.assign(rays.direction_camera.size(), 0.0f);
    view.depth_m.assign(rays.direction_camera.size(), std::numeric_limits<float>::infinity());
    for (size_t i = 0; i < rays.direction_camera.size(); ++i) {
      const Vec3 ray_camera = rays.direction_camera[i].cast<double>();
      const Vec3 ray = R * ray_camera;
      const double range_m = (distance_m - origin.z()) / ray.z();
      if (!(range_m > 0)) continue;
      const Vec3 at = origin + range_m * ray;
      view.luminance[i] = static_cast<float>(luminance_cdm2(at.x(), at.y()));
      view.depth_m[i] = static_cast<float>(range_m * ray_camera.z());
    }
  };
}

/// Everything shines alike.
inline ViewSource even(double luminance_cdm2) {
  return plane(1, [=](double, double) { return luminance_cdm2; });
}

/// Counts the views of whole images.
inline ViewSource counted(ViewSource source, size_t pixels, std::atomic<int>& views) {
  return [=, &views](const SE3& T_world_camera, const ViewRays& rays, View& view) {
    if (rays.direction_camera.size() == pixels) ++views;
    source(T_world_camera, rays, view);
  };
}

/// An error-free camera of 160 x 120 pixels with the default's field of view; 100 cd/m^2 give grey 127.5.
inline CameraConfig small_ideal() {
  CameraConfig config = CameraConfig::ideal();
  config.width_px = 160, config.height_px = 120;
  config.fx_px = config.fy_px = 96;
  config.cx_px = 79.5, config.cy_px = 59;
  config.exposure_s = 0.002, config.gain = 5;
  config.sensitivity_e_per_cdm2_ms = 4, config.full_well_e = 8000;
  return config;
}

/// `count` images from time 0 on, taken as many at a time as the camera knows exposures for.
inline std::vector<CameraMeasurement> film(const CameraConfig& config, int count, const ViewSource& source,
                                           const Trajectory& trajectory, const SensorEvents& events = {},
                                           uint64_t seed = 1) {
  Camera camera(config, events, seed);
  camera.power_on(Time{0});
  std::vector<CameraMeasurement> images;
  while (count > 0) {
    const int together = std::min(count, camera.known());
    for (CameraMeasurement& image : camera.take(together, trajectory, SE3(), source))
      images.push_back(std::move(image));
    count -= together;
  }
  return images;
}

inline std::vector<CameraMeasurement> film_at_rest(const CameraConfig& config, int count,
                                                   const ViewSource& source, const SensorEvents& events = {},
                                                   uint64_t seed = 1) {
  return film(config, count, source, shapes::at_rest(SE3(), 0.2 + (count + 1) / config.rate_hz), events,
              seed);
}

struct Moments {
  double mean = 0, variance = 0;
};
template <class T>
Moments moments(const std::vector<T>& values) {
  Moments m;
  for (const T v : values) m.mean += static_cast<double>(v);
  m.mean /= static_cast<double>(values.size());
  for (const T v : values)
    m.variance += (static_cast<double>(v) - m.mean) * (static_cast<double>(v) - m.mean);
  m.variance /= static_cast<double>(values.size() - 1);
  return m;
}

}  // namespace vsslam::views

// Scans of box-shaped rooms, by intersecting rays with axis-aligned boxes.
#pragma once

#include <cmath>
#include <limits>
#include <vector>

#include "slam/map/key_scan.h"

namespace vsslam {

struct TestBox {
  Vec3 low, high;
};

/// The first box is seen from inside, the others from outside.
using TestRoom = std::vector<TestBox>;

/// 24 x 16 m, nothing in it twice.
inline TestRoom cluttered_room() {
  return {{{-12, -8, 0}, {12, 8, 4}},    {{5, 2, 0}, {6, 3, 4}},     {{-4, -6, 0}, {-3, -5.5, 4}},
          {{-9, 4, 0}, {-6, 5, 2.0}},    {{1, -7, 0}, {4, -6, 1.2}}, {{8, -4, 0}, {9, -1, 2.8}},
          {{-11, -3, 0}, {-10, 1, 3.1}}, {{-2, 5, 0}, {-1.2, 7, 4}}, {{10, 5, 0}, {12, 8, 2.2}}};
}

/// Two corridors of 3 m width along x, 14 m apart, the same but for one pillar.
inline TestRoom long_corridor() {
  return {{{-60, -1.5, 0}, {60, 1.5, 2.8}}, {{20, 1.1, 0}, {20.3, 1.5, 2.8}}};
}

inline double range_to_room(const TestRoom& room, const Vec3& origin, const Vec3& direction) {
  double nearest = std::numeric_limits<double>::infinity();
  for (size_t i = 0; i < room.size(); ++i) {
    double enter = -std::numeric_limits<double>::infinity(), leave = std::numeric_limits<double>::infinity();
    for (int k = 0; k < 3; ++k) {
      const double a = (room[i].low[k] - origin[k]) / direction[k],
                   b = (room[i].high[k] - origin[k]) / direction[k];
      enter = std::max(enter, std::min(a, b));
      leave = std::min(leave, std::max(a, b));
    }
    if (i == 0) nearest = std::min(nearest, leave);
    if (i > 0 && enter > 0 && enter < leave) nearest = std::min(nearest, enter);
  }
  return nearest;
}

/// 16 rings of `columns` points from -15 to 15 deg, in the lidar frame.
inline Cloud scan_room(const TestRoom& room, const SE3& T_map_lidar, int columns = 900) {
  Cloud cloud_lidar;
  for (int c = 0; c < columns; ++c)
    for (int ring = 0; ring < 16; ++ring) {
      const double azimuth = 2 * M_PI * (c + 0.137) / columns, elevation = (2 * ring - 15) * M_PI / 180;
      const Vec3 direction_lidar(std::cos(elevation) * std::cos(azimuth),
                                 std::cos(elevation) * std::sin(azimuth), std::sin(elevation));
      const double range =
          range_to_room(room, T_map_lidar.translation, T_map_lidar.rotation * direction_lidar);
      cloud_lidar.push_back((range * direction_lidar).cast<float>());
    }
  return cloud_lidar;
}

inline SE3 planar(double x, double y, double yaw_rad, double z = 0) {
  return SE3::from_rpy({0, 0, yaw_rad}, {x, y, z});
}

}  // namespace vsslam

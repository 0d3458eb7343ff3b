// Whether `aliasing` and `symmetry` of the corridors do to a LiDAR what they say: descriptors of noise-free scans
// at corresponding places.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "sensors/ray/raycaster.h"
#include "slam/loop/scan_context.h"
#include "worlds/indoor/corridor.h"

namespace vsslam {
namespace {

constexpr double kMount_m = 0.7;

/// What the 16 lasers of a level VLP-16 at (x, y) would measure without errors, heading along x.
ScanContext descriptor_at(const Raycaster& raycaster, double x_m, double y_m) {
  constexpr int kAzimuths = 720;
  Cloud points_lidar;
  for (int ring = 0; ring < 16; ++ring)
    for (int i = 0; i < kAzimuths; ++i) {
      const double elevation = (2 * ring - 15) * std::numbers::pi / 180;
      const double azimuth = 2 * std::numbers::pi * (i + 0.5) / kAzimuths;
      const Vec3 direction(std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
                           std::sin(elevation));
      Raycaster::Hit hit;
      if (raycaster.trace_one({x_m, y_m, kMount_m}, direction, 40, hit))
        points_lidar.push_back((hit.range_m * direction).cast<float>());
    }
  return ScanContext(polar_heights(points_lidar, kMount_m, {.max_range_m = 25}));
}

/// Six lobbies on each long side, 40 m apart, so that no scan sees beyond the neighbouring ones.
CorridorConfig long_ring(double symmetry, double aliasing) {
  CorridorConfig config;
  config.textures = false;
  config.length_m = 240;
  config.breadth_m = 40;
  config.lobbies = 6;
  config.symmetry = symmetry;
  config.aliasing = aliasing;
  return config;
}

struct Distances {
  double lobbies = 0;    ///< of one side, the mean over neighbours
  double corners = 0;    ///< opposite ones
  double sides = 0;      ///< a lobby and the one half a turn away
  double own_place = 0;  ///< 1.5 m aside along the corridor, as a scale
};
Distances distances(const CorridorConfig& config) {
  const World world = make_corridor(config);
  const Raycaster raycaster(world);
  const double south_m = -config.breadth_m / 2, first_m = -config.length_m / 2 + 20;
  const auto at = [&](double x_m, double y_m) { return descriptor_at(raycaster, x_m, y_m); };
  Distances d;
  for (int k = 1; k < 4; ++k)
    d.lobbies +=
        scan_context_distance(at(first_m + 40 * k, south_m), at(first_m + 40 * (k + 1), south_m)).distance /
        3;
  d.corners =
      scan_context_distance(at(config.length_m / 2, south_m), at(-config.length_m / 2, -south_m)).distance;
  d.sides = scan_context_distance(at(first_m + 80, south_m), at(-first_m - 80, -south_m)).distance;
  d.own_place = scan_context_distance(at(first_m + 80, south_m), at(first_m + 81.5, south_m)).distance;
  return d;
}

TEST(Aliasing, AtOneRepeatedPlacesAreIndistinguishable) {
  const Distances d = distances(long_ring(1, 1));
  EXPECT_LT(d.lobbies, 0.01);
  EXPECT_LT(d.corners, 0.01);
  EXPECT_LT(d.sides, 0.01);
  EXPECT_GT(d.own_place, 0.05);
}

TEST(Aliasing, AtZeroEveryLobbyIsDistinct) {
  const Distances d = distances(long_ring(0, 0));
  EXPECT_GT(d.lobbies, 0.1);
  EXPECT_GT(d.corners, 0.05);
  EXPECT_GT(d.sides, 0.1);
}

TEST(Aliasing, GrowsWithTheParameter) {
  double before = 1;
  for (const double aliasing : {0.0, 0.5, 1.0}) {
    const double lobbies = distances(long_ring(0.5, aliasing)).lobbies;
    EXPECT_LE(lobbies, before + 0.01);
    before = lobbies;
  }
}

}  // namespace
}  // namespace vsslam

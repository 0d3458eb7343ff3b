#include "worlds/indoor/corridor.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <set>
#include <string>

#include "core/rng.h"
#include "tests/worlds/geometry.h"
#include "tests/worlds/world_equality.h"
#include "worlds/describe.h"
#include "worlds/route.h"

namespace vsslam {
namespace {

constexpr double kPi = std::numbers::pi;

CorridorConfig plain() {
  CorridorConfig config;
  config.textures = false;
  return config;
}

std::vector<WorldTriangle> shell_of(const World& world) {
  std::vector<WorldTriangle> shell;
  for (const WorldTriangle& t : triangles_of(world))
    if (t.object < 3) shell.push_back(t);
  return shell;
}

// Every variant whose plan differs: jambs, alcoves, high places, no lobbies, an uneven floor.
std::vector<CorridorConfig> variants() {
  std::vector<CorridorConfig> all(6, plain());
  all[1].jamb_depth_m = 0.15;
  all[2].alcoves = 3;
  all[2].symmetry = 0.3;
  all[2].floor_unevenness_m = 0.004;
  all[3].lobbies = 0;
  all[3].seed = 7;
  all[3].width_m = 2.37;
  all[4].layout = CorridorConfig::Layout::straight;
  all[4].length_m = 60;
  all[5].symmetry = all[5].aliasing = 1;
  all[5].wall_clutter = 0.7;
  all[5].clutter = 1;
  return all;
}

TEST(Corridor, ShellIsClosedWithoutCracksOrTJunctions) {
  for (const CorridorConfig& config : variants()) EXPECT_EQ(open_edges(shell_of(make_corridor(config))), 0u);
}

TEST(Corridor, RaysFromTheRouteHitFrontFacesWithinTheWorld) {
  for (const CorridorConfig& config : variants()) {
    const World world = make_corridor(config);
    const auto triangles = triangles_of(world);
    const Bounds b = bounds(world);
    const double diagonal_m = (b.high_world - b.low_world).norm();
    const RandomStream stream(1, "rays");
    const auto& points = world.routes.front().points_world;
    for (uint64_t i = 0; i < 40; ++i) {
      const Vec3 origin =
          points[static_cast<size_t>(stream.uniform(i, 0) * static_cast<double>(points.size()))] +
          Vec3(0, 0, 0.7);
      const double z = 2 * stream.uniform(i, 1) - 1, azimuth = 2 * kPi * stream.uniform(i, 2);
      const Vec3 direction(std::sqrt(1 - z * z) * std::cos(azimuth), std::sqrt(1 - z * z) * std::sin(azimuth),
                           z);
      const auto hit = cast_ray(triangles, origin, direction);
      ASSERT_TRUE(hit) << "from " << origin.transpose() << " along " << direction.transpose();
      EXPECT_LE(hit->range_m, diagonal_m);
      EXPECT_LT(triangles[hit->triangle].normal().dot(direction), 0) << "back face";
    }
  }
}

TEST(Corridor, RingHasTheLengthOfItsCentreLine) {
  const World world = make_corridor(plain());
  const Route& ring = world.routes.front();
  EXPECT_EQ(ring.name, "ring");
  EXPECT_TRUE(ring.closed);
  // Rounding a corner with radius r saves 2 r - pi r / 2.
  EXPECT_NEAR(route_length_m(ring), 2 * (75 + 18) - 4 * (2 - kPi / 2) * 1.2, 0.02);
  EXPECT_NEAR((ring.points_world.front() - Vec3(0, -9, 0)).norm(), 0, 1e-12);
  EXPECT_GT(ring.points_world[1].x(), 0);  // east on the southern side: counter-clockwise
  const Route& back = world.routes[1];
  EXPECT_EQ(back.name, "ring_clockwise");
  EXPECT_EQ(back.points_world.front(), ring.points_world.front());
  EXPECT_EQ(back.points_world[1], ring.points_world.back());
}

TEST(Corridor, RoutesKeepTheirDistance) {
  for (const CorridorConfig& config : variants()) {
    const World world = make_corridor(config);
    const auto triangles = triangles_of(world);
    const auto& points = world.routes.front().points_world;
    for (size_t i = 0; i < points.size(); i += 3)
      EXPECT_GE(clearance_m(triangles, points[i], 0.05, 1.2), 0.799);
  }
}

TEST(Corridor, FlushDoorsPostersAndSignsAddNoGeometry) {
  CorridorConfig config = plain();
  config.layout = CorridorConfig::Layout::straight;
  config.length_m = 40;
  config.glass_share = 1;
  const World world = make_corridor(config);
  std::set<std::string> seen;
  for (const WorldTriangle& t : triangles_of(world)) {
    EXPECT_EQ(t.object < 3, true);
    seen.insert(world.materials[static_cast<size_t>(t.material)].name.substr(0, 6));
    const bool end = std::abs(std::abs(t.corners_world[0].x()) - 20) < 1e-9 && std::abs(t.normal().x()) > 0.5;
    if (world.objects[static_cast<size_t>(t.object)].name != "walls" || end) continue;
    for (const Vec3& c : t.corners_world) EXPECT_EQ(std::abs(c.y()), static_cast<double>(1.2f));
  }
  for (const char* painted : {"door_1", "poster", "glass", "exting", "lamp"})
    EXPECT_TRUE(seen.contains(painted)) << painted;
}

TEST(Corridor, JambsStandBackFromTheWall) {
  CorridorConfig config = plain();
  config.layout = CorridorConfig::Layout::straight;
  config.length_m = 40;
  config.jamb_depth_m = 0.15;
  const World world = make_corridor(config);
  size_t recessed = 0, jambs = 0;
  for (const WorldTriangle& t : triangles_of(world)) {
    const std::string& material = world.materials[static_cast<size_t>(t.material)].name;
    for (const Vec3& c : t.corners_world) EXPECT_LE(std::abs(c.y()), 1.35 + 1e-6);
    if (material.starts_with("door_") && material != "door_frame") {
      for (const Vec3& c : t.corners_world) EXPECT_NEAR(std::abs(c.y()), 1.35, 1e-6);
      ++recessed;
    }
    jambs += material == "door_frame" && std::abs(t.normal().x()) > 0.9;
  }
  EXPECT_GT(recessed, 0u);
  EXPECT_GE(jambs, 2 * 2 * 10u);  // two jambs, two walls, ten doors
}

// Share of wall triangles that meet their like after half a turn about the ring's centre.
double half_turn_share(const CorridorConfig& config) {
  const World world = make_corridor(config);
  std::multiset<std::array<int64_t, 4>> places;
  const auto place = [](const WorldTriangle& t, double sign) {
    const Vec3 m = (t.corners_world[0] + t.corners_world[1] + t.corners_world[2]) / 3;
    return std::array<int64_t, 4>{t.material, std::llround(sign * m.x() * 100),
                                  std::llround(sign * m.y() * 100), std::llround(m.z() * 100)};
  };
  std::vector<WorldTriangle> walls;
  for (const WorldTriangle& t : triangles_of(world))
    if (t.object == 1) walls.push_back(t);
  for (const WorldTriangle& t : walls) places.insert(place(t, 1));
  size_t matched = 0;
  for (const WorldTriangle& t : walls) {
    auto turned = place(t, -1);
    bool found = false;
    for (int64_t dx = -1; dx <= 1 && !found; ++dx)
      for (int64_t dy = -1; dy <= 1 && !found; ++dy)
        found = places.contains({turned[0], turned[1] + dx, turned[2] + dy, turned[3]});
    matched += found;
  }
  return static_cast<double>(matched) / static_cast<double>(walls.size());
}

TEST(Corridor, SymmetryAndAliasingMakeTheSidesAlike) {
  CorridorConfig config = plain();
  config.symmetry = config.aliasing = 1;
  EXPECT_GT(half_turn_share(config), 0.999);
  config.symmetry = config.aliasing = 0;
  EXPECT_LT(half_turn_share(config), 0.8);
}

TEST(Corridor, LampsHangUnderTheCeilingInTheirGroups) {
  const World world = make_corridor(plain());
  std::set<std::string> groups;
  for (const Light& light : world.lights) {
    groups.insert(light.group);
    EXPECT_GT(light.position_world.z(), 2.9);
    EXPECT_GT(light.intensity, 0);
  }
  EXPECT_EQ(groups, (std::set<std::string>{"emergency", "lamp"}));
}

TEST(Corridor, SameSeedSameWorldOtherSeedAnother) {
  expect_same(make_corridor({}), make_corridor({}));
  CorridorConfig other = plain();
  other.seed = 2;
  EXPECT_NE(describe(make_corridor(other)), describe(make_corridor(plain())));
}

TEST(Corridor, SizeStaysUseful) {
  const World world = make_corridor({});
  EXPECT_GT(world.triangle_count(), 20'000u);
  EXPECT_LT(world.triangle_count(), 80'000u);
  for (const Texture& t : world.textures)
    EXPECT_EQ(t.rgba.size(), 4 * static_cast<size_t>(t.width_px) * static_cast<size_t>(t.height_px));
}

}  // namespace
}  // namespace vsslam

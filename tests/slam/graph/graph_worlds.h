// Pose graphs with known answers: a trajectory on a surface, odometry edges and edges between its turns.
#pragma once

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "core/rng.h"
#include "slam/graph/pose_graph.h"

namespace vsslam {

struct GraphWorld {
  std::vector<SE3> truth;                  // T_map_node
  std::vector<std::pair<int, int>> pairs;  // odometry first
};

inline SE3 looking_along(const Vec3& position, const Vec3& forward, const Vec3& up) {
  Mat3 r;
  r.col(0) = forward.normalized();
  r.col(1) = up.cross(forward).normalized();
  r.col(2) = r.col(0).cross(r.col(1));
  return {Quat(r), position};
}

/// Turns around a torus (small radius 0: a ring; ring radius 0: a sphere), each pose tied to the turn before.
inline GraphWorld surface_world(int turns, int per_turn, double ring_radius_m, double tube_radius_m) {
  GraphWorld world;
  const int count = turns * per_turn;
  const auto point = [&](double i) -> Vec3 {
    const double u = 2 * M_PI * i / per_turn, v = -1.3 + 2.6 * i / count;
    const double r = ring_radius_m + tube_radius_m * std::cos(v);
    return {r * std::cos(u), r * std::sin(u), tube_radius_m * std::sin(v)};
  };
  for (int i = 0; i < count; ++i)
    world.truth.push_back(looking_along(point(i), point(i + 0.5) - point(i - 0.5), point(i)));
  for (int i = 1; i < count; ++i) world.pairs.emplace_back(i - 1, i);
  for (int i = per_turn; i < count; ++i) world.pairs.emplace_back(i - per_turn, i);
  return world;
}

/// A walk on the streets of a square grid; poses at the same crossing are tied.
inline GraphWorld manhattan_world(int count) {
  GraphWorld world;
  const RandomStream turns(7, "turns");
  Vec3 position = Vec3::Zero();
  int heading = 0;
  for (int i = 0; i < count; ++i) {
    world.truth.push_back(SE3::from_rpy({0, 0, heading * M_PI / 2}, position));
    if (i % 3 == 2) heading += static_cast<int>(turns.bits(static_cast<uint64_t>(i)) % 3) - 1;
    position += Vec3(std::round(std::cos(heading * M_PI / 2)), std::round(std::sin(heading * M_PI / 2)), 0);
  }
  for (int i = 1; i < count; ++i) world.pairs.emplace_back(i - 1, i);
  for (int i = 0; i < count; ++i)
    for (int j = i + 10; j < count; j += 10)
      if ((world.truth[static_cast<size_t>(i)].translation - world.truth[static_cast<size_t>(j)].translation)
              .norm() < 0.1)
        world.pairs.emplace_back(i, j);
  return world;
}

inline Vec6 noise(const RandomStream& stream, int index, double rotation_rad, double translation_m) {
  Vec6 xi;
  for (int k = 0; k < 6; ++k)
    xi[k] = (k < 3 ? rotation_rad : translation_m) *
            stream.normal(static_cast<uint64_t>(index), static_cast<uint64_t>(k));
  return xi;
}

/// A full positive definite matrix, different for each index.
inline Mat6 random_information(int index) {
  const RandomStream stream(5, "information");
  Mat6 a;
  for (int k = 0; k < 36; ++k)
    a(k / 6, k % 6) = stream.normal(static_cast<uint64_t>(index), static_cast<uint64_t>(k));
  return a * a.transpose() + 0.5 * Mat6::Identity();
}

/// Measured edges; the initial poses are the odometry's.
inline PoseGraph measure(const GraphWorld& world, double rotation_rad, double translation_m,
                         bool full_information) {
  PoseGraph graph;
  const RandomStream stream(11, "edges");
  std::vector<PoseEdge> edges;
  for (const auto& [i, j] : world.pairs) {
    PoseEdge edge;
    edge.from = i;
    edge.to = j;
    edge.T_from_to = world.truth[static_cast<size_t>(i)].inverse() * world.truth[static_cast<size_t>(j)] *
                     SE3::exp(noise(stream, static_cast<int>(edges.size()), rotation_rad, translation_m));
    if (full_information) edge.information = random_information(static_cast<int>(edges.size()));
    edge.is_loop = j != i + 1;
    edges.push_back(edge);
  }
  SE3 T_map_node = world.truth[0];
  for (size_t i = 0; i < world.truth.size(); ++i) {
    if (i > 0) T_map_node = T_map_node * edges[i - 1].T_from_to;
    graph.add_node(static_cast<int>(i), T_map_node);
  }
  for (const PoseEdge& edge : edges) graph.add_edge(edge);
  return graph;
}

}  // namespace vsslam

// Costs of the back end: descriptors, their search, ICP between local maps, the pose graph.
#include <benchmark/benchmark.h>

#include "slam/loop/descriptor_database.h"
#include "slam/loop/icp.h"
#include "slam/loop/local_map.h"
#include "tests/slam/graph/graph_worlds.h"
#include "tests/slam/loop/loop_room.h"

namespace vsslam {
namespace {

const Cloud& scan() {
  static const Cloud cloud = scan_room(cluttered_room(), planar(1, 1, 0.2, 0.6), 1800);
  return cloud;
}

void descriptor_build(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(ScanContext(polar_heights(scan(), 0.6, {})));
  state.counters["points"] = static_cast<double>(scan().size());
}
BENCHMARK(descriptor_build)->Unit(benchmark::kMicrosecond);

ScanContext random_context(uint64_t seed) {
  const RandomStream stream(seed, "heights");
  PolarHeights heights;
  for (int k = 0; k < heights.size(); ++k)
    heights(k) = static_cast<float>(3 * stream.uniform(static_cast<uint64_t>(k)));
  return ScanContext(heights);
}

void descriptor_distance(benchmark::State& state) {
  const ScanContext a = random_context(1), b = random_context(2);
  for (auto _ : state) benchmark::DoNotOptimize(scan_context_distance(a, b));
}
BENCHMARK(descriptor_distance)->Unit(benchmark::kMicrosecond);

/// Arguments: descriptors of the query, entries, most pairs to compare without ring keys.
void database_query(benchmark::State& state) {
  DescriptorDatabase database(static_cast<int>(state.range(2)));
  const auto entries = static_cast<size_t>(state.range(1));
  for (size_t i = 0; i < entries; ++i) database.add(static_cast<int>(i), Time{}, random_context(i));
  std::vector<QueryDescriptor> query;
  for (int d = 0; d < state.range(0); ++d)
    query.push_back({random_context(100000 + static_cast<uint64_t>(d)), d, {0, 0}});
  for (auto _ : state) benchmark::DoNotOptimize(database.find(query, entries));
}
BENCHMARK(database_query)
    ->Args({1, 500, 2000})
    ->Args({17, 50, 2000})
    ->Args({17, 10000, 2000})
    ->Args({17, 10000, 1 << 30})
    ->Unit(benchmark::kMillisecond);

/// 51 key scans of a corridor, one every metre, with the voxels of the front end.
std::vector<KeyScan> corridor_keys(double voxel_m) {
  std::vector<KeyScan> keys;
  for (int id = 0; id < 51; ++id) {
    KeyScan key;
    key.id = id;
    key.T_map_base = planar(id - 25.0, 0.2 * std::sin(0.3 * id), 0.05 * std::sin(0.5 * id), 0.6);
    key.features_lidar = share(voxel_means(scan_room(long_corridor(), key.T_map_base, 1800), voxel_m));
    keys.push_back(std::move(key));
  }
  return keys;
}

void local_map_build(benchmark::State& state) {
  const double voxel_m = 0.01 * static_cast<double>(state.range(0));
  const std::vector<KeyScan> keys = corridor_keys(voxel_m);
  size_t points = 0;
  for (auto _ : state) points = LocalMaps({.voxel_m = voxel_m}, SE3()).around(25, 51, keys)->points().size();
  state.counters["points"] = static_cast<double>(points);
}
BENCHMARK(local_map_build)->Arg(20)->Arg(40)->Unit(benchmark::kMillisecond);

void icp(benchmark::State& state) {
  const double voxel_m = 0.01 * static_cast<double>(state.range(0));
  const IcpConfig config{.max_correspondence_m = static_cast<double>(state.range(1))};
  const std::vector<KeyScan> keys = corridor_keys(voxel_m);
  const auto target = LocalMaps({.voxel_m = voxel_m}, SE3()).around(25, 51, keys);
  const SE3 truth = planar(0.3, 0.5, 0.05);
  const Cloud source = voxel_means(scan_room(long_corridor(), keys[25].T_map_base * truth, 1800), voxel_m);
  IcpResult result;
  for (auto _ : state) result = align(source, *target, SE3(), config, 0.5);
  state.counters["iterations"] = result.iterations;
  state.counters["source"] = static_cast<double>(source.size());
  state.counters["error_m"] = (result.T_target_source.inverse() * truth).translation.norm();
}
BENCHMARK(icp)->Args({20, 2})->Args({20, 40})->Args({40, 2})->Args({40, 40})->Unit(benchmark::kMillisecond);

/// Optimises a graph of 2000 poses after a new loop, from near its optimum.
void optimize_after_loop(benchmark::State& state, const GraphWorld& world) {
  PoseGraph solved = measure(world, 0.002, 0.02, false);
  solved.optimize({});
  int iterations = 0;
  for (auto _ : state) {
    state.PauseTiming();
    PoseGraph graph = solved;
    graph.add_edge(
        {.from = 3,
         .to = 1500,
         .T_from_to = graph.pose(3).inverse() * graph.pose(1500) * SE3(Quat::Identity(), {0.3, 0, 0})});
    state.ResumeTiming();
    iterations = graph.optimize({}).iterations;
  }
  state.counters["iterations"] = iterations;
}

void pose_graph_2000(benchmark::State& state) {
  optimize_after_loop(state, surface_world(40, 50, 30, 10));
}
BENCHMARK(pose_graph_2000)->Unit(benchmark::kMillisecond);

/// As in a drive: odometry and a few loops.
void pose_graph_2000_chain(benchmark::State& state) {
  GraphWorld world = surface_world(40, 50, 30, 10);
  world.pairs.resize(1999);
  for (int k = 0; k < 40; ++k) world.pairs.emplace_back(10 * k, 1999 - 11 * k);
  optimize_after_loop(state, world);
}
BENCHMARK(pose_graph_2000_chain)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace vsslam

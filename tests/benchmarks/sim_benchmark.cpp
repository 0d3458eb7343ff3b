// Steps of the dynamics per second while driving, and what sampling the truth costs.
#include <benchmark/benchmark.h>

#include "sim/simulation.h"
#include "worlds/factory/world_source.h"

namespace vsslam {
namespace {

// real_time_factor: simulated seconds per second of one core (target: 60), in the corridor ring.
void drive_corridor(benchmark::State& state) {
  const World world = make_world({});
  DriveScript script;
  load_config_text("steps: [{follow: {route: ring, laps: 5}}]", "benchmark", script);
  Simulation simulation(world, {}, script);
  for (auto _ : state) {
    simulation.advance(simulation.now() + Duration{100'000'000});
    simulation.forget_before(simulation.now() - Duration{1'000'000'000});
  }
  state.counters["real_time_factor"] =
      benchmark::Counter(0.1 * static_cast<double>(state.iterations()), benchmark::Counter::kIsRate);
  state.counters["triangles"] = static_cast<double>(world.triangle_count());
}
BENCHMARK(drive_corridor)->MinTime(1);

void drive_uneven_floor(benchmark::State& state) {
  World world;
  world.floor.unevenness_m = 0.003;
  DriveScript script;
  load_config_text("steps: [{follow: {waypoints: [{x_m: 0}, {x_m: 1000}]}}]", "benchmark", script);
  Simulation simulation(world, {}, script);
  for (auto _ : state) simulation.advance(simulation.now() + Duration{100'000'000});
  state.counters["real_time_factor"] =
      benchmark::Counter(0.1 * static_cast<double>(state.iterations()), benchmark::Counter::kIsRate);
}
BENCHMARK(drive_uneven_floor);

void sample_pose(benchmark::State& state) {
  Trajectory trajectory;
  for (int64_t n = 0; n < 100; ++n)
    trajectory.push(Time{n * 10'000'000}, SE3::from_rpy({0.001, 0.002, 0.01 * static_cast<double>(n)},
                                                        {0.01 * static_cast<double>(n), 0, 0}));
  int64_t ns = 10'000'000;
  for (auto _ : state) {
    benchmark::DoNotOptimize(trajectory.pose(Time{ns}));
    ns = 10'000'000 + (ns + 55'296) % 900'000'000;
  }
}
BENCHMARK(sample_pose);

}  // namespace
}  // namespace vsslam

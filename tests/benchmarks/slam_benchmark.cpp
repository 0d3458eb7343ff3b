// Costs of the front end on VLP-16 scans of an analytic corridor with door jambs and of a room.
//   ./vsslam bench slam
#include <benchmark/benchmark.h>

#include "slam/lidar/lidar_odometry.h"
#include "slam/undistort.h"
#include "tests/slam/analytic_scene.h"

namespace vsslam {
namespace {

using namespace testing_scene;

LidarScan scan_at(const Scene& scene, double x_m, Time stamp) {
  const SE3 T_scene_base(Quat::Identity(), {x_m, 0.1, 0.2});
  return scan(
      scene, [=](double) { return T_scene_base; }, rig(), stamp);
}

constexpr double kSigma_m = 0.007;

struct Prepared {
  LidarOdometryConfig config;
  LidarOdometry odometry{config, kSigma_m};
  LidarScan scan;
  Cloud points_lidar;
  std::vector<Feature> features, thin;
  SE3 T_odom_lidar;

  explicit Prepared(const Scene& scene) {
    for (int i = 0; i < 25; ++i) {
      take(scene, 0.2 * i);
      odometry.insert_key(features, T_odom_lidar * rig().lidar.T_base_lidar.inverse(),
                          rig().lidar.T_base_lidar);
    }
    take(scene, 2.55);
  }
  void take(const Scene& scene, double x_m) {
    scan = scan_at(scene, x_m, Time::from_seconds(x_m));
    points_lidar = undistort(scan, MotionPath(scan.stamp), rig().lidar.T_base_lidar);
    features = thin_features(
        select_planar_features(scan, points_lidar, kSigma_m, config.features), odometry.map_voxel_m());
    thin = thin_features(features, odometry.voxel_m());
    T_odom_lidar = SE3(Quat::Identity(), {x_m, 0.1, 0.2}) * rig().lidar.T_base_lidar;
  }
};
const Prepared& corridor_scene() {
  static const Prepared prepared(jambed_corridor(60, 4, 0.15));
  return prepared;
}

void BM_Undistort(benchmark::State& state) {
  const Prepared& p = corridor_scene();
  MotionPath path(p.scan.stamp);
  for (int i = 1; i <= 10; ++i)
    path.append(p.scan.stamp + Duration{i * 10'000'000}, SE3::from_rpy({0, 0, 0.01 * i}, {0.01 * i, 0, 0}));
  for (auto unused : state) benchmark::DoNotOptimize(undistort(p.scan, path, rig().lidar.T_base_lidar));
  state.counters["points"] = static_cast<double>(p.scan.points.size());
}
BENCHMARK(BM_Undistort)->Unit(benchmark::kMillisecond);

void BM_Features(benchmark::State& state) {
  const Prepared& p = corridor_scene();
  for (auto unused : state)
    benchmark::DoNotOptimize(select_planar_features(p.scan, p.points_lidar, kSigma_m, p.config.features));
  state.counters["features"] = static_cast<double>(p.features.size());
}
BENCHMARK(BM_Features)->Unit(benchmark::kMillisecond);

void BM_Thin(benchmark::State& state) {
  const Prepared& p = corridor_scene();
  for (auto unused : state) benchmark::DoNotOptimize(thin_features(p.features, p.odometry.voxel_m()));
  state.counters["kept"] = static_cast<double>(p.thin.size());
}
BENCHMARK(BM_Thin)->Unit(benchmark::kMillisecond);

void BM_Register(benchmark::State& state) {
  const Prepared& p = corridor_scene();
  Vec6 offset;
  offset << 0.001, 0.001, 0.002, 0.01, -0.01, 0.005;
  LidarOdometry odometry = p.odometry;
  const PosePrior prior{p.T_odom_lidar * SE3::exp(offset), 1e-4 * Mat6::Identity()};
  Registration r;
  for (auto unused : state) {
    r = odometry.align(p.thin, prior);
    benchmark::DoNotOptimize(r);
  }
  state.counters["iterations"] = r.iterations;
  state.counters["correspondences"] = r.correspondences;
}
BENCHMARK(BM_Register)->Unit(benchmark::kMillisecond);

void BM_RebuildLocalMap(benchmark::State& state) {
  const Prepared& p = corridor_scene();
  LidarOdometry odometry = p.odometry;
  for (auto unused : state)
    odometry.insert_key(p.features, SE3(Quat::Identity(), {2.55, 0.1, 0.2}), rig().lidar.T_base_lidar);
}
BENCHMARK(BM_RebuildLocalMap)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace vsslam

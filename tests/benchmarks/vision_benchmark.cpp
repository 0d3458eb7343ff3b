// Costs of the visual front end, one core: images of 640 x 480 with 150 features, depth from a stack of scans.
#include <benchmark/benchmark.h>

#include <opencv2/core/utility.hpp>

#include "slam/depth/lidar_depth.h"
#include "slam/vision/epipolar.h"
#include "slam/vision/feature_tracker.h"
#include "tests/slam/analytic_scene.h"
#include "tests/slam/vision/visual_scene.h"

namespace vsslam {
namespace {

// Sideways and ahead at 0.5 m/s, swinging; 40 images.
struct Film {
  CameraCalibration camera;
  std::vector<CameraFrame> images;
  std::vector<SE3> T_odom_camera;

  explicit Film(const testing_vision::Picture& picture) {
    const testing_vision::WaveTexture texture(3, 0.1, 0.6);
    for (int k = 0; k < 40; ++k) {
      const double t = k / 30.0;
      T_odom_camera.push_back(testing_vision::before_plane({0.02 * std::sin(3 * t), 0.1 * std::sin(2 * t), 0},
                                                           {0.3 * t, 0, 0.4 * t}));
      images.push_back(testing_vision::render(texture, camera, T_odom_camera.back(),
                                              testing_vision::frame_time(k), picture));
    }
  }
  // There and back again, for as long as one likes.
  size_t index(int64_t step) const {
    const auto n = static_cast<int64_t>(images.size()), k = step % (2 * n - 2);
    return static_cast<size_t>(k < n ? k : 2 * n - 2 - k);
  }
};

void track(benchmark::State& state, const Film& film, bool with_rotation) {
  cv::setNumThreads(1);
  FeatureTracker tracker({}, film.camera);
  size_t features = 0, detected = 0;
  int64_t step = 0;
  for (auto unused : state) {
    const size_t now = film.index(step), last = film.index(step == 0 ? 0 : step - 1);
    const Quat q_last_now = (film.T_odom_camera[last].inverse() * film.T_odom_camera[now]).rotation;
    features += tracker.track(film.images[now], with_rotation ? &q_last_now : nullptr).features.size();
    detected += static_cast<size_t>(tracker.counts().detected);
    ++step;
  }
  state.counters["features"] = static_cast<double>(features) / static_cast<double>(step);
  state.counters["new"] = static_cast<double>(detected) / static_cast<double>(step);
}

void BM_Track(benchmark::State& state) {
  static const Film film({.noise_grey = 2});
  track(state, film, true);
}
BENCHMARK(BM_Track)->Unit(benchmark::kMillisecond);

void BM_TrackWithoutGyroscope(benchmark::State& state) {
  static const Film film({.noise_grey = 2});
  track(state, film, false);
}
BENCHMARK(BM_TrackWithoutGyroscope)->Unit(benchmark::kMillisecond);

void BM_TrackDark(benchmark::State& state) {
  static const Film film({.gain = 0.15, .noise_grey = 0.7});
  track(state, film, true);
}
BENCHMARK(BM_TrackDark)->Unit(benchmark::kMillisecond);

void BM_FindAllCorners(benchmark::State& state) {
  static const Film film({.noise_grey = 2});
  const CameraFrame& image = film.images.front();
  const GreyView view{image.grey.data(), image.width_px, image.height_px, image.width_px};
  for (auto unused : state) benchmark::DoNotOptimize(find_corners(view, 2, {}, 150, {}));
}
BENCHMARK(BM_FindAllCorners)->Unit(benchmark::kMillisecond);

// A drive of 3 s along a jambed corridor.
struct Stack {
  RigCalibration rig = testing_scene::rig();
  LidarDepth depth;
  Cloud points_lidar;

  static SE3 pose(int k) { return SE3(Quat::Identity(), {0.1 * k, 0.1, 0.2}); }
  explicit Stack(RigCalibration r) : rig(r), depth({}, rig) {
    const testing_scene::Scene scene = testing_scene::jambed_corridor(60, 4, 0.15);
    for (int k = 0; k < 50; ++k) {
      const Time stamp{k * int64_t{100'000'000}};
      points_lidar.clear();
      for (const LidarPoint& p : testing_scene::scan(
                                     scene, [&](double) { return pose(k); }, rig, stamp)
                                     .points)
        points_lidar.emplace_back(p.x, p.y, p.z);
      depth.add(stamp, points_lidar, pose(k));
    }
  }
};
Stack& stack() {
  static Stack stack([] {
    RigCalibration rig = testing_scene::rig();
    Mat3 R_base_camera;
    R_base_camera << 0, 0, 1, -1, 0, 0, 0, -1, 0;
    rig.camera.T_base_camera = SE3(Quat(R_base_camera), {0.2, 0, 0.35});
    return rig;
  }());
  return stack;
}

void BM_DepthAddScan(benchmark::State& state) {
  Stack& s = stack();
  for (auto unused : state) s.depth.add({int64_t{4'950'000'000}}, s.points_lidar, Stack::pose(49));
  state.counters["points"] = static_cast<double>(s.depth.points());
}
BENCHMARK(BM_DepthAddScan)->Unit(benchmark::kMillisecond);

void BM_DepthFill(benchmark::State& state) {
  Stack& s = stack();
  VisualFrame frame{.stamp = {int64_t{4'950'000'000}}, .features = {}};
  for (int k = 0; k < 150; ++k)
    frame.features.push_back({k, Vec2::Zero(), Vec2((k % 15 - 7) * 0.1, (k / 15 - 4.5) * 0.12), 0});
  int with_depth = 0;
  for (auto unused : state) s.depth.fill(frame, Stack::pose(49) * s.rig.camera.T_base_camera);
  for (const VisualFeature& f : frame.features) with_depth += f.depth_m > 0 ? 1 : 0;
  state.counters["with_depth"] = with_depth;
}
BENCHMARK(BM_DepthFill)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace vsslam

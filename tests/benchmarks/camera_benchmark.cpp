// How fast the camera is, on one core: whole images of 640 x 480 with every default effect in a lit corridor of about
// 50 000 triangles, and how that time divides: rendering, and what the image sensor makes of it. Times are CPU times of
// the thread.
//
//   out/build/release/tests/benchmarks/bench_camera
#include <benchmark/benchmark.h>

#include <cmath>
#include <memory>

#include "core/ordered_parallel.h"
#include "scenarios/datasets/formats/png_file.h"
#include "sensors/camera/camera.h"
#include "tests/sensors/shapes.h"
#include "worlds/indoor/corridor.h"

namespace vsslam {
namespace {

/// A ring with doors, panels and lamps; its triangles are as small as make 50 000.
struct Scene {
  World world;
  Raycaster raycaster;
  Renderer renderer;
  Trajectory drive;
  SE3 T_base_camera = SE3::from_rpy({-M_PI / 2, 0, -M_PI / 2}, {0.32, 0, 0.53});

  static CorridorConfig corridor() {
    CorridorConfig config;
    config.tessellation_m = 0.3;
    return config;
  }
  Scene()
      : world(make_corridor(corridor())),
        raycaster(world),
        renderer(world, raycaster, LightingConfig{}),
        drive(along_route(world.routes.at(0))) {}

  /// 1 m/s along the first leg.
  static Trajectory along_route(const Route& route) {
    const Vec3 from = route.points_world[0], ahead = (route.points_world[1] - from).normalized();
    const double yaw = std::atan2(ahead.y(), ahead.x());
    return shapes::along([=](double t) { return SE3::from_rpy({0, 0, yaw}, from + ahead * t); }, 4);
  }
  ViewSource source() const {
    return [this](const SE3& pose, const ViewRays& rays, View& view) { renderer.render(pose, rays, view); };
  }
};

Scene& scene() {
  static Scene one;
  return one;
}

void images(benchmark::State& state, CameraConfig config) {
  set_thread_count(1);
  Scene& s = scene();
  const auto camera = std::make_unique<Camera>(config, SensorEvents{}, 1);
  camera->power_on(Time{0});
  size_t count = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(camera->take(1, s.drive, s.T_base_camera, s.source()));
    if (++count; camera->end().seconds() > 3.9) camera->power_on(Time{0});
  }
  state.counters["images/s"] = benchmark::Counter(static_cast<double>(count), benchmark::Counter::kIsRate);
  state.counters["triangles"] = static_cast<double>(s.world.triangle_count());
}

void views(benchmark::State& state) {
  set_thread_count(1);
  Scene& s = scene();
  const ViewRays rays = CameraOptics(CameraConfig{}).rays();
  const SE3 T_world_camera = s.drive.pose(Time{1'000'000'000}) * s.T_base_camera;
  View view;
  for (auto _ : state) {
    s.renderer.render(T_world_camera, rays, view);
    benchmark::DoNotOptimize(view.luminance.data());
  }
}

std::vector<float> forward(const CameraOptics& optics) {
  std::vector<float> cosines;
  for (const Vec3f& ray : optics.rays().direction_camera) cosines.push_back(ray.z());
  return cosines;
}

void imaging(benchmark::State& state, CameraConfig config) {
  const ImageSensor sensor(config, forward(CameraOptics(config)), 1);
  const std::vector<float> luminance(640 * 480, 60.0f);
  std::vector<uint8_t> grey(luminance.size());
  uint64_t image = 0;
  for (auto _ : state)
    benchmark::DoNotOptimize(sensor.expose(luminance, {Duration{3'000'000}, 4}, ++image, grey));
}

void png(benchmark::State& state) {
  const ImageSensor sensor(CameraConfig{}, forward(CameraOptics(CameraConfig{})), 1);
  const std::vector<float> luminance(640 * 480, 60.0f);
  std::vector<uint8_t> grey(luminance.size());
  sensor.expose(luminance, {Duration{3'000'000}, 4}, 1, grey);
  for (auto _ : state) benchmark::DoNotOptimize(encode_png_grey8(640, 480, grey));
}

CameraConfig sharp() {
  CameraConfig config;
  config.motion_blur = false;
  return config;
}

BENCHMARK_CAPTURE(images, all_effects, CameraConfig{})->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(images, one_view, sharp())->Unit(benchmark::kMillisecond);
BENCHMARK(views)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(imaging, all_effects, CameraConfig{})->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(imaging, ideal, CameraConfig::ideal())->Unit(benchmark::kMillisecond);
BENCHMARK(png)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace vsslam

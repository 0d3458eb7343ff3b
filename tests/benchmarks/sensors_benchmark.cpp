// How fast LiDAR and camera are, on one core: whole scans and pictures per second, and tracing against a bare
// Embree packet loop over the same rays. Times are CPU times of the thread.
//
//   out/build/release/tests/benchmarks/bench_sensors
#include <benchmark/benchmark.h>
#include <embree3/rtcore.h>
#include <time.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>

#include "core/ordered_parallel.h"
#include "core/rng.h"
#include "sensors/imu.h"
#include "sensors/lidar/lidar.h"
#include "sensors/render/beam.h"
#include "sensors/render/renderer.h"
#include "tests/sensors/shapes.h"
#include "worlds/indoor/corridor.h"

namespace vsslam {
namespace {

/// A grid of quads over a parallelogram, cells of about `cell_m`, displaced along its normal by up to `relief_m`.
Primitive grid(const Vec3& corner, const Vec3& u, const Vec3& v, double cell_m, double relief_m = 0) {
  const RandomStream relief(1, "relief");
  const int nu = std::max(1, static_cast<int>(u.norm() / cell_m)),
            nv = std::max(1, static_cast<int>(v.norm() / cell_m));
  const Vec3 normal = u.cross(v).normalized();
  Primitive p;
  for (int j = 0; j <= nv; ++j) {
    for (int i = 0; i <= nu; ++i) {
      const double h = relief_m * relief.uniform(static_cast<uint64_t>(i), static_cast<uint64_t>(j));
      p.positions.push_back((corner + u * i / nu + v * j / nv + h * normal).cast<float>());
      p.normals.push_back(normal.cast<float>());
    }
  }
  const auto at = [&](int i, int j) { return static_cast<uint32_t>(j * (nu + 1) + i); };
  for (int j = 0; j < nv; ++j) {
    for (int i = 0; i < nu; ++i) {
      p.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      p.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
  return p;
}

void add_box(World& world, const Vec3& low, const Vec3& size, double cell_m, double relief_m = 0) {
  const Vec3 x(size.x(), 0, 0), y(0, size.y(), 0), z(0, 0, size.z());
  const Vec3 high = low + size;
  shapes::add(world, grid(low, z, y, cell_m, relief_m), "box", 0);
  shapes::add(world, grid(low, x, z, cell_m, relief_m), "box", 0);
  shapes::add(world, grid(low, y, x, cell_m, relief_m), "box", 0);
  shapes::add(world, grid(high, -y, -z, cell_m, relief_m), "box", 0);
  shapes::add(world, grid(high, -z, -x, cell_m, relief_m), "box", 0);
  shapes::add(world, grid(high, -x, -y, cell_m, relief_m), "box", 0);
}

/// 80 m of corridor, 2.4 m wide, 2.8 m high, with door jambs every 5 m: about 50 000 triangles.
World corridor() {
  World world;
  world.name = "corridor";
  world.materials = {shapes::paint(0.6f)};
  const Vec3 low(-40, -1.2, 0), x(80, 0, 0), y(0, 2.4, 0), z(0, 0, 2.8);
  shapes::add(world, grid(low, x, y, 0.22), "floor", 0);
  shapes::add(world, grid(low + z, y, x, 0.22), "ceiling", 0);
  shapes::add(world, grid(low, z, x, 0.22), "wall", 0);
  shapes::add(world, grid(low + y, x, z, 0.22), "wall", 0);
  shapes::add(world, grid(low, y, z, 0.22), "end", 0);
  shapes::add(world, grid(low + x, z, y, 0.22), "end", 0);
  for (int i = 0; i < 16; ++i)
    for (double side : {-1.2, 1.12}) add_box(world, {-38 + 5.0 * i, side, 0}, {0.12, 0.08, 2.1}, 0.1);
  return world;
}

/// Four blocks of houses with relief, a paved street, 60 trees of loose leaves: a million triangles.
World street() {
  World world;
  world.name = "street";
  world.materials = {shapes::paint(0.3f)};
  shapes::add(world, grid({-100, -100, 0}, {200, 0, 0}, {0, 200, 0}, 0.5, 0.01), "ground", 0);
  for (double x : {-70.0, 10.0})
    for (double y : {-60.0, 8.0}) add_box(world, {x, y, 0}, {60, 50, 15}, 0.2, 0.05);
  const RandomStream leaves(2, "leaves");
  Primitive all;
  for (uint64_t tree = 0; tree < 60; ++tree) {
    const Vec3 crown(-90 + 3.0 * static_cast<double>(tree), tree % 2 == 0 ? -5.5 : 5.5, 4);
    for (uint64_t leaf = 0; leaf < 5000; ++leaf) {
      const auto draw = [&](uint64_t k) { return leaves.normal(tree * 5000 + leaf, k); };
      const Vec3 p = crown + 0.8 * Vec3(draw(0), draw(1), draw(2));
      for (uint64_t corner = 0; corner < 3; ++corner) {
        const Vec3 d(draw(3 + 3 * corner), draw(4 + 3 * corner), draw(5 + 3 * corner));
        all.positions.push_back((p + 0.05 * d).cast<float>());
        all.normals.push_back(Vec3f::UnitZ());
      }
      const auto first = static_cast<uint32_t>(all.positions.size()) - 3;
      all.triangles.push_back({first, first + 1, first + 2});
    }
  }
  shapes::add(world, std::move(all), "trees", 0);
  return world;
}

struct Scene {
  World world;
  Trajectory trajectory;
  Raycaster raycaster;
  explicit Scene(World w)
      : world(std::move(w)),
        trajectory(shapes::along(
            [](double t) {
              const SE3 sway = shapes::lively(t);
              return SE3(sway.rotation, Vec3(t - 2, 0.1 * std::sin(t), 0.6));
            },
            4.5)),
        raycaster(world) {}
};

Scene& scene(int which) {
  static Scene near(corridor());
  static std::unique_ptr<Scene> wide;
  if (which == 0) return near;
  if (!wide) wide = std::make_unique<Scene>(street());
  return *wide;
}

size_t triangles(const World& world) {
  size_t count = 0;
  for (const Mesh& mesh : world.meshes)
    for (const Primitive& primitive : mesh.primitives) count += primitive.triangles.size();
  return count;
}

/// Whole scans: pose per firing, all default errors, truth of every point, one ray per beam.
void scans(benchmark::State& state, int which, LidarConfig config) {
  set_thread_count(1);
  Scene& s = scene(which);
  Lidar lidar(config, {}, 1, s.raycaster);
  Revolution revolution = lidar.power_on(Time{0});
  size_t points = 0, count = 0;
  for (auto _ : state) {
    const LidarMeasurement m = lidar.scan(revolution, s.trajectory, SE3());
    benchmark::DoNotOptimize(m.scan.points.data());
    points += m.scan.points.size(), ++count;
    revolution = lidar.after(revolution);
    if (lidar.end(revolution).seconds() > 4.4) revolution = lidar.power_on(Time{0});
  }
  state.counters["scans/s"] = benchmark::Counter(static_cast<double>(count), benchmark::Counter::kIsRate);
  state.counters["points"] = static_cast<double>(points) / static_cast<double>(count);
  state.counters["triangles"] = static_cast<double>(triangles(s.world));
}

double cpu_s() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

/// The same scene and rays with Embree alone.
class BareEmbree {
 public:
  explicit BareEmbree(const World& world)
      : device_(rtcNewDevice("isa=avx2,threads=1")), scene_(rtcNewScene(device_)) {
    rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);
    for (const Object& object : world.objects)
      for (const Primitive& p : world.meshes[static_cast<size_t>(object.mesh)].primitives)
        attach(p, object.T_world_object);
    rtcCommitScene(scene_);
  }
  ~BareEmbree() {
    rtcReleaseScene(scene_);
    rtcReleaseDevice(device_);
  }
  BareEmbree(const BareEmbree&) = delete;
  BareEmbree& operator=(const BareEmbree&) = delete;

  static std::vector<RTCRayHit16> prepare(const std::vector<RayPacket>& rays) {
    std::vector<RTCRayHit16> packets(rays.size());
    for (size_t i = 0; i < rays.size(); ++i) {
      std::memset(&packets[i], 0, sizeof(RTCRayHit16));
      std::memcpy(packets[i].ray.org_x, rays[i].origin_x, 64);
      std::memcpy(packets[i].ray.org_y, rays[i].origin_y, 64);
      std::memcpy(packets[i].ray.org_z, rays[i].origin_z, 64);
      std::memcpy(packets[i].ray.dir_x, rays[i].direction_x, 64);
      std::memcpy(packets[i].ray.dir_y, rays[i].direction_y, 64);
      std::memcpy(packets[i].ray.dir_z, rays[i].direction_z, 64);
      std::memcpy(packets[i].ray.tnear, rays[i].near_m, 64);
      std::memcpy(packets[i].ray.tfar, rays[i].far_m, 64);
      for (int k = 0; k < 16; ++k)
        packets[i].hit.geomID[k] = RTC_INVALID_GEOMETRY_ID, packets[i].ray.mask[k] = ~0u;
    }
    return packets;
  }
  void trace(std::vector<RTCRayHit16>& packets) const {
    alignas(64) static const int all[16] = {-1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1};
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    for (RTCRayHit16& packet : packets) rtcIntersect16(all, scene_, &context, &packet);
  }

 private:
  void attach(const Primitive& p, const Eigen::Affine3d& T_world_object) {
    RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* vertex = static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0,
                                                               RTC_FORMAT_FLOAT3, 12, p.positions.size()));
    for (const Vec3f& position : p.positions) {
      const Vec3f placed = (T_world_object * position.cast<double>()).cast<float>();
      std::memcpy(vertex, placed.data(), 12);
      vertex += 3;
    }
    void* indices =
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12, p.triangles.size());
    std::memcpy(indices, p.triangles.data(), 12 * p.triangles.size());
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene_, geometry);
    rtcReleaseGeometry(geometry);
  }

  RTCDevice device_;
  RTCScene scene_;
};

double median(std::vector<double>& v) {
  std::nth_element(v.begin(), v.begin() + static_cast<std::ptrdiff_t>(v.size() / 2), v.end());
  return v[v.size() / 2];
}

void compare(benchmark::State& state, std::vector<double>& bare_s, std::vector<double>& ours_s) {
  const double bare = median(bare_s), ours = median(ours_s);
  state.counters["bare_ms"] = 1e3 * bare;
  state.counters["ours_ms"] = 1e3 * ours;
  state.counters["ratio"] = ours / bare;
}

void tracing(benchmark::State& state, int which) {
  set_thread_count(1);
  Scene& s = scene(which);
  const BareEmbree bare(s.world);
  Lidar lidar({}, {}, 1, s.raycaster);
  const std::vector<RayPacket> rays = lidar.rays(lidar.power_on(Time{0}), s.trajectory, SE3());
  const std::vector<RTCRayHit16> prepared = BareEmbree::prepare(rays);
  std::vector<HitPacket> hits(rays.size());
  std::vector<double> bare_s, ours_s;
  for (auto _ : state) {
    std::vector<RTCRayHit16> packets = prepared;
    const double t0 = cpu_s();
    bare.trace(packets);
    const double t1 = cpu_s();
    // Packet by packet, as the LiDAR does it.
    for (size_t i = 0; i < rays.size(); ++i) s.raycaster.trace({&rays[i], 1}, {&hits[i], 1});
    const double t2 = cpu_s();
    benchmark::DoNotOptimize(hits.data());
    bare_s.push_back(t1 - t0);
    ours_s.push_back(t2 - t1);
  }
  compare(state, bare_s, ours_s);
}

/// A camera of 640 x 480 pixels in the default corridor, with its textures and lamps.
struct CameraScene {
  static constexpr int kWidth_px = 640, kHeight_px = 480;
  static constexpr double kFocal_px = 384.2;
  World world = make_corridor({});
  Raycaster raycaster{world};
  ViewRays rays = pinhole();
  static ViewRays pinhole() {
    std::vector<Vec3f> directions;
    for (int y = 0; y < kHeight_px; ++y)
      for (int x = 0; x < kWidth_px; ++x)
        directions.push_back(
            Vec3((x - 319.5) / kFocal_px, (y - 236.4) / kFocal_px, 1).normalized().cast<float>());
    return {kWidth_px, kHeight_px, std::move(directions), static_cast<float>(1 / kFocal_px)};
  }
  /// Along the southern side, a little askew.
  static SE3 T_world_camera(int frame) {
    const double half_turn = 1.5707963267948966;
    return SE3::from_rpy({-half_turn, 0, -half_turn + 0.1 * std::sin(0.3 * frame)},
                         {-25 + 0.1 * (frame % 500), -9, 0.65});
  }
};

/// The rays of a beam in packets.
void unpack(const Beam& beam, std::vector<RayPacket>& packets) {
  for (int first = 0; first < Beam::kRays; first += RayPacket::kRays) {
    RayPacket& p = packets.emplace_back();
    for (int i = 0; i < RayPacket::kRays; ++i) {
      p.origin_x[i] = beam.origin.x(), p.origin_y[i] = beam.origin.y(), p.origin_z[i] = beam.origin.z();
      p.direction_x[i] = beam.x[first + i], p.direction_y[i] = beam.y[first + i];
      p.direction_z[i] = beam.z[first + i];
      p.near_m[i] = 0.02f, p.far_m[i] = 1e5f;
    }
  }
}

/// What a picture's rays hit, as the renderer finds it (beams, and packets where those give up), against a loop of bare
/// Embree packets. Both begin with the rays in the world frame.
void camera_tracing(benchmark::State& state) {
  set_thread_count(1);
  const CameraScene s;
  const BareEmbree bare(s.world);
  const TriangleTree tree{PlacedTriangles(s.world)};
  std::vector<double> bare_s, ours_s;
  std::vector<BeamHits> hits(s.rays.tiles.size());
  std::vector<SurfacePacket> surfaces(4);
  std::vector<RayPacket> singly;
  size_t given_up = 0;
  int frame = 0;
  for (auto _ : state) {
    const SE3 pose = CameraScene::T_world_camera(frame++);
    std::vector<Beam> beams;
    std::vector<RayPacket> packets;
    for (const RayTile& tile : s.rays.tiles) {
      beams.push_back(beam_of(tile, pose.translation.cast<float>(), pose.matrix3().cast<float>()));
      unpack(beams.back(), packets);
    }
    std::vector<RTCRayHit16> prepared = BareEmbree::prepare(packets);
    const double t0 = cpu_s();
    bare.trace(prepared);
    const double t1 = cpu_s();
    for (size_t i = 0; i < beams.size(); ++i) {
      if (trace(tree, beams[i], {}, 0.02f, hits[i])) continue;
      ++given_up;
      singly.clear();
      unpack(beams[i], singly);
      s.raycaster.trace(singly, surfaces);
    }
    const double t2 = cpu_s();
    benchmark::DoNotOptimize(hits.data());
    bare_s.push_back(t1 - t0);
    ours_s.push_back(t2 - t1);
  }
  compare(state, bare_s, ours_s);
  state.counters["given_up"] =
      static_cast<double>(given_up) / static_cast<double>(frame) / static_cast<double>(hits.size());
}

/// Radiance pictures, without the errors of a camera.
void camera_views(benchmark::State& state) {
  set_thread_count(1);
  const CameraScene s;
  const double t0 = cpu_s();
  const Renderer renderer(s.world, s.raycaster, {});
  state.counters["bake_s"] = cpu_s() - t0;
  View view;
  int frame = 0;
  for (auto _ : state) renderer.render(CameraScene::T_world_camera(frame++), s.rays, view);
  state.counters["views/s"] = benchmark::Counter(frame, benchmark::Counter::kIsRate);
  state.counters["triangles"] = static_cast<double>(s.world.triangle_count());
}

void imu_samples(benchmark::State& state) {
  Scene& s = scene(0);
  int64_t index = 0;
  Imu imu({}, SE3(), 1);
  for (auto _ : state) {
    benchmark::DoNotOptimize(imu.measure(index, s.trajectory));
    if (++index > 400) index = 0;
  }
}

LidarConfig footprint() {
  LidarConfig config;
  config.sub_rays = 7;
  return config;
}

BENCHMARK_CAPTURE(scans, corridor, 0, LidarConfig{})->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(scans, corridor_without_errors, 0, LidarConfig::ideal())->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(scans, corridor_seven_sub_rays, 0, footprint())->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(scans, street, 1, LidarConfig{})->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(tracing, corridor, 0)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(tracing, street, 1)->Unit(benchmark::kMillisecond);
BENCHMARK(camera_tracing)->Unit(benchmark::kMillisecond);
BENCHMARK(camera_views)->Unit(benchmark::kMillisecond);
BENCHMARK(imu_samples);

}  // namespace
}  // namespace vsslam

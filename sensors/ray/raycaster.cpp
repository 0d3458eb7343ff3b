#include "sensors/ray/raycaster.h"

#include <embree3/rtcore.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <stdexcept>
#include <tuple>
#include <utility>

#include "core/errors.h"

namespace vsslam {

namespace {

/// n . x = offset in the world, n a unit vector; n = 0 for a degenerate triangle.
struct Plane {
  double nx, ny, nz, offset;
};

struct TracedObject {
  RTCGeometry geometry = nullptr;
  std::vector<Plane> planes;   ///< by triangle
  std::vector<int> materials;  ///< by triangle
  size_t vertices = 0;
  bool moves = false;  ///< lives in the scene of moving objects
  Vec3f vertex(size_t index) const {
    return Vec3f(static_cast<const float*>(rtcGetGeometryBufferData(geometry, RTC_BUFFER_TYPE_VERTEX, 0)) +
                 3 * index);
  }
};

void check(RTCDevice device, const char* what) {
  const RTCError error = rtcGetDeviceError(device);
  if (error == RTC_ERROR_NONE) return;
  if (error == RTC_ERROR_OUT_OF_MEMORY) throw ResourceError(fmt::format("{}: out of memory", what));
  throw std::runtime_error(fmt::format("{}: Embree error {}", what, static_cast<int>(error)));
}

Plane plane_of(const Vec3f& a, const Vec3f& b, const Vec3f& c) {
  const Vec3 origin = a.cast<double>();
  const Vec3 normal = (b.cast<double>() - origin).cross(c.cast<double>() - origin);
  const double length = normal.norm();
  if (!(length > 0)) return {0, 0, 0, 0};
  const Vec3 n = normal / length;
  return {n.x(), n.y(), n.z(), n.dot(origin)};
}

// Vertices in the world, all primitives of the object one after another.
void place(const Mesh& mesh, const Eigen::Affine3d& T_world_object, TracedObject& object) {
  auto* vertex = static_cast<float*>(rtcGetGeometryBufferData(object.geometry, RTC_BUFFER_TYPE_VERTEX, 0));
  size_t triangle = 0;
  std::vector<Vec3f> positions_world;
  for (const Primitive& primitive : mesh.primitives) {
    positions_world.clear();
    for (const Vec3f& p : primitive.positions) {
      positions_world.push_back((T_world_object * p.cast<double>()).cast<float>());
      std::memcpy(vertex, positions_world.back().data(), 3 * sizeof(float));
      vertex += 3;
    }
    for (const auto& t : primitive.triangles)
      object.planes[triangle++] =
          plane_of(positions_world[t[0]], positions_world[t[1]], positions_world[t[2]]);
  }
}

/// Lowest and highest corner of where the vertices are.
std::pair<Vec3f, Vec3f> box_of(const TracedObject& object) {
  std::pair<Vec3f, Vec3f> box{object.vertex(0), object.vertex(0)};
  for (size_t i = 1; i < object.vertices; ++i)
    box = {box.first.cwiseMin(object.vertex(i)), box.second.cwiseMax(object.vertex(i))};
  return box;
}

TracedObject make_object(RTCDevice device, const Mesh& mesh, const Eigen::Affine3d& T_world_object) {
  TracedObject object;
  size_t triangles = 0;
  for (const Primitive& primitive : mesh.primitives) {
    object.vertices += primitive.positions.size();
    triangles += primitive.triangles.size();
    object.materials.resize(triangles, primitive.material);
  }
  object.planes.resize(triangles);
  object.geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  if (triangles == 0) return object;
  rtcSetNewGeometryBuffer(object.geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float),
                          object.vertices);
  auto* index = static_cast<uint32_t*>(rtcSetNewGeometryBuffer(
      object.geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(uint32_t), triangles));
  check(device, "placing a mesh");
  uint32_t first_vertex = 0;
  for (const Primitive& primitive : mesh.primitives) {
    for (const auto& t : primitive.triangles)
      for (uint32_t corner : t) *index++ = first_vertex + corner;
    first_vertex += static_cast<uint32_t>(primitive.positions.size());
  }
  place(mesh, T_world_object, object);
  return object;
}

RTCScene new_scene(RTCDevice device) {
  RTCScene scene = rtcNewScene(device);
  rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);  // without it rays leak between triangles
  rtcSetSceneBuildQuality(scene, RTC_BUILD_QUALITY_MEDIUM);
  return scene;
}

/// What Embree works on: halves of 8 rays, which AVX2 traverses at once (16 would be split and copied inside).
/// The fields that nobody sets are cleared once.
struct EmbreePacket {
  static constexpr int kHalves = 2, kLanes = 8;
  struct alignas(64) Half {
    RTCRayHit8 ray_hit;
    int valid[kLanes];
  } half[kHalves];

  EmbreePacket() {
    std::memset(half, 0, sizeof(half));
    for (Half& h : half)
      for (unsigned& mask : h.ray_hit.ray.mask) mask = ~0u;
  }
  void load(const RayPacket& rays) {
    for (int k = 0; k < kHalves; ++k) {
      const int first = k * kLanes;
      RTCRay8& ray = half[k].ray_hit.ray;
      std::memcpy(ray.org_x, rays.origin_x + first, sizeof(ray.org_x));
      std::memcpy(ray.org_y, rays.origin_y + first, sizeof(ray.org_y));
      std::memcpy(ray.org_z, rays.origin_z + first, sizeof(ray.org_z));
      std::memcpy(ray.dir_x, rays.direction_x + first, sizeof(ray.dir_x));
      std::memcpy(ray.dir_y, rays.direction_y + first, sizeof(ray.dir_y));
      std::memcpy(ray.dir_z, rays.direction_z + first, sizeof(ray.dir_z));
      std::memcpy(ray.tnear, rays.near_m + first, sizeof(ray.tnear));
      std::memcpy(ray.tfar, rays.far_m + first, sizeof(ray.tfar));
      for (int i = 0; i < kLanes; ++i) {
        half[k].ray_hit.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
        half[k].valid[i] = rays.near_m[first + i] <= rays.far_m[first + i] ? -1 : 0;
      }
    }
  }
  /// Both kinds of packet begin alike.
  template <class Hits>
  void store(Hits& hits) const {
    for (int k = 0; k < kHalves; ++k) {
      const int first = k * kLanes;
      const RTCRayHit8& found = half[k].ray_hit;
      std::memcpy(hits.range_m + first, found.ray.tfar, sizeof(found.ray.tfar));
      std::memcpy(hits.u + first, found.hit.u, sizeof(found.hit.u));
      std::memcpy(hits.v + first, found.hit.v, sizeof(found.hit.v));
      std::memcpy(hits.object + first, found.hit.geomID, sizeof(found.hit.geomID));
      std::memcpy(hits.triangle + first, found.hit.primID, sizeof(found.hit.primID));
    }
  }
};

}  // namespace

struct Raycaster::Impl {
  explicit Impl(const World& w) : world(w) {
    // Without `threads`: in Embree that is a limit for all users of TBB in the process.
    device = rtcNewDevice("isa=avx2,set_affinity=0");
    if (!device) throw std::runtime_error("Embree needs a CPU with AVX2");
    still = new_scene(device);
    moving = new_scene(device);
  }
  ~Impl() {
    for (TracedObject& object : objects) rtcReleaseGeometry(object.geometry);
    rtcReleaseScene(moving);
    rtcReleaseScene(still);
    rtcReleaseDevice(device);
  }

  const World& world;
  RTCDevice device = nullptr;
  RTCScene still = nullptr, moving = nullptr;  ///< moving: objects whose pose was changed at least once
  bool still_dirty = false, moving_dirty = false;
  std::vector<TracedObject> objects;
  std::vector<Moved> moved;  ///< what `moving` holds, in order of first change

  void intersect(EmbreePacket& packet, bool coherent) const {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
    for (EmbreePacket::Half& half : packet.half) {
      rtcIntersect8(half.valid, still, &context, &half.ray_hit);
      if (!moved.empty()) rtcIntersect8(half.valid, moving, &context, &half.ray_hit);
    }
  }

  /// Range and normal from the plane of the triangle that was hit.
  void refine(const RayPacket& rays, HitPacket& hits) const {
    alignas(64) double nx[16], ny[16], nz[16], offset[16];
    uint32_t last_object = HitPacket::kNoHit, last_triangle = 0;
    Plane plane{0, 0, 0, 0};
    int material = 0;
    for (int i = 0; i < 16; ++i) {  // neighbours mostly hit the same triangle
      const uint32_t id = hits.object[i], triangle = hits.triangle[i];
      if (id != HitPacket::kNoHit && (id != last_object || triangle != last_triangle)) {
        plane = objects[id].planes[triangle];
        material = objects[id].materials[triangle];
        last_object = id, last_triangle = triangle;
      }
      nx[i] = plane.nx, ny[i] = plane.ny, nz[i] = plane.nz, offset[i] = plane.offset;
      hits.material[i] = material;
    }
    float* const range_m = hits.range_m;
    float* const normal_x = hits.normal_x;
    float* const normal_y = hits.normal_y;
    float* const normal_z = hits.normal_z;
#pragma GCC ivdep
    for (int i = 0; i < 16; ++i) {
      const double along =
          nx[i] * rays.direction_x[i] + ny[i] * rays.direction_y[i] + nz[i] * rays.direction_z[i];
      const double height = nx[i] * rays.origin_x[i] + ny[i] * rays.origin_y[i] + nz[i] * rays.origin_z[i];
      const auto range = static_cast<float>((offset[i] - height) / along);
      // A ray within the plane has no better answer than Embree's.
      const float found = range_m[i], difference = std::abs(range - found);
      range_m[i] = difference < 1e-3f * (1.0f + found) ? range : found;
      const double side = along > 0 ? -1.0 : 1.0;
      normal_x[i] = static_cast<float>(side * nx[i]);
      normal_y[i] = static_cast<float>(side * ny[i]);
      normal_z[i] = static_cast<float>(side * nz[i]);
    }
  }
};

Raycaster::Raycaster(const World& world) : impl_(std::make_unique<Impl>(world)) {
  Impl& impl = *impl_;
  for (size_t i = 0; i < world.objects.size(); ++i) {
    const Object& object = world.objects[i];
    impl.objects.push_back(
        make_object(impl.device, world.meshes.at(static_cast<size_t>(object.mesh)), object.T_world_object));
    TracedObject& traced = impl.objects.back();
    if (traced.planes.empty()) continue;
    rtcCommitGeometry(traced.geometry);
    rtcAttachGeometryByID(impl.still, traced.geometry, static_cast<unsigned>(i));
  }
  rtcCommitScene(impl.still);
  rtcCommitScene(impl.moving);
  check(impl.device, "building the acceleration structure");
}

Raycaster::~Raycaster() = default;

const std::vector<Raycaster::Moved>& Raycaster::moved() const {
  return impl_->moved;
}

const World& Raycaster::world() const {
  return impl_->world;
}

void Raycaster::trace(std::span<const RayPacket> rays, std::span<HitPacket> hits, bool coherent) const {
  EmbreePacket packet;
  for (size_t i = 0; i < rays.size(); ++i) {
    packet.load(rays[i]);
    impl_->intersect(packet, coherent);
    packet.store(hits[i]);
    impl_->refine(rays[i], hits[i]);
  }
}

void Raycaster::trace(std::span<const RayPacket> rays, std::span<SurfacePacket> surfaces,
                      bool coherent) const {
  EmbreePacket packet;
  for (size_t i = 0; i < rays.size(); ++i) {
    packet.load(rays[i]);
    impl_->intersect(packet, coherent);
    packet.store(surfaces[i]);
  }
}

uint32_t Raycaster::occluded(const RayPacket& rays) const {
  EmbreePacket packet;
  packet.load(rays);
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  uint32_t bits = 0;
  for (int k = 0; k < EmbreePacket::kHalves; ++k) {
    EmbreePacket::Half& half = packet.half[k];
    rtcOccluded8(half.valid, impl_->still, &context, &half.ray_hit.ray);
    if (!impl_->moved.empty()) rtcOccluded8(half.valid, impl_->moving, &context, &half.ray_hit.ray);
    for (int i = 0; i < EmbreePacket::kLanes; ++i)  // Embree's sign: -infinity
      if (half.valid[i] && half.ray_hit.ray.tfar[i] < 0) bits |= 1u << (k * EmbreePacket::kLanes + i);
  }
  return bits;
}

bool Raycaster::trace_one(const Vec3& origin_world, const Vec3& direction_world, double max_range_m,
                          Hit& hit) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  alignas(16) RTCRayHit ray = {};
  const Vec3f origin = origin_world.cast<float>(), direction = direction_world.cast<float>();
  ray.ray.org_x = origin.x(), ray.ray.org_y = origin.y(), ray.ray.org_z = origin.z();
  ray.ray.dir_x = direction.x(), ray.ray.dir_y = direction.y(), ray.ray.dir_z = direction.z();
  ray.ray.tfar = static_cast<float>(max_range_m);
  ray.ray.mask = ~0u;
  ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect1(impl_->still, &context, &ray);
  if (!impl_->moved.empty()) rtcIntersect1(impl_->moving, &context, &ray);
  if (ray.hit.geomID == RTC_INVALID_GEOMETRY_ID) return false;

  const Plane& plane = impl_->objects[ray.hit.geomID].planes[ray.hit.primID];
  const Vec3 normal(plane.nx, plane.ny, plane.nz);
  const double along = normal.dot(direction_world);
  const double range = (plane.offset - normal.dot(origin_world)) / along;
  const bool better = std::abs(range - ray.ray.tfar) < 1e-3 * (1.0 + ray.ray.tfar);
  hit.range_m = better ? range : ray.ray.tfar;
  hit.object = ray.hit.geomID;
  hit.triangle = ray.hit.primID;
  hit.normal_world = along > 0 ? Vec3(-normal) : normal;
  hit.material = material(hit.object, hit.triangle);
  return true;
}

int Raycaster::material(uint32_t object, uint32_t triangle) const {
  return impl_->objects[object].materials[triangle];
}

void Raycaster::set_object_pose(int object, const Eigen::Affine3d& T_world_object, bool present) {
  Impl& impl = *impl_;
  const auto id = static_cast<unsigned>(object);
  TracedObject& traced = impl.objects.at(id);
  if (traced.planes.empty()) return;
  if (!traced.moves) {
    rtcDetachGeometry(impl.still, id);
    rtcAttachGeometryByID(impl.moving, traced.geometry, id);
    impl.still_dirty = true;
    traced.moves = true;
    impl.moved.push_back({.object = id});
  }
  place(impl.world.meshes[static_cast<size_t>(impl.world.objects[id].mesh)], T_world_object, traced);
  rtcUpdateGeometryBuffer(traced.geometry, RTC_BUFFER_TYPE_VERTEX, 0);
  Moved& moved =
      *std::find_if(impl.moved.begin(), impl.moved.end(), [=](const Moved& m) { return m.object == id; });
  moved.present = present;
  std::tie(moved.low_world, moved.high_world) = box_of(traced);
  if (present) rtcEnableGeometry(traced.geometry);
  if (!present) rtcDisableGeometry(traced.geometry);
  rtcCommitGeometry(traced.geometry);
  impl.moving_dirty = true;
}

void Raycaster::commit() {
  if (impl_->still_dirty) rtcCommitScene(impl_->still);
  if (impl_->moving_dirty) rtcCommitScene(impl_->moving);
  impl_->still_dirty = impl_->moving_dirty = false;
  check(impl_->device, "moving an object");
}

}  // namespace vsslam

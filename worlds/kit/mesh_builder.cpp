#include "worlds/kit/mesh_builder.h"

#include <bit>
#include <cmath>
#include <numbers>

#include "core/rng.h"

namespace vsslam {

size_t MeshBuilder::Hash::operator()(const Key& key) const {
  uint64_t h = 0x9E3779B97F4A7C15ull;
  for (const uint32_t word : key) h = (h ^ word) * 0xBF58476D1CE4E5B9ull, h ^= h >> 29;
  return h;
}

uint32_t MeshBuilder::weld(Part& part, const Vertex& v) {
  Key key;
  for (int i = 0; i < 3; ++i) key[static_cast<size_t>(i)] = std::bit_cast<uint32_t>(v.position[i] + 0.0f);
  for (int i = 0; i < 3; ++i) key[static_cast<size_t>(3 + i)] = std::bit_cast<uint32_t>(v.normal[i] + 0.0f);
  for (int i = 0; i < 2; ++i) key[static_cast<size_t>(6 + i)] = std::bit_cast<uint32_t>(v.uv[i] + 0.0f);
  Primitive& p = part.primitive;
  const auto [it, added] = part.welded.emplace(key, static_cast<uint32_t>(p.positions.size()));
  if (added) {
    p.positions.push_back(v.position);
    p.normals.push_back(v.normal);
    p.uvs.push_back(v.uv);
  }
  return it->second;
}

void MeshBuilder::triangle(int material, const Vertex& a, const Vertex& b, const Vertex& c) {
  Part& part = parts_[material];
  part.primitive.material = material;
  const uint32_t ia = weld(part, a), ib = weld(part, b), ic = weld(part, c);
  if (ia != ib && ib != ic && ic != ia) part.primitive.triangles.push_back({ia, ib, ic});
}

void MeshBuilder::quad(int material, const Vertex& a, const Vertex& b, const Vertex& c, const Vertex& d) {
  triangle(material, a, b, c);
  triangle(material, a, c, d);
}

void MeshBuilder::face(int material, const std::array<Vec3, 4>& corners, const Vec3& normal,
                       double uv_per_m) {
  const bool level = std::abs(normal.z()) > 0.5;
  const Vec3 right = level ? Vec3(Vec3::UnitX()) : Vec3(Vec3::UnitZ().cross(normal));
  const Vec3 down = level ? Vec3(-Vec3::UnitY()) : Vec3(-Vec3::UnitZ());
  std::array<Vertex, 4> v;
  for (size_t i = 0; i < 4; ++i) {
    const Eigen::Vector2d uv(corners[i].dot(right) * uv_per_m, corners[i].dot(down) * uv_per_m);
    v[i] = {corners[i].cast<float>(), normal.cast<float>(), uv.cast<float>()};
  }
  quad(material, v[0], v[1], v[2], v[3]);
}

void MeshBuilder::box(int material, const Vec3& foot_m, const Vec3& size_m, double uv_per_m) {
  const Vec3 low = foot_m - Vec3(size_m.x() / 2, size_m.y() / 2, 0), high = low + size_m;
  const auto corner = [&](int x, int y, int z) {
    return Vec3(x ? high.x() : low.x(), y ? high.y() : low.y(), z ? high.z() : low.z());
  };
  using Corners = std::array<Vec3, 4>;
  const auto add = [&](const Corners& c, const Vec3& n) { face(material, c, n, uv_per_m); };
  add(Corners{corner(1, 0, 0), corner(1, 1, 0), corner(1, 1, 1), corner(1, 0, 1)}, Vec3::UnitX());
  add(Corners{corner(0, 1, 0), corner(0, 0, 0), corner(0, 0, 1), corner(0, 1, 1)}, -Vec3::UnitX());
  add(Corners{corner(1, 1, 0), corner(0, 1, 0), corner(0, 1, 1), corner(1, 1, 1)}, Vec3::UnitY());
  add(Corners{corner(0, 0, 0), corner(1, 0, 0), corner(1, 0, 1), corner(0, 0, 1)}, -Vec3::UnitY());
  add(Corners{corner(0, 0, 1), corner(1, 0, 1), corner(1, 1, 1), corner(0, 1, 1)}, Vec3::UnitZ());
  add(Corners{corner(0, 1, 0), corner(1, 1, 0), corner(1, 0, 0), corner(0, 0, 0)}, -Vec3::UnitZ());
}

void MeshBuilder::cylinder(int material, const Vec3& foot_m, double radius_m, double top_radius_m,
                           double height_m, int sides, double uv_per_m) {
  const double step_rad = 2 * std::numbers::pi / sides;
  const double lean = (radius_m - top_radius_m) / height_m;
  const auto spoke = [&](int i) { return Vec3(std::cos(i * step_rad), std::sin(i * step_rad), 0); };
  const auto vertex = [&](const Vec3& p, const Vec3& n, double u, double v) {
    return Vertex{p.cast<float>(), n.cast<float>(), Eigen::Vector2d(u, v).cast<float>()};
  };
  const Vec3 top_m = foot_m + Vec3(0, 0, height_m);
  const auto cap = [&](const Vec3& centre, double r, int i, int j, const Vec3& n) {
    const auto rim = [&](int k) {
      return vertex(centre + r * spoke(k % sides), n, r * spoke(k % sides).x() * uv_per_m,
                    -r * spoke(k % sides).y() * uv_per_m);
    };
    triangle(material, vertex(centre, n, 0, 0), rim(i), rim(j));
  };
  for (int i = 0; i < sides; ++i) {
    const Vec3 a = spoke(i), b = spoke((i + 1) % sides);
    const Vec3 na = Vec3(a.x(), a.y(), lean).normalized(), nb = Vec3(b.x(), b.y(), lean).normalized();
    const double ua = i * step_rad * radius_m * uv_per_m, ub = (i + 1) * step_rad * radius_m * uv_per_m;
    quad(material, vertex(foot_m + radius_m * a, na, ua, 0), vertex(foot_m + radius_m * b, nb, ub, 0),
         vertex(top_m + top_radius_m * b, nb, ub, -height_m * uv_per_m),
         vertex(top_m + top_radius_m * a, na, ua, -height_m * uv_per_m));
    cap(top_m, top_radius_m, i, i + 1, Vec3::UnitZ());
    cap(foot_m, radius_m, i + 1, i, -Vec3::UnitZ());
  }
}

void MeshBuilder::limb(int material, const Vec3& from_m, const Vec3& to_m, double radius_m,
                       double end_radius_m, int sides, bool closed, double uv_per_m) {
  const Vec3 axis = (to_m - from_m).normalized();
  const Vec3 right = (std::abs(axis.z()) < 0.9 ? Vec3::UnitZ() : Vec3::UnitX()).cross(axis).normalized();
  const Vec3 up = axis.cross(right);
  const double length_m = (to_m - from_m).norm();
  const auto spoke = [&](int i) {
    const double angle = 2 * std::numbers::pi * (i % sides) / sides;
    return Vec3(std::cos(angle) * right + std::sin(angle) * up);
  };
  const auto vertex = [&](const Vec3& p, const Vec3& n, double u, double v) {
    return Vertex{p.cast<float>(), n.cast<float>(), Eigen::Vector2d(u, v).cast<float>() * uv_per_m};
  };
  const auto cap = [&](const Vec3& centre, double r, int i, int j, const Vec3& n) {
    triangle(material, vertex(centre, n, 0, 0), vertex(centre + r * spoke(i), n, r, 0),
             vertex(centre + r * spoke(j), n, 0, r));
  };
  for (int i = 0; i < sides; ++i) {
    const Vec3 a = spoke(i), b = spoke(i + 1);
    const double ua = 2 * std::numbers::pi * radius_m * i / sides,
                 ub = 2 * std::numbers::pi * radius_m * (i + 1) / sides;
    quad(material, vertex(from_m + radius_m * a, a, ua, 0), vertex(from_m + radius_m * b, b, ub, 0),
         vertex(to_m + end_radius_m * b, b, ub, -length_m),
         vertex(to_m + end_radius_m * a, a, ua, -length_m));
    if (!closed) continue;
    cap(to_m, end_radius_m, i, i + 1, axis);
    cap(from_m, radius_m, i + 1, i, -axis);
  }
}

void MeshBuilder::ball(int material, const Vec3& centre_m, double radius_m, int rings, double lumps,
                       uint64_t seed) {
  const RandomStream stream(seed, "ball");
  const int sectors = 2 * rings;
  const auto vertex = [&](int ring, int sector) {
    const double polar = std::numbers::pi * ring / rings, azimuth = 2 * std::numbers::pi * sector / sectors;
    const Vec3 n(std::sin(polar) * std::cos(azimuth), std::sin(polar) * std::sin(azimuth), std::cos(polar));
    const bool pole = ring == 0 || ring == rings;
    const auto index = static_cast<uint64_t>(pole ? ring * sectors : ring * sectors + sector % sectors);
    const double r = radius_m * (1 + lumps * (2 * stream.uniform(index) - 1));
    return Vertex{(centre_m + r * n).cast<float>(), n.cast<float>(),
                  Vec2f(static_cast<float>(sector) / static_cast<float>(rings),
                        static_cast<float>(ring) / static_cast<float>(rings))};
  };
  for (int ring = 0; ring < rings; ++ring)
    for (int s = 0; s < sectors; ++s) {
      if (ring + 1 < rings) triangle(material, vertex(ring, s), vertex(ring + 1, s), vertex(ring + 1, s + 1));
      if (ring > 0) triangle(material, vertex(ring, s), vertex(ring + 1, s + 1), vertex(ring, s + 1));
    }
}

Mesh MeshBuilder::finish(std::string name) {
  Mesh mesh{.name = std::move(name), .primitives = {}};
  for (auto& [material, part] : parts_)
    if (!part.primitive.triangles.empty()) mesh.primitives.push_back(std::move(part.primitive));
  parts_.clear();
  return mesh;
}

}  // namespace vsslam

#include "worlds/outdoor/street_furniture.h"

#include <array>
#include <cmath>
#include <numbers>

namespace vsslam {

Mesh make_street_lamp(const OutdoorPalette& p) {
  MeshBuilder b;
  b.cylinder(p.dark_steel, {0, 0, 0}, 0.11, 0.1, 0.9, 12);
  b.cylinder(p.dark_steel, {0, 0, 0.9}, 0.065, 0.045, kLampHead_m - 0.7, 10);
  b.limb(p.dark_steel, {0, 0, kLampHead_m + 0.15}, {kLampReach_m - 0.3, 0, kLampHead_m + 0.1}, 0.035, 0.03, 8,
         true);
  b.box(p.dark_steel, {kLampReach_m, 0, kLampHead_m + 0.005}, {0.6, 0.34, 0.12});
  const double x = kLampReach_m, z = kLampHead_m;
  b.face(p.lamp,
         {Vec3(x - 0.2, -0.15, z), Vec3(x - 0.2, 0.15, z), Vec3(x + 0.2, 0.15, z), Vec3(x + 0.2, -0.15, z)},
         -Vec3::UnitZ());
  return b.finish("street_lamp");
}

Mesh make_sign_pole(const OutdoorPalette& p) {
  MeshBuilder b;
  b.cylinder(p.steel, {0, 0, 0}, 0.035, 0.035, 2.7, 10);
  b.box(p.sign, {0.045, 0, 2.05}, {0.02, 0.5, 0.5});
  b.box(p.marking, {0.057, 0, 2.12}, {0.004, 0.12, 0.36});
  return b.finish("sign_pole");
}

Mesh make_street_bench(const OutdoorPalette& p) {
  MeshBuilder b;
  for (const double y : {-0.7, 0.7}) {
    b.box(p.stone.material, {0, y, 0}, {0.45, 0.12, 0.4});
    b.box(p.dark_steel, {-0.22, y, 0.4}, {0.04, 0.05, 0.45});
  }
  for (int i = 0; i < 4; ++i) b.box(p.wood, {-0.18 + 0.12 * i, 0, 0.4}, {0.1, 1.8, 0.04});
  for (int i = 0; i < 3; ++i) b.box(p.wood, {-0.185, 0, 0.52 + 0.13 * i}, {0.03, 1.8, 0.1});
  return b.finish("bench");
}

Mesh make_bin(const OutdoorPalette& p) {
  MeshBuilder b;
  b.cylinder(p.dark_steel, {0, 0, 0.05}, 0.22, 0.24, 0.8, 16);
  b.cylinder(p.steel, {0, 0, 0.85}, 0.25, 0.2, 0.08, 16);
  return b.finish("bin");
}

Mesh make_bollard(const OutdoorPalette& p) {
  MeshBuilder b;
  b.cylinder(p.stone.material, {0, 0, 0}, 0.12, 0.1, 0.75, 12);
  b.cylinder(p.dark_steel, {0, 0, 0.75}, 0.11, 0.05, 0.1, 12);
  return b.finish("bollard");
}

Mesh make_advert_column(const OutdoorPalette& p) {
  constexpr double kRadius_m = 0.65, kBottom_m = 0.5, kTop_m = 2.5;
  constexpr int kSides = 32, kPosters = 8;
  MeshBuilder b;
  b.cylinder(p.stone.material, {0, 0, 0}, 0.7, 0.7, kBottom_m, kSides);
  b.cylinder(p.stone.material, {0, 0, kTop_m}, 0.75, 0.75, 0.12, kSides);
  b.cylinder(p.dark_steel, {0, 0, kTop_m + 0.12}, 0.72, 0.1, 0.5, kSides);
  for (int i = 0; i < kSides; ++i) {
    const auto vertex = [&](int k, double z, double u, double v) {
      const double angle = 2 * std::numbers::pi * (k % kSides) / kSides;
      const Vec3 n(std::cos(angle), std::sin(angle), 0);
      return Vertex{(kRadius_m * n + Vec3(0, 0, z)).cast<float>(), n.cast<float>(),
                    Eigen::Vector2d(u, v).cast<float>()};
    };
    const int each = kSides / kPosters, slice = i % each;
    const double u0 = static_cast<double>(slice) / each, u1 = static_cast<double>(slice + 1) / each;
    const int poster = p.posters[static_cast<size_t>(i / each) % p.posters.size()];
    b.quad(poster, vertex(i, kBottom_m, u0, 1), vertex(i + 1, kBottom_m, u1, 1), vertex(i + 1, kTop_m, u1, 0),
           vertex(i, kTop_m, u0, 0));
  }
  return b.finish("advert_column");
}

Mesh make_planter(const OutdoorPalette& p) {
  MeshBuilder b;
  b.box(p.stone.material, Vec3::Zero(), {1.2, 1.2, 0.55});
  b.ball(p.hedge, {0, 0, 0.95}, 0.5, 8, 0.3, 5);
  b.ball(p.hedge, {0.2, -0.15, 0.8}, 0.4, 7, 0.35, 6);
  return b.finish("planter");
}

Mesh make_fence(const OutdoorPalette& p) {
  constexpr double kLength_m = 2.5, kHeight_m = 1.6, kBars_m = 0.16;
  MeshBuilder b;
  b.box(p.dark_steel, {0, -kLength_m / 2 + 0.04, 0}, {0.08, 0.08, kHeight_m + 0.1});
  b.box(p.dark_steel, {0, kLength_m / 2 - 0.04, 0}, {0.08, 0.08, kHeight_m + 0.1});
  for (const double z : {0.15, 0.8, kHeight_m - 0.12})
    b.box(p.dark_steel, {0, 0, z}, {0.03, kLength_m - 0.16, 0.04});
  for (double y = -kLength_m / 2 + 0.2; y < kLength_m / 2 - 0.1; y += kBars_m)
    b.limb(p.dark_steel, {0, y, 0.1}, {0, y, kHeight_m}, 0.011, 0.011, 3, false);
  return b.finish("fence");
}

Mesh make_flagpole(const OutdoorPalette& p) {
  MeshBuilder b;
  b.box(p.stone.material, Vec3::Zero(), {0.8, 0.8, 0.3});
  b.cylinder(p.steel, {0, 0, 0.3}, 0.08, 0.04, 9, 12);
  b.box(p.posters.front(), {0, 0.85, 7.6}, {0.02, 1.6, 1.1}, 0.6);
  return b.finish("flagpole");
}

Mesh make_monument(const OutdoorPalette& p) {
  MeshBuilder b;
  b.box(p.kerb.material, Vec3::Zero(), {3, 3, 0.2});
  b.box(p.stone.material, {0, 0, 0.2}, {2.2, 2.2, 0.25});
  b.box(p.stone.material, {0, 0, 0.45}, {1.3, 1.3, 1.3});
  b.box(p.sign, {0.655, 0, 0.9}, {0.01, 0.8, 0.4});
  b.ball(p.stone.material, {0, 0, 2.6}, 0.85, 10, 0.18, 11);
  return b.finish("monument");
}

}  // namespace vsslam

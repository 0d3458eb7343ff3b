#include "worlds/outdoor/gate_structure.h"

#include <cmath>

namespace vsslam {

namespace {

void add_pillar(MeshBuilder& b, const OutdoorPalette& p, double x_m, double side_m, double height_m) {
  const double uv = 1 / p.facades.back().width_m;
  b.box(p.stone.material, {x_m, 0, 0}, {side_m + 0.3, side_m + 0.3, 0.5});
  b.box(p.facades.back().material, {x_m, 0, 0.5}, {side_m, side_m, height_m - 0.5}, uv);
  b.box(p.stone.material, {x_m, 0, height_m}, {side_m + 0.25, side_m + 0.25, 0.2});
}

// On an island, with a window to each side.
void add_booth(MeshBuilder& b, const OutdoorPalette& p) {
  constexpr double kWidth_m = 2.0, kDepth_m = 3.0, kHeight_m = 2.6;
  b.box(p.kerb.material, Vec3::Zero(), {kWidth_m + 0.6, kDepth_m + 2.6, 0.15});
  b.box(p.facades.front().material, {0, 0, 0.15}, {kWidth_m, kDepth_m, kHeight_m},
        1 / p.facades.front().width_m);
  b.box(p.dark_steel, {0, 0, kHeight_m + 0.15}, {kWidth_m + 0.7, kDepth_m + 0.7, 0.15});
  for (const double side : {-1.0, 1.0}) {
    b.box(p.windows.front(), {side * kWidth_m / 2, 0, 1.1}, {0.04, 1.8, 1.1}, 0.7);
    b.box(p.lit_window, {0, side * kDepth_m / 2, 1.1}, {1.3, 0.04, 1.1}, 0.7);
  }
}

void add_barrier(MeshBuilder& b, const OutdoorPalette& p, double x_m, double side) {
  const Vec3 hinge(x_m, -1.9, 1.0), tip = hinge + 4.2 * Vec3(-side * std::cos(1.35), 0, std::sin(1.35));
  b.box(p.sign, {x_m, -1.9, 0}, {0.35, 0.35, 1.1});
  b.limb(p.marking, hinge, tip, 0.05, 0.04, 8, true);
}

}  // namespace

Mesh make_gate_structure(const OutdoorPalette& p) {
  constexpr double kBeam_m = 5.2;
  MeshBuilder b;
  for (const double side : {-1.0, 1.0}) {
    add_pillar(b, p, side * kGateHalfWidth_m, 1.4, kBeam_m);
    add_pillar(b, p, side * (kGateHalfWidth_m + 3.2), 0.7, 2.8);
    add_barrier(b, p, side * (kGateHalfWidth_m - 1.2), side);
  }
  const Finish& concrete = p.facades.back();
  b.box(concrete.material, {0, 0, kBeam_m + 0.2}, {2 * kGateHalfWidth_m + 3, 1.8, 0.9}, 1 / concrete.width_m);
  b.box(p.roof.material, {0, 0, kBeam_m + 1.1}, {2 * kGateHalfWidth_m + 3.6, 2.6, 0.2});
  for (int i = 0; i < 6; ++i)  // letters, as far as a camera can tell
    b.box(p.posters[static_cast<size_t>(i) % p.posters.size()], {-6.0 + 2.4 * i, -0.93, kBeam_m + 0.35},
          {1.1, 0.06, 0.65}, 1.2);
  add_booth(b, p);
  return b.finish("gate");
}

}  // namespace vsslam

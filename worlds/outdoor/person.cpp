#include "worlds/outdoor/street_furniture.h"

namespace vsslam {

// Legs, trunk, arms and head of somebody 1.62 to 1.8 m tall.
Mesh make_person(const OutdoorPalette& p, int variant) {
  const auto cloth = [&](int shift) {
    return p.clothes[static_cast<size_t>(variant + shift) % p.clothes.size()];
  };
  const int coat = cloth(0), trousers = cloth(variant % 3 + 1);
  const double s = 0.92 + 0.025 * (variant % 5), stride_m = 0.04 * (variant % 4);
  MeshBuilder b;
  for (const double side : {-1.0, 1.0}) {
    const Vec3 foot(side * stride_m, side * 0.1, 0.06),
        knee(side * stride_m * 0.6 + 0.02, side * 0.1, 0.48 * s), hip(0, side * 0.09, 0.9 * s),
        shoulder(0, side * 0.2, 1.42 * s), elbow(0.02 - side * stride_m, side * 0.29, 1.14 * s),
        hand(0.1 + side * stride_m, side * 0.27, 0.88 * s);
    b.box(p.hair, {foot.x() + 0.05, foot.y(), 0}, {0.27, 0.1, 0.08});
    b.limb(trousers, foot, knee, 0.055, 0.065, 7, false);
    b.limb(trousers, knee, hip, 0.065, 0.095, 7, false);
    b.limb(coat, shoulder, elbow, 0.06, 0.05, 6, false);
    b.limb(coat, elbow, hand, 0.05, 0.035, 6, false);
    b.ball(p.skin, hand, 0.05, 3, 0.1, 1);
    b.ball(coat, shoulder, 0.075, 4, 0, 1);
    b.limb(coat, {0, side * 0.07, 0.84 * s}, {0.01, side * 0.075, 1.18 * s}, 0.13, 0.115, 8, true);
    b.limb(coat, {0.01, side * 0.075, 1.18 * s}, {0, side * 0.09, 1.46 * s}, 0.115, 0.1, 8, true);
  }
  b.limb(p.skin, {0, 0, 1.44 * s}, {0.02, 0, 1.56 * s}, 0.055, 0.05, 6, false);
  b.ball(p.skin, {0.03, 0, 1.65 * s}, 0.105, 6, 0.03, 2);
  b.ball(p.hair, {0.0, 0, 1.69 * s}, 0.105, 6, 0.05, 3);
  return b.finish("person");
}

}  // namespace vsslam

// Things that stand about indoors. Meshes have their foot at the origin, their back towards -x.
#pragma once

#include <string>
#include <vector>

#include "worlds/kit/indoor_palette.h"
#include "worlds/world.h"

namespace vsslam {

enum class FurnitureKind { box, boxes, bench, plant, cupboard, table, bin, round_pillar };
inline constexpr int kFurnitureKinds = 8;

/// Footprint: x is the depth from the wall, y the width along it, z the height.
Vec3 furniture_size_m(FurnitureKind kind);
Mesh make_furniture(FurnitureKind kind, const IndoorPalette& palette, double ceiling_m);

/// Adds furniture to a world, one shared mesh per kind, each piece an object of its own ("bench_1").
class Furnisher {
 public:
  /// Round pillars reach up to `ceiling_m`.
  Furnisher(World& world, const IndoorPalette& palette, double ceiling_m)
      : world_(world), palette_(palette), ceiling_m_(ceiling_m) {}

  /// Places a piece; its front faces `heading_rad`.
  void place(FurnitureKind kind, const Vec3& foot_world, double heading_rad);

 private:
  World& world_;
  const IndoorPalette& palette_;
  double ceiling_m_;
  std::vector<int> mesh_of_kind_ = std::vector<int>(kFurnitureKinds, -1);
  std::vector<int> pieces_ = std::vector<int>(kFurnitureKinds, 0);
};

}  // namespace vsslam

// Places trees, lamps, cars and people in an outdoor world: one shared mesh per kind and variant, each piece an
// object of its own ("car_7"); lamps bring their light.
#pragma once

#include <array>
#include <map>
#include <vector>

#include "worlds/kit/outdoor_palette.h"
#include "worlds/kit/route_clearance.h"
#include "worlds/world.h"

namespace vsslam {

enum class Outfit {
  street_lamp,
  sign_pole,
  bench,
  bin,
  bollard,
  advert_column,
  planter,
  fence,
  hedge,
  flagpole,
  monument,
  car,
  person,
  tree
};
inline constexpr int kOutfits = 14;

class Outfitter {
 public:
  /// Trees have `leaf_clusters` on average. Pieces keep `clearance_m` from the world's routes.
  Outfitter(World& world, const OutdoorPalette& palette, int leaf_clusters, double clearance_m,
            uint64_t seed);

  /// Places a piece that faces `heading_rad`, unless it would be in the way of a route or of another piece.
  bool place(Outfit outfit, const Vec3& foot_world, double heading_rad = 0, int variant = 0);
  /// A row of pieces that are `length_m` long across their heading, from a to b.
  void line(Outfit outfit, const Vec3& a_world, const Vec3& b_world, double length_m);
  /// Nothing that is placed later may lie here.
  void reserve(const Rect& rect) { taken_.push_back(rect); }

  static constexpr int kTrees = 6, kCars = 8, kPeople = 10;  ///< variants of which there are most

 private:
  int mesh_of(Outfit outfit, int variant, int part);
  Mesh make(Outfit outfit, int variant, int part) const;
  void add_object(Outfit outfit, int variant, int part, const Eigen::Affine3d& T_world_object);

  World& world_;
  const OutdoorPalette& palette_;
  int leaf_clusters_;
  double clearance_m_;
  uint64_t seed_;
  RouteClearance routes_;
  std::vector<Rect> taken_;
  std::map<std::array<int, 3>, int> mesh_of_;
  std::vector<int> pieces_;
};

}  // namespace vsslam

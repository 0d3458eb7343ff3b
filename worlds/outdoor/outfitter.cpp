#include "worlds/outdoor/outfitter.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "core/rng.h"
#include "worlds/outdoor/street_furniture.h"
#include "worlds/outdoor/tree.h"

namespace vsslam {

namespace {

struct Kind {
  const char* name;
  double depth_m, width_m;  ///< of its footprint, along and across its heading
};
constexpr std::array<Kind, kOutfits> kKinds = {{{"street_lamp", 0.3, 0.3},
                                                {"sign_pole", 0.2, 0.5},
                                                {"bench", 0.6, 1.8},
                                                {"bin", 0.5, 0.5},
                                                {"bollard", 0.25, 0.25},
                                                {"advert_column", 1.5, 1.5},
                                                {"planter", 1.2, 1.2},
                                                {"fence", 0.1, 2.5},
                                                {"hedge", 0.7, 2.0},
                                                {"flagpole", 0.8, 0.8},
                                                {"monument", 3.0, 3.0},
                                                {"car", kCarLength_m, kCarWidth_m + 0.3},
                                                {"person", 0.5, 0.6},
                                                {"tree", 0.5, 0.5}}};
const Kind& kind(Outfit outfit) {
  return kKinds[static_cast<size_t>(outfit)];
}

Tree tree_of(int variant, int leaf_clusters, uint64_t seed) {
  const RandomStream draws(seed, "tree");
  const auto draw = [&](uint64_t item) { return draws.uniform(static_cast<uint64_t>(variant), item); };
  Tree tree{.foliage = variant, .look = draws.bits(static_cast<uint64_t>(variant), 9)};
  tree.crown_radius_m = 1.7 + 1.1 * draw(0);
  tree.height_m = 2.3 + 2.45 * tree.crown_radius_m + 0.6 * draw(1);
  tree.trunk_radius_m = 0.09 + 0.08 * draw(2);
  // As dense for all sizes: as many for each square metre of the crown's outline.
  tree.leaf_clusters = static_cast<int>(leaf_clusters * std::pow(tree.crown_radius_m / 2.25, 2));
  return tree;
}

}  // namespace

Outfitter::Outfitter(World& world, const OutdoorPalette& palette, int leaf_clusters, double clearance_m,
                     uint64_t seed)
    : world_(world),
      palette_(palette),
      leaf_clusters_(leaf_clusters),
      clearance_m_(clearance_m),
      seed_(seed),
      routes_(world.routes),
      pieces_(kOutfits) {}

Mesh Outfitter::make(Outfit outfit, int variant, int part) const {
  switch (outfit) {
    case Outfit::street_lamp:
      return make_street_lamp(palette_);
    case Outfit::sign_pole:
      return make_sign_pole(palette_);
    case Outfit::bench:
      return make_street_bench(palette_);
    case Outfit::bin:
      return make_bin(palette_);
    case Outfit::bollard:
      return make_bollard(palette_);
    case Outfit::advert_column:
      return make_advert_column(palette_);
    case Outfit::planter:
      return make_planter(palette_);
    case Outfit::fence:
      return make_fence(palette_);
    case Outfit::hedge:
      return make_hedge(palette_, seed_ + static_cast<uint64_t>(variant));
    case Outfit::flagpole:
      return make_flagpole(palette_);
    case Outfit::monument:
      return make_monument(palette_);
    case Outfit::car:
      return make_car(palette_, variant);
    case Outfit::person:
      return make_person(palette_, variant);
    case Outfit::tree:
      break;
  }
  const Tree tree = tree_of(variant, leaf_clusters_, seed_);
  return part == 0 ? make_wood(palette_, tree) : make_foliage(palette_, tree);
}

int Outfitter::mesh_of(Outfit outfit, int variant, int part) {
  const auto [it, added] = mesh_of_.emplace(std::array{static_cast<int>(outfit), variant, part},
                                            static_cast<int>(world_.meshes.size()));
  if (added) world_.meshes.push_back(make(outfit, variant, part));
  return it->second;
}

void Outfitter::add_object(Outfit outfit, int variant, int part, const Eigen::Affine3d& T_world_object) {
  const int mesh = mesh_of(outfit, variant, part);
  world_.objects.push_back({.name = kind(outfit).name + std::string(part == 0 ? "_" : "_foliage_") +
                                    std::to_string(pieces_[static_cast<size_t>(outfit)]),
                            .mesh = mesh,
                            .T_world_object = T_world_object,
                            .collision = part == 0 ? Collision::mesh : Collision::none});
}

bool Outfitter::place(Outfit outfit, const Vec3& foot_world, double heading_rad, int variant) {
  const Kind& k = kind(outfit);
  const double c = std::abs(std::cos(heading_rad)), s = std::abs(std::sin(heading_rad));
  const double half_x = 0.5 * (c * k.depth_m + s * k.width_m), half_y = 0.5 * (s * k.depth_m + c * k.width_m);
  const Rect rect{foot_world.x() - half_x, foot_world.y() - half_y, foot_world.x() + half_x,
                  foot_world.y() + half_y};
  if (std::any_of(taken_.begin(), taken_.end(), [&](const Rect& other) { return other.overlaps(rect); }))
    return false;
  if (routes_.distance_m(rect) < clearance_m_) return false;
  reserve({rect.x0 + 1e-3, rect.y0 + 1e-3, rect.x1 - 1e-3, rect.y1 - 1e-3});  // neighbours may touch

  ++pieces_[static_cast<size_t>(outfit)];
  const Eigen::Affine3d T_world_object =
      Eigen::Translation3d(foot_world) * Eigen::AngleAxisd(heading_rad, Vec3::UnitZ());
  add_object(outfit, variant, 0, T_world_object);
  if (outfit == Outfit::tree) add_object(outfit, variant, 1, T_world_object);
  if (outfit == Outfit::street_lamp)
    world_.lights.push_back(street_light(static_cast<size_t>(pieces_[static_cast<size_t>(outfit)]),
                                         T_world_object * Vec3(kLampReach_m, 0, kLampHead_m), kLampArea_m2));
  return true;
}

void Outfitter::line(Outfit outfit, const Vec3& a_world, const Vec3& b_world, double length_m) {
  const Vec3 along = (b_world - a_world).normalized();
  const int count = static_cast<int>(std::floor((b_world - a_world).norm() / length_m + 1e-6));
  const double heading_rad = std::atan2(along.y(), along.x()) - 1.5707963267948966;
  for (int i = 0; i < count; ++i) place(outfit, a_world + (i + 0.5) * length_m * along, heading_rad, i % 3);
}

}  // namespace vsslam

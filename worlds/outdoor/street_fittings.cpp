#include "worlds/outdoor/street_fittings.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/rng.h"
#include "worlds/outdoor/street_furniture.h"

namespace vsslam {

namespace {

constexpr double kTurn_rad = 2 * std::numbers::pi;
constexpr double kCarPlace_m = 6.0, kClearCorner_m = 5.0;

/// One side of a street; s runs along the kerb, t into the pavement.
class SideFitter {
 public:
  SideFitter(Outfitter& outfitter, const Roadside& side, const StreetConfig& c, uint64_t number)
      : outfitter_(outfitter),
        side_(side),
        config_(c),
        number_(number),
        draws_(c.seed, "roadside"),
        along_((side.end_world - side.begin_world).normalized()),
        length_m_((side.end_world - side.begin_world).norm()),
        road_rad_(std::atan2(side.to_road.y(), side.to_road.x())) {}

  void fit() {
    add_lamps();
    add_trees();
    add_small_things();
    park_cars();
  }

 private:
  double draw(uint64_t item, uint64_t k) const { return draws_.uniform(number_ * 64 + item, k); }
  int variant(uint64_t item, uint64_t k, int of) const { return static_cast<int>(draw(item, k) * of); }
  Vec3 at(double s, double t) const {
    return side_.begin_world + s * along_ - t * side_.to_road + Vec3(0, 0, kPavementHeight_m);
  }

  // Every other side of a street begins half a spacing later.
  void add_lamps() {
    const int count = static_cast<int>(length_m_ / config_.lamp_spacing_m);
    const double first_m = (length_m_ - (count - 0.5) * config_.lamp_spacing_m) / 2;
    for (int k = 0; k < count; ++k) {
      const bool later = side_.to_road.x() + side_.to_road.y() < 0;
      outfitter_.place(Outfit::street_lamp,
                       at(first_m + (k + (later ? 0.5 : 0.0)) * config_.lamp_spacing_m, 0.45), road_rad_);
    }
  }
  void add_trees() {
    if (config_.tree_spacing_m <= 0) return;
    const int count = static_cast<int>((length_m_ - 6) / config_.tree_spacing_m);
    for (int i = 0; i < count; ++i) {
      const auto k = static_cast<uint64_t>(i);
      const double s_m = 3 + (i + 0.2 + 0.6 * draw(1, k)) * config_.tree_spacing_m;
      if (draw(2, k) < 0.85)
        outfitter_.place(Outfit::tree, at(s_m, 0.7), kTurn_rad * draw(3, k),
                         variant(4, k, Outfitter::kTrees));
    }
  }
  void add_small_things() {
    outfitter_.place(Outfit::sign_pole, at(4 + 2 * draw(5, 0), 0.4), road_rad_ + std::numbers::pi / 2);
    constexpr Outfit kThings[] = {Outfit::bench,   Outfit::bin, Outfit::bollard, Outfit::planter,
                                  Outfit::bollard, Outfit::bin, Outfit::bench,   Outfit::sign_pole};
    const int count = static_cast<int>(length_m_ / 8);
    for (int i = 0; i < count; ++i) {
      const auto k = static_cast<uint64_t>(i);
      const Outfit thing = kThings[static_cast<size_t>(8 * draw(6, k))];
      outfitter_.place(thing, at(length_m_ * draw(7, k), 0.85), road_rad_);
    }
    if (draw(8, 0) < 0.3)
      outfitter_.place(Outfit::advert_column, at(length_m_ * (0.3 + 0.4 * draw(8, 1)), 1.0));
  }
  void park_cars() {
    const int places = static_cast<int>((length_m_ - 2 * kClearCorner_m) / kCarPlace_m);
    for (int i = 0; i < places; ++i) {
      const auto k = static_cast<uint64_t>(i);
      if (draw(9, k) >= config_.parked_share) continue;
      const Vec3 foot = at(kClearCorner_m + (i + 0.5 + 0.12 * (2 * draw(10, k) - 1)) * kCarPlace_m,
                           -(0.25 + kCarWidth_m / 2 + 0.1 * draw(11, k)));
      const double heading = road_rad_ + std::numbers::pi / 2 + 0.03 * (2 * draw(12, k) - 1);
      outfitter_.place(Outfit::car, {foot.x(), foot.y(), 0},
                       draw(13, k) < 0.9 ? heading : heading + std::numbers::pi,
                       variant(14, k, Outfitter::kCars));
    }
  }

  Outfitter& outfitter_;
  const Roadside& side_;
  const StreetConfig& config_;
  uint64_t number_;
  RandomStream draws_;
  Vec3 along_;
  double length_m_, road_rad_;
};

// People stand alone or in twos, somewhere on the pavements.
void add_people(Outfitter& outfitter, const std::vector<Roadside>& sides, const StreetConfig& c) {
  const RandomStream draws(c.seed, "people");
  for (int i = 0; i < c.people; ++i) {
    const auto k = static_cast<uint64_t>(i);
    const auto draw = [&](uint64_t item) { return draws.uniform(k, item); };
    const Roadside& side = sides[static_cast<size_t>(draw(0) * static_cast<double>(sides.size()))];
    const Vec3 foot = side.begin_world + draw(1) * (side.end_world - side.begin_world) -
                      (0.8 + draw(2) * (c.pavement_width_m - 1.4)) * side.to_road +
                      Vec3(0, 0, kPavementHeight_m);
    const double heading = kTurn_rad * draw(3);
    outfitter.place(Outfit::person, foot, heading, static_cast<int>(draw(4) * Outfitter::kPeople));
    if (draw(5) < 0.4)
      outfitter.place(Outfit::person, foot + 0.9 * Vec3(std::cos(heading), std::sin(heading), 0),
                      heading + std::numbers::pi, static_cast<int>(draw(6) * Outfitter::kPeople));
  }
}

}  // namespace

void fit_roadsides(Outfitter& outfitter, const StreetLayout& layout, const StreetConfig& c) {
  for (size_t i = 0; i < layout.roadsides.size(); ++i) SideFitter(outfitter, layout.roadsides[i], c, i).fit();
  add_people(outfitter, layout.roadsides, c);
}

void fit_lawn(Outfitter& outfitter, const Rect& lawn, double base_m, const StreetConfig& c) {
  const RandomStream draws(c.seed, "lawn");
  const Vec3 middle((lawn.x0 + lawn.x1) / 2, (lawn.y0 + lawn.y1) / 2, base_m);
  outfitter.place(Outfit::monument, middle);
  const double dx = (lawn.x1 - lawn.x0) / 2, dy = (lawn.y1 - lawn.y0) / 2;
  for (const double x : {-0.5, 0.5}) outfitter.place(Outfit::flagpole, middle + Vec3(x * dx, 0.1 * dy, 0));
  for (int i = 0; i < 10; ++i) {  // stretches of hedge
    const auto k = static_cast<uint64_t>(i);
    const Vec3 from =
        middle + Vec3(dx * (1.7 * draws.uniform(k, 0) - 0.85), dy * (1.5 * draws.uniform(k, 1) - 0.75), 0);
    const bool lengthwise = draws.uniform(k, 2) < 0.6;
    outfitter.line(Outfit::hedge, from, from + (lengthwise ? Vec3(8, 0, 0) : Vec3(0, 6, 0)), 2);
  }
  constexpr Outfit kThings[] = {Outfit::tree, Outfit::tree,   Outfit::tree,    Outfit::bench,   Outfit::bin,
                                Outfit::tree, Outfit::person, Outfit::planter, Outfit::bollard, Outfit::tree};
  for (int i = 0; i < 70; ++i) {
    const auto k = static_cast<uint64_t>(i);
    const Outfit thing = kThings[static_cast<size_t>(10 * draws.uniform(k, 10))];
    const Vec3 foot =
        middle + Vec3(dx * (1.9 * draws.uniform(k, 11) - 0.95), dy * (1.9 * draws.uniform(k, 12) - 0.95), 0);
    outfitter.place(thing, foot, kTurn_rad * draws.uniform(k, 13),
                    static_cast<int>(6 * draws.uniform(k, 14)));
  }
}

void fit_gaps(Outfitter& outfitter, const std::vector<Rect>& gaps, Facing front, double base_m) {
  for (const Rect& gap : gaps) {
    const Rect r{gap.x0 + 0.1, gap.y0 + 1.5, gap.x1 - 0.1, gap.y1 - 1.5};
    if (front == Facing::north || front == Facing::south)
      for (const double y : {r.y0, r.y1})
        outfitter.line(Outfit::fence, {r.x0, y, base_m}, {r.x0 + 2 * 2.5, y, base_m}, 2.5);
    else
      for (const double x : {gap.x0 + 1.5, gap.x1 - 1.5})
        outfitter.line(Outfit::fence, {x, gap.y0 + 0.1, base_m}, {x, gap.y0 + 0.1 + 2 * 2.5, base_m}, 2.5);
  }
}

}  // namespace vsslam

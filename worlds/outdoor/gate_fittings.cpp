#include "worlds/outdoor/gate_fittings.h"

#include <cmath>
#include <numbers>

#include "core/rng.h"
#include "worlds/outdoor/gate_structure.h"
#include "worlds/outdoor/ground.h"

namespace vsslam {

namespace {

constexpr double kTurn_rad = 2 * std::numbers::pi;

class SquareFitter {
 public:
  SquareFitter(Outfitter& outfitter, const GatePlan& plan, const GateConfig& c)
      : outfitter_(outfitter), plan_(plan), config_(c), draws_(c.seed, "gate") {}

  void fit() {
    fit_lawn();
    light_up();
    park_cars();
    plant_rows();
    scatter_trees();
    scatter_things();
  }

 private:
  double draw(uint64_t k, uint64_t item) const { return draws_.uniform(k, item); }
  Vec3 anywhere(uint64_t k, const Rect& r, double z) const {
    return {r.x0 + draw(k, 10) * (r.x1 - r.x0), r.y0 + draw(k, 11) * (r.y1 - r.y0), z};
  }
  Rect open_square() const { return {-plan_.half, -plan_.half + 3, plan_.half, plan_.half}; }
  bool on_lawn(const Vec3& foot) const { return shrunk(plan_.lawn(), -1).contains(foot.x(), foot.y()); }

  void fit_lawn() {
    const Rect lawn = shrunk(plan_.lawn(), 0.8);
    const double z = kGateLawn_m, x = (lawn.x1 - lawn.x0) / 2, middle_y = (lawn.y0 + lawn.y1) / 2;
    outfitter_.place(Outfit::monument, {0, middle_y, z}, -std::numbers::pi / 2);
    for (const double dx : {-0.35, 0.0, 0.35}) outfitter_.place(Outfit::flagpole, {dx * x, lawn.y1 - 2.5, z});
    outfitter_.line(Outfit::hedge, {lawn.x0 + 3, lawn.y0 + 0.4, z}, {-3, lawn.y0 + 0.4, z}, 2);
    outfitter_.line(Outfit::hedge, {3, lawn.y0 + 0.4, z}, {lawn.x1 - 7, lawn.y0 + 0.4, z}, 2);
    outfitter_.line(Outfit::hedge, {lawn.x0 + 0.4, lawn.y0 + 4, z}, {lawn.x0 + 0.4, lawn.y1 - 4, z}, 2);
    for (int i = 0; i < 6; ++i) {
      const double at = lawn.x0 + (i + 0.5) * (lawn.x1 - lawn.x0) / 6;
      outfitter_.place(Outfit::bench, {at, plan_.lawn().y0 - 0.6, 0}, -std::numbers::pi / 2);
      if (i % 2) outfitter_.place(Outfit::bin, {at + 1.6, plan_.lawn().y0 - 0.5, 0});
    }
  }

  // Around the lawn, before the houses, and along the street.
  void light_up() {
    const Rect lawn = plan_.lawn();
    const double step = config_.lamp_spacing_m, h = plan_.half;
    for (double x = lawn.x0 + 2; x < lawn.x1; x += step)
      for (const bool north : {false, true})
        outfitter_.place(Outfit::street_lamp, {x, north ? lawn.y1 + 1.2 : lawn.y0 - 1.6, 0},
                         north ? std::numbers::pi / 2 : -std::numbers::pi / 2);
    for (double y = -h + 8; y < h; y += step)
      for (const double side : {-1.0, 1.0})
        outfitter_.place(Outfit::street_lamp, {side * (h - 5.5), y, 0}, side > 0 ? std::numbers::pi : 0);
    for (double x = -h; x <= h; x += step)
      outfitter_.place(Outfit::street_lamp, {x, h - 1.5, 0}, -std::numbers::pi / 2);
    for (double x = -plan_.street_end() + 6; x < plan_.street_end(); x += step)
      outfitter_.place(Outfit::street_lamp, {x, plan_.road_south() - 0.5, kGatePavement_m},
                       std::numbers::pi / 2);
  }

  // Side by side along the eastern and western houses, one behind the other in the street.
  void park_cars() {
    int place = 0;
    const auto park = [&](double x, double y, double heading_rad) {
      const auto k = static_cast<uint64_t>(++place);
      if (draw(k, 0) < config_.parked_share)
        outfitter_.place(Outfit::car, {x, y, 0}, heading_rad + (draw(k, 1) < 0.5 ? 0 : std::numbers::pi),
                         static_cast<int>(draw(k, 2) * Outfitter::kCars));
    };
    for (const double side : {-1.0, 1.0})
      for (double y = -0.45 * plan_.half; y < 0.7 * plan_.half; y += 2.9)
        park(side * (plan_.half - 1.8), y, 0);
    for (double x = -plan_.street_end() + 4; x < plan_.street_end() - 4; x += 6.2)
      park(x, plan_.road_south() + 1.15, 0);
  }

  // Behind the fence and along the street.
  void plant_rows() {
    for (const double side : {-1.0, 1.0})
      for (double x = kGateHalfWidth_m + 8; x < plan_.half - 3; x += 8)
        outfitter_.place(Outfit::tree, {side * x, plan_.road_north() + 5.5, kGatePavement_m}, x,
                         static_cast<int>(x) % Outfitter::kTrees);
    for (double x = 9 - plan_.street_end(); x < plan_.street_end(); x += 12)
      outfitter_.place(Outfit::tree, {x, plan_.road_south() - 0.8, kGatePavement_m}, x,
                       static_cast<int>(x + plan_.street_end()) % Outfitter::kTrees);
  }

  // A third of them on the lawn.
  void scatter_trees() {
    for (int i = 0; i < config_.trees; ++i) {
      const auto k = static_cast<uint64_t>(1000 + i);
      const bool lawn = i % 3 == 0;
      const Vec3 foot =
          lawn ? anywhere(k, shrunk(plan_.lawn(), 1.2), kGateLawn_m) : anywhere(k, open_square(), 0);
      if (lawn || !on_lawn(foot))
        outfitter_.place(Outfit::tree, foot, kTurn_rad * draw(k, 12), i % Outfitter::kTrees);
    }
  }

  void scatter_things() {
    constexpr Outfit kThings[] = {Outfit::planter, Outfit::bench, Outfit::bin, Outfit::advert_column,
                                  Outfit::sign_pole};
    constexpr int kCount = 24;
    for (int i = 0; i < kCount + config_.people; ++i) {
      const auto k = static_cast<uint64_t>(2000 + i);
      const Vec3 foot = anywhere(k, open_square(), 0);
      if (on_lawn(foot)) continue;
      if (i < kCount)
        outfitter_.place(kThings[i % 5], foot, 0.25 * kTurn_rad * std::floor(4 * draw(k, 12)));
      else
        outfitter_.place(Outfit::person, foot, kTurn_rad * draw(k, 12), i % Outfitter::kPeople);
    }
  }

  Outfitter& outfitter_;
  const GatePlan& plan_;
  const GateConfig& config_;
  RandomStream draws_;
};

}  // namespace

void fit_square(Outfitter& outfitter, const GatePlan& plan, const GateConfig& config) {
  SquareFitter(outfitter, plan, config).fit();
}

}  // namespace vsslam

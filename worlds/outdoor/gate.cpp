#include "worlds/outdoor/gate.h"

#include <algorithm>
#include <string>
#include <utility>

#include "worlds/outdoor/gate_fittings.h"
#include "worlds/outdoor/gate_plan.h"
#include "worlds/outdoor/gate_structure.h"
#include "worlds/outdoor/ground.h"
#include "worlds/outdoor/house_row.h"
#include "worlds/outdoor/street_fittings.h"
#include "worlds/route.h"

namespace vsslam {

namespace {

constexpr double kRouteClearance_m = 2.6, kHouseDepth_m = 14;

std::vector<Route> routes_of(const GatePlan& plan) {
  const double k = plan.scale, lane = kGateLane_m, out = plan.road_middle() + 1.7,
               in = plan.road_middle() - 1.7;
  const auto loop = [](const char* name, const std::vector<Vec3>& corners) {
    return rounded_loop(name, corners, 4, 1);
  };
  const double x = 29 * k, south = -19 * k, north = 23 * k, wide = 33 * k, low = -20 * k, high = 26 * k;
  return {loop("around", {{x, south, 0}, {x, north, 0}, {-x, north, 0}, {-x, south, 0}}),
          loop("out_west", {{x, south, 0},
                            {x, north, 0},
                            {-x, north, 0},
                            {-x, south, 0},
                            {-lane, south, 0},
                            {-lane, out, 0},
                            {-50 * k, out, 0},
                            {-50 * k, in, 0},
                            {lane, in, 0},
                            {lane, south, 0}}),
          loop("out_east", {{-wide, low, 0},
                            {-wide, high, 0},
                            {wide, high, 0},
                            {wide, low, 0},
                            {lane, low, 0},
                            {lane, out, 0},
                            {22 * k, out, 0},
                            {22 * k, in, 0},
                            {-lane, in, 0},
                            {-lane, low, 0}})};
}

class GateBuilder {
 public:
  explicit GateBuilder(const GateConfig& c)
      : config_(c), plan_(c), palette_(make_outdoor_palette(c.seed, c.textures)) {
    world_.name = "gate";
    world_.floor.seed = c.seed;
    world_.routes = routes_of(plan_);
    world_.lights.push_back(sunlight());
  }

  World build() {
    add_grounds();
    Outfitter outfitter(world_, palette_, config_.leaf_clusters, kRouteClearance_m, config_.seed);
    add_houses(outfitter);
    add_fence_and_gate(outfitter);
    fit_square(outfitter, plan_, config_);
    adopt_palette(world_, std::move(palette_));
    return std::move(world_);
  }

 private:
  void add_object(Mesh mesh, const std::string& name, Collision collision,
                  const Vec3& at_world = Vec3::Zero()) {
    world_.objects.push_back(
        {.name = name, .mesh = static_cast<int>(world_.meshes.size()), .collision = collision});
    world_.objects.back().T_world_object = Eigen::Translation3d(at_world);
    world_.meshes.push_back(std::move(mesh));
  }

  void add_grounds() {
    MeshBuilder b;
    const double end = plan_.street_end();
    pave(b, palette_.paving, plan_.square(), 0);
    add_object(b.finish("square"), "square", Collision::none);
    pave(b, palette_.asphalt, {-end, plan_.road_south(), end, plan_.road_north()}, 0);
    add_object(b.finish("street"), "street", Collision::none);
    raise_bed(b, palette_.kerb, palette_.pavement,
              {-end, plan_.road_south() - GatePlan::kPavementWidth_m, end, plan_.road_south()}, 0,
              kGatePavement_m);
    for (const double side : {-1.0, 1.0}) {
      const double a = side * (plan_.half + 1.5), e = side * end;
      raise_bed(b, palette_.kerb, palette_.pavement,
                {std::min(a, e), plan_.road_north(), std::max(a, e), -plan_.half + 1}, 0, kGatePavement_m);
      const double c = side * (kGateHalfWidth_m + 5), d = side * (plan_.half - 1);
      raise_bed(b, palette_.kerb, palette_.lawn,
                {std::min(c, d), plan_.road_north() + 2.5, std::max(c, d), -plan_.half - 1.5}, 0,
                kGatePavement_m);
    }
    raise_bed(b, palette_.kerb, palette_.lawn, plan_.lawn(), 0, kGateLawn_m);
    add_object(b.finish("beds"), "beds", Collision::mesh);
  }

  void add_row(Outfitter& outfitter, const Rect& strip, Facing front, uint64_t member) {
    MeshBuilder b;
    const HouseRowPlan row = plan_row({.strip = strip,
                                       .front = front,
                                       .member = member,
                                       .lot_m = 26,
                                       .fewest_floors = config_.fewest_floors,
                                       .most_floors = config_.most_floors,
                                       .gap_share = 0.3,
                                       .visible_back = false,
                                       .lit_share = config_.lit_share},
                                      Likeness(config_.seed, config_.aliasing));
    for (const Building& house : row.houses) {
      add_building(b, palette_, house);
      outfitter.reserve(house.footprint);
    }
    const std::string name = "houses_" + std::to_string(member + 1);
    add_object(b.finish(name), name, Collision::mesh);
    fit_gaps(outfitter, row.gaps, front, 0);
  }

  void add_houses(Outfitter& outfitter) {
    const double near = plan_.half + 1.5, far = near + kHouseDepth_m, end = plan_.street_end();
    const double side_south = -plan_.half + 1 + kHouseDepth_m,
                 opposite = plan_.road_south() - GatePlan::kPavementWidth_m;
    add_row(outfitter, {-far, side_south, -near, near}, Facing::east, 0);
    add_row(outfitter, {near, side_south, far, near}, Facing::west, 1);
    add_row(outfitter, {-far, near, far, far}, Facing::south, 2);
    add_row(outfitter, {-end, -plan_.half + 1, -near, side_south}, Facing::south, 3);
    add_row(outfitter, {near, -plan_.half + 1, end, side_south}, Facing::south, 4);
    add_row(outfitter, {-end, opposite - kHouseDepth_m, end, opposite}, Facing::north, 5);
    add_row(outfitter, {-end - kHouseDepth_m, opposite, -end, -plan_.half}, Facing::east, 6);
    add_row(outfitter, {end, opposite, end + kHouseDepth_m, -plan_.half}, Facing::west, 7);
  }

  void add_fence_and_gate(Outfitter& outfitter) {
    add_object(make_gate_structure(palette_), "gate", Collision::mesh, {0, -plan_.half, 0});
    outfitter.reserve({-kGateHalfWidth_m - 4, -plan_.half - 2, kGateHalfWidth_m + 4, -plan_.half + 2});
    const double x = kGateHalfWidth_m + 4.05;
    outfitter.line(Outfit::fence, {-x, -plan_.half, 0}, {-plan_.half - 1, -plan_.half, 0}, 2.5);
    outfitter.line(Outfit::fence, {x, -plan_.half, 0}, {plan_.half + 1, -plan_.half, 0}, 2.5);
    for (const double side : {-1.0, 1.0})
      for (int i = 0; i < 4; ++i)
        outfitter.place(Outfit::bollard, {side * (kGateHalfWidth_m - 0.6), -plan_.half - 2.5 - 1.6 * i, 0});
  }

  const GateConfig& config_;
  GatePlan plan_;
  OutdoorPalette palette_;
  World world_;
};

}  // namespace

void GateConfig::fields(Fields& f) {
  f("size_m", size_m, between(70, 400));
  f("fewest_floors", fewest_floors, between(1, 20));
  f("most_floors", most_floors, between(1, 20));
  f("aliasing", aliasing, between(0, 1));
  f("trees", trees, between(0, 10000));
  f("leaf_clusters", leaf_clusters, between(0, 20000));
  f("lamp_spacing_m", lamp_spacing_m, between(5, 1000));
  f("parked_share", parked_share, between(0, 1));
  f("people", people, between(0, 10000));
  f("lit_share", lit_share, between(0, 1));
  f("textures", textures);
  f("seed", seed);
  f.check(most_floors >= fewest_floors, "most_floors", "at least fewest_floors");
}

World make_gate(const GateConfig& config) {
  return GateBuilder(config).build();
}

}  // namespace vsslam

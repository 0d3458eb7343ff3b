#include "worlds/outdoor/street.h"

#include <algorithm>
#include <string>
#include <utility>

#include "worlds/outdoor/ground.h"
#include "worlds/outdoor/house_row.h"
#include "worlds/outdoor/street_fittings.h"
#include "worlds/outdoor/street_layout.h"

namespace vsslam {

namespace {

constexpr double kRouteClearance_m = 2.2, kHouseDepth_m = 13;

class StreetBuilder {
 public:
  explicit StreetBuilder(const StreetConfig& c)
      : config_(c),
        palette_(make_outdoor_palette(c.seed, c.textures)),
        layout_(lay_out(c)),
        like_(c.seed, c.aliasing) {
    world_.name = "street";
    world_.floor.seed = c.seed;
    world_.routes = layout_.routes;
    world_.lights.push_back(sunlight());
  }

  World build() {
    add_roads();
    Outfitter outfitter(world_, palette_, config_.leaf_clusters, kRouteClearance_m, config_.seed);
    for (const Block& block : layout_.blocks) add_block(block, outfitter);
    fit_roadsides(outfitter, layout_, config_);
    adopt_palette(world_, std::move(palette_));
    return std::move(world_);
  }

 private:
  void add_object(MeshBuilder& builder, const std::string& name, Collision collision) {
    world_.objects.push_back(
        {.name = name, .mesh = static_cast<int>(world_.meshes.size()), .collision = collision});
    world_.meshes.push_back(builder.finish(name));
  }

  void add_roads() {
    int number = 0;
    MeshBuilder road, paint;
    for (const Rect& r : layout_.roads) {
      pave(road, palette_.asphalt, r, 0);
      add_object(road, "road_" + std::to_string(++number), Collision::none);
      mark(paint, r);
    }
    add_object(paint, "markings", Collision::none);
  }
  // A broken line along the middle, thin enough not to be felt.
  void mark(MeshBuilder& paint, const Rect& r) {
    constexpr double kDash_m = 3, kPeriod_m = 9, kHalf_m = 0.06, kHeight_m = 0.004;
    const bool along_x = r.x1 - r.x0 > r.y1 - r.y0;
    const double x = (r.x0 + r.x1) / 2, y = (r.y0 + r.y1) / 2;
    for (double s = (along_x ? r.x0 : r.y0) + 2; s + kDash_m < (along_x ? r.x1 : r.y1); s += kPeriod_m)
      pave(paint, {palette_.marking, 1, 1},
           along_x ? Rect{s, y - kHalf_m, s + kDash_m, y + kHalf_m}
                   : Rect{x - kHalf_m, s, x + kHalf_m, s + kDash_m},
           kHeight_m);
  }

  void add_block(const Block& block, Outfitter& outfitter) {
    const std::string number = std::to_string(++blocks_);
    MeshBuilder ground, houses;
    const bool lawn = block.kind == Block::Kind::lawn;
    raise_bed(ground, palette_.kerb, palette_.pavement, block.rect, 0, kPavementHeight_m);
    const Rect inner = shrunk(block.rect, config_.pavement_width_m);
    if (lawn) raise_bed(ground, palette_.kerb, palette_.lawn, inner, kPavementHeight_m, 0.06);
    if (block.kind == Block::Kind::houses) {
      const double depth_m = std::min(kHouseDepth_m, 0.4 * (inner.y1 - inner.y0));
      const Rect yard{inner.x0, inner.y0 + depth_m + 1, inner.x1, inner.y1 - depth_m - 1};
      raise_bed(ground, palette_.kerb, palette_.lawn, yard, kPavementHeight_m, 0.06);
      add_row(houses, outfitter, {inner.x0, inner.y0, inner.x1, inner.y0 + depth_m}, Facing::south, true);
      add_row(houses, outfitter, {inner.x0, inner.y1 - depth_m, inner.x1, inner.y1}, Facing::north, true);
      fit_yard(outfitter, shrunk(yard, 0.6));
    }
    if (block.kind == Block::Kind::edge) {
      Rect strip = block.rect;
      (block.front == Facing::east    ? strip.x1
       : block.front == Facing::west  ? strip.x0
       : block.front == Facing::north ? strip.y1
                                      : strip.y0) +=
          block.front == Facing::east || block.front == Facing::north ? -config_.pavement_width_m
                                                                      : config_.pavement_width_m;
      add_row(houses, outfitter, strip, block.front, false);
    }
    if (block.kind == Block::Kind::corner) add_row(houses, outfitter, block.rect, block.front, true);
    add_object(ground, "ground_" + number, Collision::mesh);
    if (!lawn) add_object(houses, "houses_" + number, Collision::mesh);
    if (lawn) fit_lawn(outfitter, shrunk(inner, 0.5), kPavementHeight_m + 0.06, config_);
  }

  void add_row(MeshBuilder& houses, Outfitter& outfitter, const Rect& strip, Facing front,
               bool visible_back) {
    const HouseRowPlan plan = plan_row({.strip = strip,
                                        .front = front,
                                        .member = rows_++,
                                        .base_m = kPavementHeight_m,
                                        .fewest_floors = config_.fewest_floors,
                                        .most_floors = config_.most_floors,
                                        .visible_back = visible_back,
                                        .lit_share = config_.lit_share},
                                       like_);
    for (const Building& house : plan.houses) {
      add_building(houses, palette_, house);
      outfitter.reserve(house.footprint);
    }
    fit_gaps(outfitter, plan.gaps, front, kPavementHeight_m);
  }

  // Fences towards the streets at both ends, trees behind them.
  void fit_yard(Outfitter& outfitter, const Rect& yard) {
    const double base_m = kPavementHeight_m + 0.06;
    for (const double x : {yard.x0, yard.x1})
      outfitter.line(Outfit::fence, {x, yard.y0, base_m}, {x, yard.y1, base_m}, 2.5);
    const RandomStream draws(config_.seed, "yard");
    for (uint64_t k = 0; k < 3; ++k) {
      const auto draw = [&](uint64_t item) { return draws.uniform(rows_, 8 * k + item); };
      const double from_end_m = 3 + 4 * draw(0);
      outfitter.place(Outfit::tree,
                      {draw(1) < 0.5 ? yard.x0 + from_end_m : yard.x1 - from_end_m,
                       yard.y0 + draw(2) * (yard.y1 - yard.y0), base_m},
                      6.28 * draw(3), static_cast<int>(draw(4) * Outfitter::kTrees));
    }
  }

  const StreetConfig& config_;
  OutdoorPalette palette_;
  StreetLayout layout_;
  Likeness like_;
  World world_;
  int blocks_ = 0;
  uint64_t rows_ = 0;
};

}  // namespace

void StreetConfig::fields(Fields& f) {
  f("columns", columns, between(4, 60));
  f("rows", rows, between(3, 60));
  f("pitch_x_m", pitch_x_m, between(50, 400));
  f("pitch_y_m", pitch_y_m, between(50, 400));
  f("road_width_m", road_width_m, between(9, 30));
  f("pavement_width_m", pavement_width_m, between(1.5, 8));
  f("fewest_floors", fewest_floors, between(1, 20));
  f("most_floors", most_floors, between(1, 20));
  f("aliasing", aliasing, between(0, 1));
  f("tree_spacing_m", tree_spacing_m, between(0, 1000));
  f("leaf_clusters", leaf_clusters, between(0, 20000));
  f("lamp_spacing_m", lamp_spacing_m, between(5, 1000));
  f("parked_share", parked_share, between(0, 1));
  f("people", people, between(0, 10000));
  f("lit_share", lit_share, between(0, 1));
  f("textures", textures);
  f("seed", seed);
  f.check(most_floors >= fewest_floors, "most_floors", "at least fewest_floors");
}

World make_street(const StreetConfig& config) {
  return StreetBuilder(config).build();
}

}  // namespace vsslam

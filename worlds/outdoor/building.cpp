#include "worlds/outdoor/building.h"

#include <algorithm>
#include <cmath>

#include "core/rng.h"

namespace vsslam {

namespace {

constexpr double kDoorWidth_m = 1.3, kDoorHeight_m = 2.3, kPlinth_m = 0.45;

/// What all walls of a house share.
struct Style {
  Style(const OutdoorPalette& palette, uint64_t look) : draws(look, "house") {
    const auto pick = [&](uint64_t item, size_t size) {
      return static_cast<size_t>(draws.uniform(item) * static_cast<double>(size));
    };
    wall = palette.facades[pick(0, palette.facades.size())];
    floor_m = 3.1 + 0.7 * draws.uniform(1);
    bay_m = 2.5 + 1.3 * draws.uniform(2);
    window_width_m = 1.1 + 0.5 * draws.uniform(3);
    sill_m = 0.85 + 0.2 * draws.uniform(4);
    window_height_m = 1.4 + 0.3 * draws.uniform(5);
    recess_m = 0.12 + 0.2 * draws.uniform(6);
    courses = draws.uniform(7) < 0.6;
    pilasters = draws.uniform(8) < 0.35;
    balconies = draws.uniform(9) < 0.4;
    door = palette.doors[pick(10, palette.doors.size())];
  }
  RandomStream draws;
  Finish wall;
  double floor_m, bay_m, window_width_m, sill_m, window_height_m, recess_m;
  bool courses, pilasters, balconies;
  int door;
};

/// One wall: u runs to the right for who faces it, v up from the ground, d out of the wall.
class Wall {
 public:
  Wall(MeshBuilder& builder, const OutdoorPalette& palette, const Building& building, const Style& style,
       Facing facing)
      : builder_(builder), palette_(palette), building_(building), style_(style), facing_(facing) {
    const Rect& r = building.footprint;
    const Vec3 corners[] = {{r.x1, r.y0, building.base_m},
                            {r.x1, r.y1, building.base_m},
                            {r.x0, r.y1, building.base_m},
                            {r.x0, r.y0, building.base_m}};
    const Vec3 normals[] = {Vec3::UnitX(), Vec3::UnitY(), -Vec3::UnitX(), -Vec3::UnitY()};
    const auto side = static_cast<size_t>(facing);
    origin_ = corners[side];
    normal_ = normals[side];
    right_ = Vec3::UnitZ().cross(normal_);
    width_m_ = side % 2 == 0 ? r.y1 - r.y0 : r.x1 - r.x0;
    bays_ = std::max(1, static_cast<int>(width_m_ / style.bay_m));
    bay_m_ = width_m_ / bays_;
    window_m_ = std::min(style.window_width_m, 0.6 * bay_m_);
  }

  void build() {
    for (int floor = 0; floor < building_.floors; ++floor)
      for (int bay = 0; bay < bays_; ++bay) add_bay(bay, floor);
    dress();
  }

  void build_plain() { wall_quad(0, 0, width_m_, building_height_m(building_)); }

 private:
  Vec3 at(double u, double v, double d) const {
    return origin_ + u * right_ + v * Vec3::UnitZ() + d * normal_;
  }
  bool is_front() const { return facing_ == building_.front; }
  double draw(const char* what, int bay, int floor) const {
    const RandomStream stream(building_.look + 977 * static_cast<uint64_t>(facing_), what);
    return stream.uniform(static_cast<uint64_t>(bay), static_cast<uint64_t>(floor));
  }

  void wall_quad(double u0, double v0, double u1, double v1) {
    builder_.face(style_.wall.material, {at(u0, v0, 0), at(u1, v0, 0), at(u1, v1, 0), at(u0, v1, 0)}, normal_,
                  1 / style_.wall.width_m);
  }

  // The four sides of the hole, and what closes it; its texture covers the pane once.
  void opening(double u0, double v0, double u1, double v1, int pane) {
    const double r = style_.recess_m, uv = 1 / palette_.stone.width_m;
    const int m = palette_.stone.material;
    builder_.face(m, {at(u0, v0, 0), at(u0, v0, -r), at(u0, v1, -r), at(u0, v1, 0)}, right_, uv);
    builder_.face(m, {at(u1, v0, -r), at(u1, v0, 0), at(u1, v1, 0), at(u1, v1, -r)}, -right_, uv);
    builder_.face(m, {at(u0, v0, 0), at(u1, v0, 0), at(u1, v0, -r), at(u0, v0, -r)}, Vec3::UnitZ(), uv);
    builder_.face(m, {at(u0, v1, -r), at(u1, v1, -r), at(u1, v1, 0), at(u0, v1, 0)}, -Vec3::UnitZ(), uv);
    const auto vertex = [&](double u, double v, float x, float y) {
      return Vertex{at(u, v, -r).cast<float>(), normal_.cast<float>(), {x, y}};
    };
    builder_.quad(pane, vertex(u0, v0, 0, 1), vertex(u1, v0, 1, 1), vertex(u1, v1, 1, 0),
                  vertex(u0, v1, 0, 0));
  }

  void add_bay(int bay, int floor) {
    const double left = bay * bay_m_, bottom = floor * style_.floor_m, top = bottom + style_.floor_m;
    const bool door = is_front() && floor == 0 && bay == bays_ / 2;
    const bool blind = !door && draw("blind", bay, floor) < (is_front() ? 0.05 : 0.4);
    const double middle = left + bay_m_ / 2,
                 half = door ? std::min(kDoorWidth_m, 0.8 * bay_m_) / 2 : window_m_ / 2;
    const double sill = door ? bottom : bottom + style_.sill_m,
                 head = door ? bottom + kDoorHeight_m : sill + style_.window_height_m;
    wall_quad(left, bottom, middle - half, top);
    wall_quad(middle + half, bottom, left + bay_m_, top);
    if (sill > bottom) wall_quad(middle - half, bottom, middle + half, sill);
    wall_quad(middle - half, head, middle + half, top);
    if (blind) {
      wall_quad(middle - half, sill, middle + half, head);
      return;
    }
    opening(middle - half, sill, middle + half, head, door ? style_.door : pane(bay, floor));
    if (door) {
      block(middle - 1.1, kDoorHeight_m + 0.2, middle + 1.1, kDoorHeight_m + 0.35, 0, 1.1, palette_.stone);
      block(middle - 0.9, 0, middle + 0.9, 0.14, 0, 0.7, palette_.stone);
    } else {
      block(middle - half - 0.06, sill - 0.08, middle + half + 0.06, sill, -0.02, 0.09, palette_.stone);
      if (style_.balconies && floor > 0 && draw("balcony", bay, 0) < 0.3) balcony(middle, bottom);
    }
  }

  int pane(int bay, int floor) const {
    if (draw("lit", bay, floor) < building_.lit_share) return palette_.lit_window;
    const double pick = draw("pane", bay, floor) * static_cast<double>(palette_.windows.size());
    return palette_.windows[static_cast<size_t>(pick)];
  }

  void balcony(double middle, double bottom) {
    const double half = std::min(1.2, 0.45 * bay_m_);
    const Finish steel{palette_.dark_steel, 1, 1};
    block(middle - half, bottom - 0.1, middle + half, bottom + 0.05, 0, 1.0, palette_.stone);
    block(middle - half, bottom + 1.0, middle + half, bottom + 1.05, 0.94, 1.0, steel);
    for (double u = middle - half + 0.03; u < middle + half; u += 0.25)
      builder_.limb(palette_.dark_steel, at(u, bottom + 0.05, 0.97), at(u, bottom + 1.0, 0.97), 0.015, 0.015,
                    3, false);
  }

  /// A box that stands out of the wall.
  void block(double u0, double v0, double u1, double v1, double d0, double d1, const Finish& finish) {
    const Vec3 a = at(u0, v0, d0), b = at(u1, v1, d1);
    const Vec3 low = a.cwiseMin(b), size = (a - b).cwiseAbs();
    builder_.box(finish.material, {low.x() + size.x() / 2, low.y() + size.y() / 2, low.z()}, size,
                 1 / finish.width_m);
  }

  // Plinth, ledges between floors, pilasters between bays, the parapet, a rain pipe.
  void dress() {
    const double height = building_height_m(building_);
    const Finish& stone = palette_.stone;
    const double door_left = is_front() ? (bays_ / 2 + 0.5) * bay_m_ - 0.8 : width_m_;
    block(0, 0, std::min(door_left, width_m_), kPlinth_m, -0.02, 0.06, stone);
    if (is_front()) block(door_left + 1.6, 0, width_m_, kPlinth_m, -0.02, 0.06, stone);
    if (style_.courses)
      for (int floor = 1; floor < building_.floors; ++floor)
        block(0, floor * style_.floor_m - 0.12, width_m_, floor * style_.floor_m + 0.06, -0.02, 0.1, stone);
    if (style_.pilasters)
      for (int bay = 0; bay <= bays_; bay += 2) {
        const double u = std::clamp(bay * bay_m_, 0.2, width_m_ - 0.2);
        block(u - 0.2, 0, u + 0.2, height, -0.02, 0.22, style_.wall);
      }
    block(0, height - 0.15, width_m_, height + 0.5, -0.25, 0.2, stone);
    const double pipe = draw("pipe", 0, 0) < 0.5 ? 0.3 : width_m_ - 0.3;
    const Vec3 foot = at(pipe, 0, 0.32);
    builder_.limb(palette_.steel, foot, foot + Vec3(0, 0, height), 0.055, 0.055, 6, false);
  }

  MeshBuilder& builder_;
  const OutdoorPalette& palette_;
  const Building& building_;
  const Style& style_;
  Facing facing_;
  Vec3 origin_, normal_, right_;
  double width_m_ = 0, bay_m_ = 0, window_m_ = 0;
  int bays_ = 1;
};

}  // namespace

double building_height_m(const Building& building) {
  return building.floors * (3.1 + 0.7 * RandomStream(building.look, "house").uniform(1));
}

void add_building(MeshBuilder& builder, const OutdoorPalette& palette, const Building& building) {
  const Style style(palette, building.look);
  for (const Facing facing : {Facing::east, Facing::north, Facing::west, Facing::south}) {
    Wall wall(builder, palette, building, style, facing);
    if (building.visible[static_cast<size_t>(facing)])
      wall.build();
    else
      wall.build_plain();
  }
  const Rect& r = building.footprint;
  const double top_m = building.base_m + building_height_m(building);
  builder.face(
      palette.roof.material,
      {Vec3(r.x0, r.y0, top_m), Vec3(r.x1, r.y0, top_m), Vec3(r.x1, r.y1, top_m), Vec3(r.x0, r.y1, top_m)},
      Vec3::UnitZ(), 1 / palette.roof.width_m);
}

}  // namespace vsslam

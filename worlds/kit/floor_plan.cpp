#include "worlds/kit/floor_plan.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "core/rng.h"

namespace vsslam {

namespace {

constexpr double kSame_m = 1e-4;  // lines nearer than this are one line

/// Coordinates of the lattice along one axis.
class Lines {
 public:
  void add(double value) { values_.push_back(value); }
  /// Sorts, merges, and divides what is longer than `longest_m`.
  void finish(double longest_m) {
    std::sort(values_.begin(), values_.end());
    std::vector<double> merged;
    for (const double v : values_)
      if (merged.empty() || v - merged.back() > kSame_m) merged.push_back(v);
    values_.clear();
    for (size_t i = 0; i < merged.size(); ++i) {
      values_.push_back(merged[i]);
      if (i + 1 == merged.size()) break;
      const double length = merged[i + 1] - merged[i];
      const int parts = std::max(1, static_cast<int>(std::ceil(length / longest_m - 1e-9)));
      for (int k = 1; k < parts; ++k) values_.push_back(merged[i] + length * k / parts);
    }
  }
  int cells() const { return static_cast<int>(values_.size()) - 1; }
  double operator[](int i) const { return values_[static_cast<size_t>(i)]; }
  double middle(int i) const { return 0.5 * ((*this)[i] + (*this)[i + 1]); }
  int index_of(double value) const {
    return static_cast<int>(std::lower_bound(values_.begin(), values_.end(), value - kSame_m) -
                            values_.begin());
  }

 private:
  std::vector<double> values_;
};

constexpr int kOutside = -1, kSolid = -2;

Vec3 normal_of(Facing facing) {
  switch (facing) {
    case Facing::east:
      return Vec3::UnitX();
    case Facing::north:
      return Vec3::UnitY();
    case Facing::west:
      return -Vec3::UnitX();
    default:
      return -Vec3::UnitY();
  }
}
bool along_y(Facing facing) {
  return facing == Facing::east || facing == Facing::west;
}
// To the right for who looks at the wall: z x normal.
double right_sign(Facing facing) {
  return facing == Facing::east || facing == Facing::south ? 1 : -1;
}

class ShellBuilder {
 public:
  ShellBuilder(const FloorPlan& plan, const Floor& floor) : plan_(plan), floor_(floor) {
    cut_lattice();
    classify_cells();
    for (const WallPanel& panel : plan.wall_panels)
      panels_[{static_cast<int>(panel.facing), line_of(panel)}].push_back(&panel);
  }

  Shell build() {
    for (int i = 0; i < x_.cells(); ++i)
      for (int j = 0; j < y_.cells(); ++j) {
        if (cell(i, j) < 0) continue;
        floor_cell(i, j);
        ceiling_cell(i, j);
        wall(i, j, i - 1, j, Facing::east);
        wall(i, j, i + 1, j, Facing::west);
        wall(i, j, i, j - 1, Facing::north);
        wall(i, j, i, j + 1, Facing::south);
      }
    return {floor_mesh_.finish("floor"), walls_.finish("walls"), ceiling_.finish("ceiling")};
  }

 private:
  void cut_lattice() {
    const auto cut = [&](const Rect& r) {
      x_.add(r.x0), x_.add(r.x1);
      y_.add(r.y0), y_.add(r.y1);
    };
    z_.add(0);
    for (const Area& area : plan_.areas) cut(area.rect), z_.add(area.ceiling_m);
    for (const Rect& solid : plan_.solids) cut(solid);
    for (const CeilingPanel& panel : plan_.ceiling_panels) cut(panel.rect);
    for (const WallPanel& panel : plan_.wall_panels) {
      Lines& along = along_y(panel.facing) ? y_ : x_;
      along.add(panel.from_m), along.add(panel.to_m);
      z_.add(panel.bottom_m), z_.add(panel.top_m);
    }
    x_.finish(plan_.tessellation_m);
    y_.finish(plan_.tessellation_m);
    z_.finish(plan_.tessellation_m);
  }

  void classify_cells() {
    cells_.assign(static_cast<size_t>(x_.cells()) * static_cast<size_t>(y_.cells()), kOutside);
    for (size_t a = 0; a < plan_.areas.size(); ++a) mark(plan_.areas[a].rect, static_cast<int>(a));
    for (const Rect& solid : plan_.solids) mark(solid, kSolid);
  }
  void mark(const Rect& r, int value) {
    for (int i = x_.index_of(r.x0); i < x_.index_of(r.x1); ++i)
      for (int j = y_.index_of(r.y0); j < y_.index_of(r.y1); ++j) {
        int& c = cells_[slot(i, j)];
        if (value >= 0 || c >= 0) c = value;
      }
  }
  size_t slot(int i, int j) const {
    return static_cast<size_t>(i) * static_cast<size_t>(y_.cells()) + static_cast<size_t>(j);
  }
  int cell(int i, int j) const {
    if (i < 0 || j < 0 || i >= x_.cells() || j >= y_.cells()) return kOutside;
    return cells_[slot(i, j)];
  }
  const Area& area(int i, int j) const { return plan_.areas[static_cast<size_t>(cell(i, j))]; }
  int line_of(const WallPanel& panel) const {
    return along_y(panel.facing) ? x_.index_of(panel.at_m) : y_.index_of(panel.at_m);
  }

  Vertex level_vertex(double x, double y, double z, const Vec3& n, const Eigen::Vector2d& uv) const {
    return {Vec3(x, y, z).cast<float>(), n.cast<float>(), uv.cast<float>()};
  }

  void floor_cell(int i, int j) {
    const Finish& f = area(i, j).floor;
    const auto v = [&](int a, int b) {
      const double x = x_[a], y = y_[b];
      return level_vertex(x, y, floor_.height(x, y), floor_.normal(x, y), {x / f.width_m, -y / f.height_m});
    };
    floor_mesh_.quad(f.material, v(i, j), v(i + 1, j), v(i + 1, j + 1), v(i, j + 1));
  }

  void ceiling_cell(int i, int j) {
    const Area& a = area(i, j);
    const CeilingPanel* panel = nullptr;
    for (const CeilingPanel& p : plan_.ceiling_panels)
      if (p.rect.contains(x_.middle(i), y_.middle(j))) panel = &p;
    const auto v = [&](int ia, int jb) {
      const double x = x_[ia], y = y_[jb];
      Eigen::Vector2d uv(x / a.ceiling.width_m, y / a.ceiling.height_m);
      if (panel) {
        const Rect& r = panel->rect;
        uv = {(x - r.x0) / (r.x1 - r.x0), (y - r.y0) / (r.y1 - r.y0)};
      }
      return level_vertex(x, y, a.ceiling_m, -Vec3::UnitZ(), uv);
    };
    const int material = panel ? panel->material : a.ceiling.material;
    ceiling_.quad(material, v(i, j), v(i, j + 1), v(i + 1, j + 1), v(i + 1, j));
  }

  // The wall of cell (i, j) towards its neighbour (ni, nj): all of it where that is not free space, the part
  // above a lower ceiling otherwise.
  void wall(int i, int j, int ni, int nj, Facing facing) {
    const double top_m = area(i, j).ceiling_m;
    const int neighbour = cell(ni, nj);
    const double bottom_m = neighbour < 0 ? 0 : area(ni, nj).ceiling_m;
    for (int k = z_.index_of(bottom_m); k < z_.index_of(top_m); ++k)
      wall_cell(i, j, k, facing, neighbour == kSolid);
  }

  void wall_cell(int i, int j, int k, Facing facing, bool solid) {
    const bool y_wall = along_y(facing);
    const int line = facing == Facing::east    ? i
                     : facing == Facing::west  ? i + 1
                     : facing == Facing::north ? j
                                               : j + 1;
    const Lines& along = y_wall ? y_ : x_;
    const int first = y_wall ? j : i;
    const WallPanel* panel = panel_at(facing, line, along.middle(first), z_.middle(k));
    const Finish finish = solid ? plan_.solid_finish : wall_finish(area(i, j), facing, along.middle(first));
    const double sign = right_sign(facing);
    const auto v = [&](int a, int b) {
      const double s = along[a], z = z_[b];
      Eigen::Vector2d uv(sign * s / finish.width_m, 1 - z / finish.height_m);
      if (panel) {
        const double u = (s - panel->from_m) / (panel->to_m - panel->from_m);
        uv = {sign > 0 ? u : 1 - u, (panel->top_m - z) / (panel->top_m - panel->bottom_m)};
      }
      const double x = y_wall ? x_[line] : s, y = y_wall ? s : y_[line];
      return level_vertex(x, y, b == 0 ? floor_.height(x, y) : z, normal_of(facing), uv);
    };
    const int left = sign > 0 ? first : first + 1, right = sign > 0 ? first + 1 : first;
    walls_.quad(panel ? panel->material : finish.material, v(left, k), v(right, k), v(right, k + 1),
                v(left, k + 1));
  }

  const WallPanel* panel_at(Facing facing, int line, double along_m, double z_m) const {
    const auto it = panels_.find({static_cast<int>(facing), line});
    const WallPanel* found = nullptr;
    if (it == panels_.end()) return found;
    for (const WallPanel* p : it->second)
      if (along_m > p->from_m && along_m < p->to_m && z_m > p->bottom_m && z_m < p->top_m) found = p;
    return found;
  }

  // Counting sections to the right makes the choice turn with the area.
  static Finish wall_finish(const Area& a, Facing facing, double along_m) {
    if (a.walls.size() == 1) return a.walls.front();
    const double right_m = right_sign(facing) * along_m;
    auto section = static_cast<int64_t>(std::floor(right_m / a.walls.front().width_m));
    if (a.wall_period > 0) section = ((section % a.wall_period) + a.wall_period) % a.wall_period;
    const auto side = static_cast<uint64_t>((static_cast<int>(facing) - a.quarter_turns + 8) % 4);
    const uint64_t bits =
        RandomStream(a.wall_seed, "wall sections").bits(static_cast<uint64_t>(section), side);
    return a.walls[bits % a.walls.size()];
  }

  const FloorPlan& plan_;
  const Floor& floor_;
  Lines x_, y_, z_;
  std::vector<int> cells_;  // index of the area, or kOutside, kSolid
  std::map<std::pair<int, int>, std::vector<const WallPanel*>> panels_;  // by facing and line
  MeshBuilder floor_mesh_, walls_, ceiling_;
};

}  // namespace

bool FloorPlan::inside(double x, double y) const {
  const auto contains = [&](const Rect& r) { return r.contains(x, y); };
  return std::any_of(areas.begin(), areas.end(), [&](const Area& a) { return contains(a.rect); }) &&
         std::none_of(solids.begin(), solids.end(), contains);
}

bool FloorPlan::carries(const WallPanel& panel) const {
  constexpr double kDepth_m = 0.01, kSamples = 16;
  const Vec3 n = normal_of(panel.facing);
  const auto strip = [&](double side) {  // a thin rectangle before (side 1) or behind (-1) the wall
    const double near = panel.at_m, far = panel.at_m + side * kDepth_m * (n.x() + n.y());
    const double low = std::min(near, far), high = std::max(near, far);
    return along_y(panel.facing) ? Rect{low, panel.from_m, high, panel.to_m}
                                 : Rect{panel.from_m, low, panel.to_m, high};
  };
  const Rect behind = strip(-1), before = strip(1);
  for (const Area& a : areas)
    if (a.rect.overlaps(behind)) return false;
  for (int i = 0; i < kSamples; ++i) {
    const double u = (i + 0.5) / kSamples;
    const double x =
        along_y(panel.facing) ? 0.5 * (before.x0 + before.x1) : before.x0 + u * (before.x1 - before.x0);
    const double y =
        along_y(panel.facing) ? before.y0 + u * (before.y1 - before.y0) : 0.5 * (before.y0 + before.y1);
    if (!inside(x, y)) return false;
  }
  return true;
}

Shell build_shell(const FloorPlan& plan, const Floor& floor) {
  return ShellBuilder(plan, floor).build();
}

}  // namespace vsslam

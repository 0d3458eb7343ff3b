#include "slam/lidar/plane_map.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

#include "slam/lidar/patch.h"

namespace vsslam {

void PlaneMapConfig::fields(Fields& f) {
  f("cell_m", cell_m, positive());
  f("levels", levels, between(1, 8));
  f("min_points", min_points, between(3, 1e6));
  f("min_lines", min_lines, between(1, 64));
  f.automatic("max_thickness_m", max_thickness_m, positive());
  f("plane_sigma_m", plane_sigma_m, non_negative());
  f("max_normal_sigma_rad", max_normal_sigma_rad, positive());
  f.automatic("max_chord_tilt_m", max_chord_tilt_m, positive());
}

namespace {

// Of the cubes' corners from the origin. The origin of odom is where the robot began, on the ground and often in the
// middle of a corridor: a floor or wall that runs along the border between two cubes belongs to neither.
const Eigen::Vector3f kCorner_m(0.7f, 0.7f, 0.7f);  // half way between borders at the finest level, 0.2 m

uint64_t cube_of(const Eigen::Vector3f& point_odom, float inverse_cell) {
  return voxel_key(point_odom + kCorner_m, inverse_cell);
}

// Lower triangle of sum v v^T.
struct SquareSum {
  double xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0;

  void add(const Eigen::Vector3f& v) {
    const double x = v.x(), y = v.y(), z = v.z();
    xx += x * x, xy += x * y, xz += x * z, yy += y * y, yz += y * z, zz += z * z;
  }
  SquareSum operator+(const SquareSum& o) const {
    return {xx + o.xx, xy + o.xy, xz + o.xz, yy + o.yy, yz + o.yz, zz + o.zz};
  }
  Mat3 matrix() const {
    Mat3 m;
    m << xx, xy, xz, xy, yy, yz, xz, yz, zz;
    return m;
  }
};

// Sums over the points of one class of a cell, about the cell's first point.
struct Sums {
  Vec3 offset = Vec3::Zero();
  SquareSum square, chord_square;
  int count = 0;
  uint64_t lines = 0;  // one bit per line, modulo 64

  void add(const Eigen::Vector3f& from_origin, const MapPoint& point) {
    offset += from_origin.cast<double>();
    square.add(from_origin);
    chord_square.add(point.chord_odom);
    ++count;
    lines |= uint64_t{1} << (point.line % 64);
  }
  Sums operator+(const Sums& o) const {
    return {offset + o.offset, square + o.square, chord_square + o.chord_square, count + o.count,
            lines | o.lines};
  }
};

struct CellSums {
  Eigen::Vector3f origin = Eigen::Vector3f::Zero();
  Eigen::Vector2d fourfold = Eigen::Vector2d::Zero();  // sum of |chord|^2 (cos 4a, sin 4a), a its heading
  Sums part[2];

  void add_heading(const Eigen::Vector3f& chord) {
    const double x = chord.x(), y = chord.y(), length2 = x * x + y * y;
    if (length2 < 1e-8) return;
    const double c2 = (x * x - y * y) / length2, s2 = 2 * x * y / length2;
    fourfold += length2 * Eigen::Vector2d(c2 * c2 - s2 * s2, 2 * c2 * s2);
  }
  Eigen::Vector2f axis() const {
    const double heading = 0.25 * std::atan2(fourfold.y(), fourfold.x());
    return {static_cast<float>(std::cos(heading)), static_cast<float>(std::sin(heading))};
  }
};

// What lies on one plane scatters by the noise of ranges, with what the variance of a sample of n scatters by (2 / n of its
// square), and by what planes err by beside noise; three sigma of either. A wall and the door leaves in it, 15 cm deeper,
// scatter by 6 cm: a bound that is a multiple of the noise takes them for one plane.
double max_plane_variance_m2(int point_count, double range_sigma_m, const PlaneMapConfig& config) {
  constexpr double kSigmas = 3;
  if (config.max_thickness_m) return *config.max_thickness_m * *config.max_thickness_m;
  const double uneven_m = kSigmas * config.plane_sigma_m;
  return range_sigma_m * range_sigma_m * (1 + kSigmas * std::sqrt(2.0 / point_count)) + uneven_m * uneven_m;
}

// The chords, whose ends are as noisy as the points, must lie in the plane too.
bool fit_plane(const Sums& sums, const Eigen::Vector3f& origin, double range_sigma_m,
               const PlaneMapConfig& config, Plane& plane) {
  if (sums.count < config.min_points || std::popcount(sums.lines) < config.min_lines) return false;
  const Vec3 mean = sums.offset / sums.count;
  const Patch patch(mean, sums.square.matrix() / sums.count, sums.count);
  const double max_variance = max_plane_variance_m2(sums.count, range_sigma_m, config);
  if (!(patch.spread_m2[0] <= max_variance) ||
      !patch.normal_is_known(config.max_normal_sigma_rad, range_sigma_m))
    return false;
  const Vec3& normal = patch.normal;
  if (normal.dot(sums.chord_square.matrix() * normal) > 2.0 * max_variance * sums.count) return false;
  const Vec3 center_odom = origin.cast<double>() + mean;
  const Eigen::Vector2d tilt = patch.normal_variance(range_sigma_m);
  plane.normal_odom = normal.cast<float>();
  plane.distance_m = static_cast<float>(normal.dot(center_odom));
  plane.center_odom = center_odom.cast<float>();
  const double whole_m2 = config.plane_sigma_m * config.plane_sigma_m;
  plane.center_variance_m2 = static_cast<float>(patch.thickness_m2(range_sigma_m) / sums.count + whole_m2);
  for (const int k : {0, 1}) {
    plane.axis_odom[k] = patch.axes.col(k + 1).cast<float>();
    plane.tilt_variance[k] = static_cast<float>(tilt[k] + whole_m2 / patch.spread_m2[k + 1]);
  }
  return true;
}

}  // namespace

void PlaneMap::rebuild(const std::deque<std::vector<MapPoint>>& keys_odom, double range_sigma_m) {
  constexpr double kTiltSigmas = 3;  // more would let the shortest chord, five times the noise, stand upright on a plane
  range_sigma_m_ = range_sigma_m;
  max_chord_tilt_m_ = static_cast<float>(
      config_.max_chord_tilt_m.value_or(kTiltSigmas * std::numbers::sqrt2 * range_sigma_m));
  planes_ = 0;
  std::vector<MapPoint> points;
  for (const auto& key : keys_odom) points.insert(points.end(), key.begin(), key.end());
  levels_.clear();
  double cell_m = config_.cell_m;
  for (int l = 0; l < config_.levels && !points.empty(); ++l, cell_m *= 0.5) {
    Level& level = levels_.emplace_back();
    level.inverse_cell = static_cast<float>(1.0 / cell_m);
    build_level(level, points);
  }
}

// Leaves in `points` those that the planes of this level do not explain.
void PlaneMap::build_level(Level& level, std::vector<MapPoint>& points) {
  level.index.reset(points.size() / 8);
  std::vector<CellSums> sums;
  std::vector<int> cell_of(points.size());
  for (size_t i = 0; i < points.size(); ++i) {
    cell_of[i] = level.index.insert(cube_of(points[i].point_odom, level.inverse_cell));
    if (sums.size() < level.index.size()) sums.emplace_back().origin = points[i].point_odom;
    sums[static_cast<size_t>(cell_of[i])].add_heading(points[i].chord_odom);
  }
  level.cells.resize(sums.size());
  for (size_t c = 0; c < sums.size(); ++c) level.cells[c].axis = sums[c].axis();
  for (size_t i = 0; i < points.size(); ++i) {
    const auto c = static_cast<size_t>(cell_of[i]);
    CellSums& cell = sums[c];
    cell.part[level.cells[c].chord_class(points[i].chord_odom)].add(points[i].point_odom - cell.origin,
                                                                    points[i]);
  }
  for (size_t c = 0; c < sums.size(); ++c) {
    Cell& cell = level.cells[c];
    const CellSums& s = sums[c];
    if (fit_plane(s.part[0] + s.part[1], s.origin, range_sigma_m_, config_, cell.plane[0])) {
      cell.plane[0].number = planes_++;
      cell.plane[1] = cell.plane[0];
      cell.planar[0] = cell.planar[1] = true;
      continue;
    }
    for (const int k : {0, 1}) {
      cell.planar[k] = fit_plane(s.part[k], s.origin, range_sigma_m_, config_, cell.plane[k]);
      if (cell.planar[k]) cell.plane[k].number = planes_++;
    }
  }
  size_t kept = 0;
  for (size_t i = 0; i < points.size(); ++i) {
    const auto c = static_cast<size_t>(cell_of[i]);
    const int k = level.cells[c].chord_class(points[i].chord_odom);
    if (!level.cells[c].planar[k] && sums[c].part[k].count >= config_.min_points) points[kept++] = points[i];
  }
  points.resize(kept);
}

const Plane* PlaneMap::find(const Eigen::Vector3f& point_odom, const Eigen::Vector3f& chord_odom) const {
  for (const Level& level : levels_) {
    const int number = level.index.find(cube_of(point_odom, level.inverse_cell));
    if (number < 0) return nullptr;
    const Cell& cell = level.cells[static_cast<size_t>(number)];
    const int k = cell.chord_class(chord_odom);
    if (!cell.planar[k]) continue;
    const bool same_surface = std::abs(cell.plane[k].normal_odom.dot(chord_odom)) <= max_chord_tilt_m_;
    return same_surface ? &cell.plane[k] : nullptr;
  }
  return nullptr;
}

}  // namespace vsslam

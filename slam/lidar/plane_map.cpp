#include "slam/lidar/plane_map.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <bit>
#include <cmath>

namespace vsslam {

void PlaneMapConfig::fields(Fields& f) {
  f("cell_m", cell_m, positive());
  f("levels", levels, between(1, 8));
  f("min_points", min_points, between(3, 1e6));
  f("min_lines", min_lines, between(1, 64));
  f("max_thickness_m", max_thickness_m, positive());
  f("max_normal_sigma_rad", max_normal_sigma_rad, positive());
  f("range_sigma_m", range_sigma_m, positive());
}

namespace {

// Sums of the points of a cell about its first point.
struct Moments {
  Vec3 origin = Vec3::Zero();
  Vec3 sum = Vec3::Zero();
  double xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0;
  int count = 0;
  uint64_t lines = 0;  // one bit per line, modulo 64

  void add(const MapPoint& sample) {
    const Eigen::Vector3f& point = sample.point_odom;
    lines |= uint64_t{1} << (sample.line % 64);
    if (count++ == 0) origin = point.cast<double>();
    const Vec3 d = point.cast<double>() - origin;
    sum += d;
    xx += d.x() * d.x(), xy += d.x() * d.y(), xz += d.x() * d.z();
    yy += d.y() * d.y(), yz += d.y() * d.z(), zz += d.z() * d.z();
  }
  Mat3 covariance() const {
    const Vec3 mean = sum / count;
    Mat3 c;
    c << xx, xy, xz, xy, yy, yz, xz, yz, zz;
    return c / count - mean * mean.transpose();
  }
  Vec3 centroid() const { return origin + sum / count; }
};

// The standard deviation of the normal is sigma / sqrt(count * spread along the shorter side).
bool fit_plane(const Moments& cell, const PlaneMapConfig& config, Plane& plane) {
  if (cell.count < config.min_points || std::popcount(cell.lines) < config.min_lines) return false;
  Eigen::SelfAdjointEigenSolver<Mat3> solver;
  solver.computeDirect(cell.covariance());
  const Vec3 spread = solver.eigenvalues();
  if (!(spread[0] <= config.max_thickness_m * config.max_thickness_m)) return false;
  const double variance = std::max(spread[0], config.range_sigma_m * config.range_sigma_m);
  if (variance > config.max_normal_sigma_rad * config.max_normal_sigma_rad * cell.count * spread[1])
    return false;
  const Vec3 normal = solver.eigenvectors().col(0).normalized();
  plane = {normal.cast<float>(), static_cast<float>(normal.dot(cell.centroid()))};
  return true;
}

}  // namespace

void PlaneMap::rebuild(const std::deque<std::vector<MapPoint>>& keys_odom) {
  levels_.clear();
  std::vector<MapPoint> points;
  for (const auto& key : keys_odom) points.insert(points.end(), key.begin(), key.end());
  double cell_m = config_.cell_m;
  std::vector<int> cell_of;
  for (int l = 0; l < config_.levels && !points.empty(); ++l, cell_m *= 0.5) {
    Level& level = levels_.emplace_back();
    level.inverse_cell = static_cast<float>(1.0 / cell_m);
    level.index.reset(points.size() / 8);
    std::vector<Moments> cells;
    cell_of.resize(points.size());
    for (size_t i = 0; i < points.size(); ++i) {
      const int cell = cell_of[i] = level.index.insert(voxel_key(points[i].point_odom, level.inverse_cell));
      if (cells.size() < level.index.size()) cells.emplace_back();
      cells[static_cast<size_t>(cell)].add(points[i]);
    }
    level.planes.resize(cells.size());
    level.planar.resize(cells.size());
    for (size_t c = 0; c < cells.size(); ++c) level.planar[c] = fit_plane(cells[c], config_, level.planes[c]);
    size_t kept = 0;  // what one plane does not explain goes to the next level
    for (size_t i = 0; i < points.size(); ++i) {
      const auto c = static_cast<size_t>(cell_of[i]);
      if (!level.planar[c] && cells[c].count >= config_.min_points) points[kept++] = points[i];
    }
    points.resize(kept);
  }
}

const Plane* PlaneMap::find(const Eigen::Vector3f& point_odom) const {
  for (const Level& level : levels_) {
    const int cell = level.index.find(voxel_key(point_odom, level.inverse_cell));
    if (cell < 0) return nullptr;
    if (level.planar[static_cast<size_t>(cell)]) return &level.planes[static_cast<size_t>(cell)];
  }
  return nullptr;
}

size_t PlaneMap::plane_count() const {
  size_t count = 0;
  for (const Level& level : levels_)
    count += static_cast<size_t>(std::count(level.planar.begin(), level.planar.end(), 1));
  return count;
}

}  // namespace vsslam

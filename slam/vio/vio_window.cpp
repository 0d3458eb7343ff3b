#include "slam/vio/vio_window.h"

#include <algorithm>

#include "slam/vio/reprojection_factor.h"

namespace vsslam {

namespace {

constexpr double kFocal_px = 460;
// A depth counts as found when 1 / z is known to this; its prior meaning is a baseline of a few centimetres.
constexpr double kInverseDepthSigma_1pm = 0.1;
constexpr double kNearest_1pm = 10, kBehind_1pm = -0.05;  // outside of these a depth is wrong

// Least squares of one unknown rho: rows a + rho b = 0.
struct Line {
  double ab = 0, bb = 0;
  void add(double a, double b, double weight) {
    ab += weight * weight * a * b;
    bb += weight * weight * b * b;
  }
};

std::optional<double> lidar_inverse_depth(const VioWindow& window, const WindowFeature& feature,
                                          const SE3& T_imu_camera) {
  const Sighting& anchor = feature.seen.front();
  for (const Sighting& sighting : feature.seen) {
    if (sighting.depth_m <= 0) continue;
    if (sighting.frame == anchor.frame) return 1.0 / sighting.depth_m;
    // rho d = y_z, with y = m + rho t
    const SE3 T_j_i = (window.T_vio_imu(sighting.frame) * T_imu_camera).inverse() *
                      (window.T_vio_imu(anchor.frame) * T_imu_camera);
    const Vec3 m = T_j_i.rotation * anchor.ray_camera.homogeneous();
    const double rho = m.z() / (sighting.depth_m - T_j_i.translation.z());
    if (rho > 0 && rho < kNearest_1pm) return rho;
  }
  return std::nullopt;
}

std::optional<double> triangulated(const VioWindow& window, const WindowFeature& feature,
                                   const SE3& T_imu_camera, double weight) {
  const Sighting& anchor = feature.seen.front();
  const SE3 T_vio_anchor = window.T_vio_imu(anchor.frame) * T_imu_camera;
  Line line;
  for (size_t k = 1; k < feature.seen.size(); ++k) {
    const Sighting& s = feature.seen[k];
    const SE3 T_j_i = (window.T_vio_imu(s.frame) * T_imu_camera).inverse() * T_vio_anchor;
    const Vec3 m = T_j_i.rotation * anchor.ray_camera.homogeneous(), &t = T_j_i.translation;
    for (int axis = 0; axis < 2; ++axis)
      line.add(m[axis] - s.ray_camera[axis] * m.z(), t[axis] - s.ray_camera[axis] * t.z(), weight);
  }
  if (line.bb * kInverseDepthSigma_1pm * kInverseDepthSigma_1pm < 1.0) return std::nullopt;
  const double rho = -line.ab / line.bb;
  if (rho < 2 * kBehind_1pm || rho > kNearest_1pm) return std::nullopt;
  return std::max(rho, 1e-3);
}

}  // namespace

size_t VioWindow::index_of(int64_t frame) const {
  const auto it = std::lower_bound(frames.begin(), frames.end(), frame,
                                   [](const WindowFrame& f, int64_t id) { return f.id < id; });
  return static_cast<size_t>(it - frames.begin());
}

void VioWindow::append(WindowFrame frame, const VisualFrame& seen) {
  for (const VisualFeature& feature : seen.features)
    features[feature.id].seen.push_back({frame.id, feature.ray_camera, feature.depth_m});
  frames.push_back(std::move(frame));
}

std::optional<InversePoint> VioWindow::point_in(int64_t frame, const WindowFeature& feature,
                                                const SE3& T_imu_camera) const {
  const Vec3 y = scaled_point_camera(T_vio_imu(feature.seen.front().frame), T_vio_imu(frame), T_imu_camera,
                                     *feature.point);
  if (y.z() < 0.05) return std::nullopt;
  return InversePoint(y.x(), y.y(), feature.point->z()) / y.z();
}

void VioWindow::forget_sightings(int64_t frame, const SE3& T_imu_camera) {
  for (auto it = features.begin(); it != features.end();) {
    WindowFeature& feature = it->second;
    auto sighting = std::find_if(feature.seen.begin(), feature.seen.end(),
                                 [&](const Sighting& s) { return s.frame == frame; });
    if (sighting == feature.seen.begin() && feature.seen.size() > 1 && feature.point)
      feature.point = point_in(feature.seen[1].frame, feature, T_imu_camera);
    if (sighting != feature.seen.end()) feature.seen.erase(sighting);
    it = feature.seen.empty() ? features.erase(it) : std::next(it);
  }
}

NewestView view_newest(const VioWindow& window, const SE3& T_imu_camera) {
  NewestView view;
  if (window.frames.size() < 2) return view;
  const WindowFrame &newest = window.frames.back(), &last = window.frames[window.frames.size() - 2];
  const Quat q_newest_last = (newest.state.T_vio_imu.rotation * T_imu_camera.rotation).conjugate() *
                             (last.state.T_vio_imu.rotation * T_imu_camera.rotation);
  int both = 0;
  for (const auto& [id, feature] : window.features) {
    if (feature.seen.size() < 2 || feature.seen.back().frame != newest.id) continue;
    ++view.tracks;
    const Sighting& before = feature.seen[feature.seen.size() - 2];
    if (before.frame != last.id) continue;
    const Vec3 turned = q_newest_last * before.ray_camera.homogeneous();
    if (turned.z() < 0.1) continue;
    view.parallax_px += kFocal_px * (turned.hnormalized() - feature.seen.back().ray_camera).norm();
    ++both;
  }
  if (both > 0) view.parallax_px /= both;
  return view;
}

void triangulate(VioWindow& window, const SE3& T_imu_camera, const VioConfig& config) {
  const double weight = kFocal_px / config.feature_sigma_px;
  for (auto& [id, feature] : window.features) {
    if (feature.point || feature.seen.empty()) continue;
    std::optional<double> rho = lidar_inverse_depth(window, feature, T_imu_camera);
    if (!rho && feature.seen.size() >= 2) rho = triangulated(window, feature, T_imu_camera, weight);
    const Vec2& ray = feature.seen.front().ray_camera;
    if (rho) feature.point = InversePoint(ray.x(), ray.y(), *rho);
  }
}

double mean_error_px(const VioWindow& window, const WindowFeature& feature, const SE3& T_imu_camera) {
  const Sighting& anchor = feature.seen.front();
  double sum_px = kFocal_px * (feature.point->head<2>() - anchor.ray_camera).norm();
  for (size_t k = 1; k < feature.seen.size(); ++k) {
    const std::optional<InversePoint> point = window.point_in(feature.seen[k].frame, feature, T_imu_camera);
    sum_px += kFocal_px * (point ? (point->head<2>() - feature.seen[k].ray_camera).norm() : 1.0);
  }
  return feature.seen.size() < 2 ? 0 : sum_px / static_cast<double>(feature.seen.size() - 1);
}

int remove_outliers(VioWindow& window, const SE3& T_imu_camera, double limit_px) {
  int removed = 0;
  for (auto it = window.features.begin(); it != window.features.end();) {
    const WindowFeature& feature = it->second;
    const bool wrong =
        feature.point && (feature.point->z() < kBehind_1pm || feature.point->z() > kNearest_1pm ||
                          !(mean_error_px(window, feature, T_imu_camera) < limit_px));
    removed += wrong;
    it = wrong ? window.features.erase(it) : std::next(it);
  }
  return removed;
}

}  // namespace vsslam

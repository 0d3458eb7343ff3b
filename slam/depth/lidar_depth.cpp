#include "slam/depth/lidar_depth.h"

#include <cmath>
#include <deque>
#include <limits>
#include <numbers>

#include "slam/vision/camera_model.h"

namespace vsslam {

void LidarDepthConfig::fields(Fields& f) {
  f("max_age_s", max_age_s, positive());
  f("max_range_m", max_range_m, positive());
  f("key_distance_m", key_distance_m, positive());
  f("key_angle_deg", key_angle_deg, positive());
  f("max_points", max_points, at_least(1000));
  f("view", view);
}

namespace {

double radians(double degrees) {
  return degrees * std::numbers::pi / 180;
}

// What the camera sees, in x / z and y / z, and a little beyond, so that features at the edge have neighbours.
Eigen::Vector2f view_extent(const CameraCalibration& calibration, double margin_rad) {
  const CameraModel camera(calibration);
  const double w = calibration.width_px - 1, h = calibration.height_px - 1;
  Vec2 extent(0.1, 0.1);
  for (const Vec2& pixel : {Vec2(0, 0), Vec2(w, 0), Vec2(0, h), Vec2(w, h), Vec2(w / 2, 0), Vec2(w / 2, h),
                            Vec2(0, h / 2), Vec2(w, h / 2)})
    if (const auto ray = camera.ray_camera(pixel)) extent = extent.cwiseMax(ray->cwiseAbs());
  const auto widened = [&](double tangent) {
    return static_cast<float>(std::tan(std::min(std::atan(tangent) + margin_rad, radians(80))));
  };
  return {widened(extent.x()), widened(extent.y())};
}

// One scan's points in the wider view of the camera, the nearest per bin of direction. Bins of the stereographic
// projection x / (z + range), which hardly stretches towards the side.
class ScanThinning {
 public:
  ScanThinning(const Eigen::Vector2f& extent, double bin_deg)
      : half_(std::tan(std::atan(extent.x()) / 2), std::tan(std::atan(extent.y()) / 2)),
        bins_per_unit_(static_cast<float>(2 / radians(bin_deg))),
        columns_(static_cast<int>(2 * half_.x() * bins_per_unit_) + 1),
        rows_(static_cast<int>(2 * half_.y() * bins_per_unit_) + 1) {}

  Cloud thin(const Cloud& points_lidar, const SE3& T_camera_lidar, float max_range_m) {
    const Eigen::Matrix3f R = T_camera_lidar.matrix3().cast<float>();
    const Eigen::Vector3f t = T_camera_lidar.translation.cast<float>();
    nearest_.assign(static_cast<size_t>(columns_ * rows_), {-1, 0});
    Cloud kept_camera;
    for (const Eigen::Vector3f& point_lidar : points_lidar) {
      const Eigen::Vector3f p = R * point_lidar + t;
      const float range2 = p.squaredNorm();
      if (!(p.z() > 0.1f && range2 < max_range_m * max_range_m)) continue;
      const float scale = bins_per_unit_ / (p.z() + std::sqrt(range2));
      const float column = p.x() * scale + half_.x() * bins_per_unit_,
                  row = p.y() * scale + half_.y() * bins_per_unit_;
      if (!(column >= 0 && row >= 0 && column < static_cast<float>(columns_) &&
            row < static_cast<float>(rows_)))
        continue;
      Nearest& bin =
          nearest_[static_cast<size_t>(static_cast<int>(row) * columns_ + static_cast<int>(column))];
      if (bin.index < 0) {
        bin = {static_cast<int>(kept_camera.size()), range2};
        kept_camera.push_back(p);
      } else if (range2 < bin.range2) {
        bin.range2 = range2;
        kept_camera[static_cast<size_t>(bin.index)] = p;
      }
    }
    return kept_camera;
  }

 private:
  struct Nearest {
    int index;
    float range2;
  };
  Eigen::Vector2f half_;
  float bins_per_unit_;
  int columns_, rows_;
  std::vector<Nearest> nearest_;
};

}  // namespace

struct LidarDepth::Impl {
  struct Scan {
    Time stamp;
    SE3 T_odom_camera;
    Cloud points_odom;
  };
  LidarDepthConfig config;
  SE3 T_base_camera, T_camera_lidar;
  Eigen::Vector2f extent;
  ScanThinning thinning;
  std::deque<Scan> scans;  // in order of time; apart from each other, but for the newest
  size_t points = 0;

  // Scans are kept for a view 30 deg wider than the camera's: it turns while they are remembered.
  Impl(const LidarDepthConfig& c, const RigCalibration& rig)
      : config(c),
        T_base_camera(rig.camera.T_base_camera),
        T_camera_lidar(rig.camera.T_base_camera.inverse() * rig.lidar.T_base_lidar),
        extent(view_extent(rig.camera, radians(c.view.search_deg))),
        thinning(view_extent(rig.camera, radians(30)), c.view.bin_deg) {}

  void add(Time stamp, const Cloud& points_lidar, const SE3& T_odom_base) {
    Scan scan{stamp, T_odom_base * T_base_camera, {}};
    const Eigen::Matrix3d R = scan.T_odom_camera.matrix3();
    scan.points_odom = thinning.thin(points_lidar, T_camera_lidar, static_cast<float>(config.max_range_m));
    for (Eigen::Vector3f& p : scan.points_odom)
      p = (R * p.cast<double>() + scan.T_odom_camera.translation).cast<float>();
    if (scans.size() >= 2 && near(scans.back().T_odom_camera, scans[scans.size() - 2].T_odom_camera))
      forget_newest();
    points += scan.points_odom.size();
    scans.push_back(std::move(scan));
    while (seconds_between(scans.front().stamp, stamp) > config.max_age_s) forget_oldest();
    while (points > static_cast<size_t>(config.max_points) && scans.size() > 1) forget_oldest();
  }

  bool near(const SE3& T_odom_a, const SE3& T_odom_b) const {
    const SE3 T_a_b = T_odom_a.inverse() * T_odom_b;
    return T_a_b.translation.norm() < config.key_distance_m && T_a_b.angle() < radians(config.key_angle_deg);
  }
  void forget_newest() {
    points -= scans.back().points_odom.size();
    scans.pop_back();
  }
  void forget_oldest() {
    points -= scans.front().points_odom.size();
    scans.pop_front();
  }

  DepthView view_from(const SE3& T_odom_camera, Time now) const {
    DepthView view(config.view, extent);
    const SE3 T_camera_odom = T_odom_camera.inverse();
    const Eigen::Matrix3f R = T_camera_odom.matrix3().cast<float>();
    const Eigen::Vector3f t = T_camera_odom.translation.cast<float>();
    for (const Scan& scan : scans)
      if (seconds_between(scan.stamp, now) <= config.max_age_s)
        for (const Eigen::Vector3f& p : scan.points_odom) view.add(R * p + t);
    return view;
  }
};

LidarDepth::LidarDepth(const LidarDepthConfig& config, const RigCalibration& rig)
    : impl_(std::make_unique<Impl>(config, rig)) {}
LidarDepth::~LidarDepth() = default;

void LidarDepth::add(Time stamp, const Cloud& points_lidar, const SE3& T_odom_base) {
  impl_->add(stamp, points_lidar, T_odom_base);
}

void LidarDepth::fill(VisualFrame& frame, const SE3& T_odom_camera) const {
  const DepthView view = impl_->view_from(T_odom_camera, frame.stamp);
  for (VisualFeature& feature : frame.features)
    feature.depth_m = view.depth_m(feature.ray_camera.cast<float>()).value_or(0);
}

size_t LidarDepth::points() const {
  return impl_->points;
}

}  // namespace vsslam

#include "slam/vio/motion_alignment.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace vsslam {

namespace {

using Mat3x6 = Eigen::Matrix<double, 3, 6>;
constexpr double kFocal_px = 460;

// Free of velocity and gravity, in the first IMU's frame.
struct FramePath {
  double t_s = 0;
  Mat3 R_first_imu = Mat3::Identity();
  Vec3 alpha = Vec3::Zero(), beta = Vec3::Zero();  // position and velocity
  Mat3 R_camera_first;
  Vec3 camera;  // alpha + lever arm
};

std::vector<FramePath> paths_of(const VioWindow& window, const SE3& T_imu_camera) {
  std::vector<FramePath> paths(window.frames.size());
  for (size_t k = 0; k < paths.size(); ++k) {
    FramePath& path = paths[k];
    if (k > 0) {
      const FramePath& before = paths[k - 1];
      const ImuPreintegration& motion = *window.frames[k].motion;
      path.t_s = before.t_s + motion.dt_s();
      path.R_first_imu = before.R_first_imu * motion.delta_R().toRotationMatrix();
      path.alpha = before.alpha + before.beta * motion.dt_s() + before.R_first_imu * motion.delta_p();
      path.beta = before.beta + before.R_first_imu * motion.delta_v();
    }
    path.R_camera_first = (path.R_first_imu * T_imu_camera.matrix3()).transpose();
    path.camera = path.alpha + path.R_first_imu * T_imu_camera.translation;
  }
  return paths;
}

// Normal equations of one feature: H_xx X + H_xs s = b_x with s = [v_0; g].
struct FeatureSystem {
  Mat3 H_xx = Mat3::Zero();
  Mat3x6 H_xs = Mat3x6::Zero();
  Mat6 H_ss = Mat6::Zero();
  Vec3 b_x = Vec3::Zero();
  Vec6 b_s = Vec6::Zero();

  // direction . (X - v t - 1/2 g t^2) = value
  void add(const Eigen::RowVector3d& direction, double t, double value) {
    Eigen::Matrix<double, 1, 6> in_s;
    in_s << -t * direction, -0.5 * t * t * direction;
    H_xx += direction.transpose() * direction;
    H_xs += direction.transpose() * in_s;
    H_ss += in_s.transpose() * in_s;
    b_x += direction.transpose() * value;
    b_s += in_s.transpose() * value;
  }
  Vec3 solve(const Vec6& s) const { return H_xx.ldlt().solve(b_x - H_xs * s); }
};

// `points` gives the depths by which errors in metres become errors on the image; without them 5 m are assumed.
FeatureSystem system_of(const VioWindow& window, const WindowFeature& feature,
                        const std::vector<FramePath>& paths, const VioModel& model, const Vec3* point_first,
                        const Vec6& s) {
  FeatureSystem system;
  const double weight = kFocal_px / model.config.feature_sigma_px;
  for (const Sighting& seen : feature.seen) {
    const FramePath& path = paths[window.index_of(seen.frame)];
    const double t = path.t_s;
    double z = seen.depth_m > 0 ? seen.depth_m : 5.0;
    if (point_first) {
      const Vec3 camera = path.camera + t * s.head<3>() + 0.5 * t * t * s.tail<3>();
      z = std::max(0.3, path.R_camera_first.row(2).dot(*point_first - camera));
    }
    for (int axis = 0; axis < 2; ++axis) {
      const Eigen::RowVector3d direction =
          weight / z * (path.R_camera_first.row(axis) - seen.ray_camera[axis] * path.R_camera_first.row(2));
      system.add(direction, t, direction.dot(path.camera));
    }
    if (seen.depth_m <= 0) continue;
    const double depth_weight = 1.0 / (model.config.depth_sigma_ratio * seen.depth_m);
    const Eigen::RowVector3d direction = depth_weight * path.R_camera_first.row(2);
    system.add(direction, t, direction.dot(path.camera) + depth_weight * seen.depth_m);
  }
  return system;
}

// |g| is known: g = g_0 + B w with B tangent to the sphere, a few rounds.
std::optional<Vec6> solve_with_gravity(const Mat6& H, const Vec6& b, double gravity_mps2,
                                       double* speed_sigma) {
  const Vec6 free = H.ldlt().solve(b);
  Vec3 g = free.tail<3>();
  if (!free.allFinite() || g.norm() < 1e-3) return std::nullopt;
  Vec6 s;
  for (int round = 0; round < 6; ++round) {
    g *= gravity_mps2 / g.norm();
    Vec3 across = g.cross(std::abs(g.x()) < 0.5 * gravity_mps2 ? Vec3::UnitX() : Vec3::UnitY()).normalized();
    Eigen::Matrix<double, 6, 5> to_s = Eigen::Matrix<double, 6, 5>::Zero();
    to_s.topLeftCorner<3, 3>().setIdentity();
    to_s.block<3, 1>(3, 3) = across;
    to_s.block<3, 1>(3, 4) = g.normalized().cross(across);
    Vec6 fixed = Vec6::Zero();
    fixed.tail<3>() = g;
    const Eigen::Matrix<double, 5, 5> H5 = to_s.transpose() * H * to_s;
    s = fixed + to_s * H5.ldlt().solve(to_s.transpose() * (b - H * fixed));
    g = s.tail<3>();
    *speed_sigma = std::sqrt(H5.inverse().topLeftCorner<3, 3>().trace());
  }
  s.tail<3>() = g * (gravity_mps2 / g.norm());
  if (!s.allFinite()) return std::nullopt;
  return s;
}

// The window with what was found, turned so that gravity points down.
VioWindow with_states(const VioWindow& window, const std::vector<FramePath>& paths, const Vec6& s) {
  VioWindow out = window;
  const Quat q_vio_first = Quat::FromTwoVectors(-s.tail<3>(), Vec3::UnitZ());
  for (size_t k = 0; k < paths.size(); ++k) {
    const FramePath& path = paths[k];
    const double t = path.t_s;
    VioState& state = out.frames[k].state;
    state.T_vio_imu = SE3(q_vio_first * Quat(path.R_first_imu),
                          q_vio_first * (path.alpha + t * s.head<3>() + 0.5 * t * t * s.tail<3>()));
    state.v_vio_mps = q_vio_first * (path.beta + s.head<3>() + t * s.tail<3>());
    state.bias = {};
  }
  for (auto& [id, feature] : out.features) feature.point.reset();
  return out;
}

}  // namespace

std::optional<VioWindow> align_motion(const VioWindow& window, const VioModel& model) {
  const std::vector<FramePath> paths = paths_of(window, model.T_imu_camera);
  std::map<int64_t, Vec3> points_first;
  Vec6 s = Vec6::Zero();
  double speed_sigma = 0;
  for (int round = 0; round < 4; ++round) {
    Mat6 H = Mat6::Zero();
    Vec6 b = Vec6::Zero();
    std::map<int64_t, FeatureSystem> systems;
    for (const auto& [id, feature] : window.features) {
      if (feature.seen.size() < 3) continue;
      const auto point = points_first.find(id);
      const Vec3* known = point == points_first.end() ? nullptr : &point->second;
      const FeatureSystem system = system_of(window, feature, paths, model, known, s);
      if (system.H_xx.ldlt().rcond() < 1e-10) continue;  // one ray only
      const Mat3x6 gain = system.H_xx.ldlt().solve(system.H_xs);
      H += system.H_ss - system.H_xs.transpose() * gain;
      b += system.b_s - gain.transpose() * system.b_x;
      systems[id] = system;
    }
    if (systems.size() < 10) return std::nullopt;
    const auto solution = solve_with_gravity(H, b, model.imu.gravity_mps2, &speed_sigma);
    if (!solution) return std::nullopt;
    s = *solution;
    for (const auto& [id, system] : systems) points_first[id] = system.solve(s);
  }
  // Without acceleration the scale is free: what is found means nothing.
  const double limit = 2 * model.config.start.motion_velocity_sigma;
  if (!(speed_sigma < limit * std::max(0.2, s.head<3>().norm()))) return std::nullopt;
  return with_states(window, paths, s);
}

}  // namespace vsslam

#include "slam/lidar/registration.h"

#include <cmath>
#include <numbers>

namespace vsslam {

void RegistrationConfig::fields(Fields& f) {
  f("max_iterations", max_iterations, between(1, 1000));
  f("min_correspondences", min_correspondences, between(6, 1e6));
  f("max_distance_m", max_distance_m, positive());
  f("final_distance_m", final_distance_m, positive());
  f("robust_scale_m", robust_scale_m, positive());
  f("converged_rotation_deg", converged_rotation_deg, positive());
  f("converged_translation_m", converged_translation_m, positive());
}

namespace {

// Normal equations of one iteration: A x = b weighted, H unweighted.
struct Linearised {
  Mat6 A = Mat6::Zero(), H = Mat6::Zero();
  Vec6 b = Vec6::Zero();
  int correspondences = 0;
};

// r_i = n . (T Exp(x) p) - d, dr/dx = [p x (R^T n); R^T n] (sensor-centred right perturbation).
Linearised linearise(const std::vector<Feature>& features, const SE3& T_odom_lidar, const PlaneMap& map,
                     double max_distance_m, double robust_scale_m) {
  Linearised sums;
  const Eigen::Matrix3f R = T_odom_lidar.matrix3().cast<float>();
  const Mat3 R_lidar_odom = T_odom_lidar.matrix3().transpose();
  const Eigen::Vector3f t = T_odom_lidar.translation.cast<float>();
  for (const Feature& feature : features) {
    const Eigen::Vector3f point_odom = R * feature.point_lidar + t;
    const Eigen::Vector3f chord_odom = R * feature.chord_lidar;
    const Plane* plane = map.find(point_odom, chord_odom);
    if (!plane) continue;
    const double r = plane->normal_odom.dot(point_odom) - plane->distance_m;
    if (std::abs(r) > max_distance_m) continue;
    const Vec6 row = point_to_plane_row(feature.point_lidar.cast<double>(),
                                        R_lidar_odom * plane->normal_odom.cast<double>());
    const double w = 1.0 / (1.0 + r * r / (robust_scale_m * robust_scale_m));
    sums.H.selfadjointView<Eigen::Lower>().rankUpdate(row);
    sums.A.selfadjointView<Eigen::Lower>().rankUpdate(row, w);
    sums.b -= w * r * row;
    ++sums.correspondences;
  }
  sums.H.triangularView<Eigen::StrictlyUpper>() = sums.H.transpose();
  sums.A.triangularView<Eigen::StrictlyUpper>() = sums.A.transpose();
  return sums;
}

}  // namespace

Registration register_scan(const std::vector<Feature>& features, const SE3& T_odom_lidar_prior,
                           const PlaneMap& map, const RegistrationConfig& config,
                           const DegeneracyConfig& degeneracy) {
  Registration result;
  result.T_odom_lidar = T_odom_lidar_prior;
  const double converged_rotation_rad = config.converged_rotation_deg * std::numbers::pi / 180.0;
  double gate_m = config.max_distance_m;
  while (result.iterations < config.max_iterations && !result.converged) {
    const Linearised sums = linearise(features, result.T_odom_lidar, map, gate_m, config.robust_scale_m);
    ++result.iterations;
    result.correspondences = sums.correspondences;
    result.information = analyse_information(sums.H);
    result.degeneracy = detect_degeneracy(sums.H, sums.correspondences, degeneracy);
    if (sums.correspondences < config.min_correspondences) {
      result.used_prior_only = true;
      result.T_odom_lidar = T_odom_lidar_prior;
      return result;
    }
    const Vec6 step = result.degeneracy.solve(sums.A, sums.b);
    result.T_odom_lidar = result.T_odom_lidar * SE3::exp(step);
    const bool small = step.head<3>().norm() < converged_rotation_rad &&
                       step.tail<3>().norm() < config.converged_translation_m;
    result.converged = small && gate_m <= config.final_distance_m;
    if (small || step.tail<3>().norm() < 0.1 * config.final_distance_m) gate_m = config.final_distance_m;
  }
  return result;
}

}  // namespace vsslam

#include "slam/lidar/registration.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace vsslam {

void RegistrationConfig::fields(Fields& f) {
  f.choice("weighting", weighting, {{"covariance", Weighting::covariance}, {"remapping", Weighting::remapping}});
  f("max_iterations", max_iterations, between(1, 1000));
  f("min_correspondences", min_correspondences, between(6, 1e6));
  f("max_distance_m", max_distance_m, positive());
  f.automatic("final_distance_m", final_distance_m, positive());
  f.automatic("robust_scale_m", robust_scale_m, positive());
  f("prior_sigmas", prior_sigmas, positive());
  f("beam_sigma_rad", beam_sigma_rad, non_negative());
  f("converged_rotation_deg", converged_rotation_deg, positive());
  f("converged_translation_m", converged_translation_m, positive());
}

namespace {

double final_distance_m(const RegistrationConfig& config, double range_sigma_m) {
  return config.final_distance_m.value_or(std::max(0.1, 5 * range_sigma_m));
}

struct Match {
  const Feature* feature;
  const Plane* plane;
  Eigen::Vector3f point_odom;
  double residual_m;  // n . (T p) - d
};

// The features with a plane at most `max_distance_m` away.
std::vector<Match> match(const std::vector<Feature>& features, const SE3& T_odom_lidar, const PlaneMap& map,
                         double max_distance_m) {
  std::vector<Match> matches;
  matches.reserve(features.size());
  const Eigen::Matrix3f R = T_odom_lidar.matrix3().cast<float>();
  const Eigen::Vector3f t = T_odom_lidar.translation.cast<float>();
  for (const Feature& feature : features) {
    const Eigen::Vector3f point_odom = R * feature.point_lidar + t;
    const Eigen::Vector3f chord_odom = R * feature.chord_lidar;
    const Plane* plane = map.find(point_odom, chord_odom);
    if (!plane) continue;
    const double r = plane->normal_odom.dot(point_odom) - plane->distance_m;
    if (std::abs(r) <= max_distance_m) matches.push_back({&feature, plane, point_odom, r});
  }
  return matches;
}

// How many of the matches share each plane.
std::vector<int> points_per_plane(const std::vector<Match>& matches, const PlaneMap& map) {
  std::vector<int> counts(map.plane_count(), 0);
  for (const Match& m : matches) ++counts[static_cast<size_t>(m.plane->number)];
  return counts;
}

// Normal equations of one iteration: A x = b weighted, H unweighted.
struct Linearised {
  Mat6 A = Mat6::Zero(), H = Mat6::Zero();
  Vec6 b = Vec6::Zero();
};

// The n points of a plane share its error, as do the k scans that meet it: the mean of all has the variance
// (noise^2 + n k plane^2) / (n k), so each weighs 1 / (noise^2 + n k plane^2).
class Weights {
 public:
  Weights(const std::vector<Match>& matches, const PlaneMap& map, const SE3& T_odom_lidar, const ScanNoise& noise,
          const RegistrationConfig& config)
      : counts_(points_per_plane(matches, map)),
        position_odom_(T_odom_lidar.translation.cast<float>()),
        noise_m2_(noise.range_sigma_m * noise.range_sigma_m),
        scans_(noise.scans_sharing_planes),
        beam_variance_(config.beam_sigma_rad * config.beam_sigma_rad) {
    const double scale_m = config.robust_scale_m.value_or(kRobustSigmas * noise.range_sigma_m);
    inverse_scale_m2_ = 1 / (scale_m * scale_m);
  }

  double of(const Match& m) const {
    const double sharing = scans_ * counts_[static_cast<size_t>(m.plane->number)];
    const double shared_m2 = static_cast<double>(m.plane->variance_m2(m.point_odom)) + beam_m2(m);
    return robust(m) / (noise_m2_ + sharing * shared_m2);
  }
  double robust(const Match& m) const { return 1 / (1 + m.residual_m * m.residual_m * inverse_scale_m2_); }

 private:
  static constexpr double kRobustSigmas = 4.3;

  // Across the beam, of which a plane feels r sin(incidence).
  double beam_m2(const Match& m) const {
    const Eigen::Vector3f ray_odom = m.point_odom - position_odom_;
    const float across = m.plane->normal_odom.dot(ray_odom);
    return beam_variance_ * static_cast<double>(ray_odom.squaredNorm() - across * across);
  }

  std::vector<int> counts_;
  Eigen::Vector3f position_odom_;
  double noise_m2_, scans_, beam_variance_, inverse_scale_m2_;
};

// r_i = n . (T Exp(x) p) - d, dr/dx = [p x (R^T n); R^T n] (sensor-centred right perturbation).
Linearised linearise(const std::vector<Match>& matches, const SE3& T_odom_lidar, const Weights& weights) {
  Linearised sums;
  const Mat3 R_lidar_odom = T_odom_lidar.matrix3().transpose();
  for (const Match& m : matches) {
    const Vec6 row = point_to_plane_row(m.feature->point_lidar.cast<double>(),
                                        R_lidar_odom * m.plane->normal_odom.cast<double>());
    const double w = weights.of(m);
    sums.H.selfadjointView<Eigen::Lower>().rankUpdate(row);
    sums.A.selfadjointView<Eigen::Lower>().rankUpdate(row, w);
    sums.b -= w * m.residual_m * row;
  }
  sums.H.triangularView<Eigen::StrictlyUpper>() = sums.H.transpose();
  sums.A.triangularView<Eigen::StrictlyUpper>() = sums.A.transpose();
  return sums;
}

// A normal that errs by e has the row J + G e and the residual r + e . u, u from the plane's center: on average J J' grows
// by G Cov(e) G', information that no surface gives, and J r by G Cov(e) u, which draws the scan to where its points meet the
// centers.
Linearised feigned(const std::vector<Match>& matches, const SE3& T_odom_lidar, const Weights& weights) {
  const Mat3 R_lidar_odom = T_odom_lidar.matrix3().transpose();
  Linearised sums;
  for (const Match& m : matches) {
    const double w = weights.of(m);
    for (const int k : {0, 1}) {
      const Vec6 row = point_to_plane_row(m.feature->point_lidar.cast<double>(),
                                          R_lidar_odom * m.plane->axis_odom[k].cast<double>());
      const double variance = m.plane->tilt_variance[k];
      const double u = m.plane->axis_odom[k].dot(m.point_odom - m.plane->center_odom);
      sums.H.selfadjointView<Eigen::Lower>().rankUpdate(row, variance);
      sums.A.selfadjointView<Eigen::Lower>().rankUpdate(row, variance * w);
      sums.b -= variance * w * u * row;
    }
  }
  sums.H.triangularView<Eigen::StrictlyUpper>() = sums.H.transpose();
  sums.A.triangularView<Eigen::StrictlyUpper>() = sums.A.transpose();
  return sums;
}

// Eigenvectors of a problem's information M, its eigenvalues, and which share of each is no feint.
struct Shares {
  Mat6 vectors;
  Vec6 values, share = Vec6::Zero();

  Shares(const Mat6& M, const Mat6& feigned) {
    const Eigen::SelfAdjointEigenSolver<Mat6> solver(M);
    vectors = solver.eigenvectors();
    values = solver.eigenvalues();
    for (int k = 0; k < 6; ++k)
      if (values[k] > 0)
        share[k] = std::max(0.0, 1 - vectors.col(k).dot(feigned * vectors.col(k)) / values[k]);
  }
  // P, so that P M P has the eigenvalues part_k M_k.
  Mat6 root(const Vec6& part) const {
    return vectors * part.cwiseMax(0.0).cwiseSqrt().asDiagonal() * vectors.transpose();
  }
};

// What of the rows to believe: where a share s is true, the best guess of a true row from the noisy one is s times it
// (Wiener).
Mat6 true_part(const Shares& shares) {
  return shares.root(shares.share.cwiseProduct(shares.share));
}

// What of the solution to believe, which the noise of rows draws away by s^-1 M^-1 draw (as errors in the regressor dilute
// any regression), on top of the variance 1 / (s^2 M_k) of the rows believed.
Mat6 undrawn_part(const Shares& shares, const Vec6& draw) {
  Vec6 part = Vec6::Zero();
  for (int k = 0; k < 6; ++k) {
    const double s = shares.share[k], information = shares.values[k];
    if (s <= 0) continue;
    const double drawn = shares.vectors.col(k).dot(draw) / (s * information);
    part[k] = 1 / (1 / (s * s) + information * drawn * drawn);
  }
  return shares.root(part);
}

// How many of the matches fit, softly.
double fitting(const std::vector<Match>& matches, const Weights& weights) {
  double sum = 0;
  for (const Match& m : matches) sum += weights.robust(m);
  return sum;
}

}  // namespace

Registration register_scan(const std::vector<Feature>& features, const PosePrior& prior, const SE3& start,
                           const PlaneMap& map, const ScanNoise& noise, const RegistrationConfig& config,
                           const DegeneracyConfig& degeneracy) {
  const double final_m = final_distance_m(config, noise.range_sigma_m);
  const double converged_rotation_rad = config.converged_rotation_deg * std::numbers::pi / 180.0;
  const bool weighed = config.weighting == RegistrationConfig::Weighting::covariance;
  const Mat6 prior_information = prior.covariance.ldlt().solve(Mat6::Identity());
  Registration result;
  result.T_odom_lidar = start;
  result.covariance = prior.covariance;
  double gate_m = std::max(config.max_distance_m, final_m);
  while (result.iterations < config.max_iterations && !result.converged) {
    const std::vector<Match> matches = match(features, result.T_odom_lidar, map, gate_m);
    ++result.iterations;
    result.correspondences = static_cast<int>(matches.size());
    if (result.correspondences < config.min_correspondences) {
      result.used_prior_only = true;
      result.cost = result.misfit = 1;
      result.T_odom_lidar = prior.T_odom_lidar;
      return result;
    }
    const Weights weights(matches, map, result.T_odom_lidar, noise, config);
    const Linearised sums = linearise(matches, result.T_odom_lidar, weights);
    const Linearised feint = feigned(matches, result.T_odom_lidar, weights);
    const Mat6 H_part = true_part({sums.H, feint.H}), A_part = undrawn_part({sums.A, feint.A}, feint.b);
    result.information = analyse_information(H_part * sums.H * H_part);
    result.degeneracy = detect_degeneracy(result.information.H, result.correspondences, degeneracy);
    result.scan_information = A_part * sums.A * A_part;
    const Vec6 from_prior = (prior.T_odom_lidar.inverse() * result.T_odom_lidar).log();
    const double surprise = from_prior.dot(prior_information * from_prior) / (6 * config.prior_sigmas * config.prior_sigmas);
    const Mat6 believed_prior = prior_information / (1 + surprise);
    const Mat6 together = result.scan_information + believed_prior;
    Vec6 step;
    if (weighed) {
      step = together.ldlt().solve(A_part * A_part * sums.b - believed_prior * from_prior);
    } else {
      step = detect_degeneracy(sums.H, result.correspondences, degeneracy).solve(sums.A, sums.b);
    }
    result.T_odom_lidar = result.T_odom_lidar * SE3::exp(step);
    const bool small = step.head<3>().norm() < converged_rotation_rad &&
                       step.tail<3>().norm() < config.converged_translation_m;
    result.converged = small && gate_m <= final_m;
    result.covariance = together.ldlt().solve(Mat6::Identity());
    const double fit = fitting(matches, weights);
    result.cost = 1 - fit / static_cast<double>(features.size());
    result.misfit = 1 - fit / static_cast<double>(matches.size());
    if (small || step.tail<3>().norm() < 0.1 * final_m) gate_m = final_m;
  }
  return result;
}

int count_matches(const std::vector<Feature>& features, const SE3& T_odom_lidar, const PlaneMap& map, double range_sigma_m,
                  const RegistrationConfig& config) {
  return static_cast<int>(match(features, T_odom_lidar, map, final_distance_m(config, range_sigma_m)).size());
}

Mat6 step_information(const std::vector<Feature>& features, const SE3& T_odom_lidar, const PlaneMap& map,
                      double range_sigma_m, double plane_share, const RegistrationConfig& config) {
  const double gate_m = final_distance_m(config, range_sigma_m);
  const std::vector<Match> matches = match(features, T_odom_lidar, map, gate_m);
  const Weights weights(matches, map, T_odom_lidar, {range_sigma_m, plane_share}, config);
  const Linearised sums = linearise(matches, T_odom_lidar, weights);
  const Linearised feint = feigned(matches, T_odom_lidar, weights);
  const Mat6 part = undrawn_part({sums.A, feint.A}, feint.b);
  return part * sums.A * part;
}

}  // namespace vsslam

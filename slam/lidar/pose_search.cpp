#include "slam/lidar/pose_search.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace vsslam {

void PoseSearchConfig::fields(Fields& f) {
  f("reach_m", reach_m, positive());
  f("features", features, between(50, 1e6));
  f("finalists", finalists, between(1, 1000));
  f("clearly_better", clearly_better, between(0, 1));
  f("max_m", max_m, positive());
  f("max_rad", max_rad, positive());
}

namespace {

constexpr double kSigmas = 3;
constexpr size_t kHeard = 1000;  // poses: so many of the best by a quarter of the judges hold the best by all

double position_sigma_m(const PosePrior& prior) {
  return std::sqrt(prior.covariance.bottomRightCorner<3, 3>().diagonal().maxCoeff());
}
double rotation_sigma_rad(const PosePrior& prior) {
  return std::sqrt(prior.covariance.topLeftCorner<3, 3>().diagonal().maxCoeff());
}

std::vector<Feature> every_nth(const std::vector<Feature>& features, int wanted) {
  const size_t stride = std::max<size_t>(1, features.size() / static_cast<size_t>(wanted));
  std::vector<Feature> some;
  for (size_t i = 0; i < features.size(); i += stride) some.push_back(features[i]);
  return some;
}

// Share of the features that lie on a plane of the map, softly.
double fit(const std::vector<Feature>& features, const SE3& T_odom_lidar, const PlaneMap& map, double scale_m) {
  const Eigen::Matrix3f R = T_odom_lidar.matrix3().cast<float>();
  const Eigen::Vector3f t = T_odom_lidar.translation.cast<float>();
  const auto inverse2 = static_cast<float>(1 / (scale_m * scale_m));
  double sum = 0;
  for (const Feature& feature : features) {
    const Eigen::Vector3f point_odom = R * feature.point_lidar + t;
    const Plane* plane = map.find(point_odom, R * feature.chord_lidar);
    if (!plane) continue;
    const float r = plane->normal_odom.dot(point_odom) - plane->distance_m;
    sum += 1 / (1 + r * r * inverse2);
  }
  return sum / static_cast<double>(std::max<size_t>(1, features.size()));
}

struct Candidate {
  double fit = 0;
  double x_m = 0, y_m = 0, yaw_rad = 0;
};

}  // namespace

bool needs_search(const PosePrior& prior, double range_m, const PoseSearchConfig& config) {
  return kSigmas * (position_sigma_m(prior) + range_m * rotation_sigma_rad(prior)) > config.reach_m;
}

std::vector<SE3> likely_poses(const std::vector<Feature>& features, const PosePrior& prior, double range_m,
                              const PlaneMap& map, double range_sigma_m, const PoseSearchConfig& config) {
  // A quarter of the judges chooses whom all of them look at.
  const std::vector<Feature> judges = every_nth(features, config.features), few = every_nth(judges, config.features / 4);
  const double step_m = config.reach_m, step_rad = config.reach_m / range_m;
  const double scale_m = std::max(4.3 * range_sigma_m, 0.5 * step_m);
  const auto steps_of = [](double sigma, double most, double step) {
    return static_cast<int>(std::ceil(std::min(most, kSigmas * sigma) / step - 1));  // registration bridges one
  };
  // The ellipse of the prior: along a corridor it is long and narrow.
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> ellipse(prior.covariance.block<2, 2>(3, 3));
  const Eigen::Vector2d sigma_m = ellipse.eigenvalues().cwiseMax(0.0).cwiseSqrt();
  const int along = steps_of(sigma_m[1], config.max_m, step_m), aside = steps_of(sigma_m[0], config.max_m, step_m);
  const int turns = steps_of(std::sqrt(prior.covariance(2, 2)), config.max_rad, step_rad);
  const auto pose = [&](const Candidate& c) {
    return prior.T_odom_lidar * SE3::from_rpy({0, 0, c.yaw_rad}, {c.x_m, c.y_m, 0});
  };
  const auto judge = [&](Candidate& c, const std::vector<Feature>& by) { c.fit = fit(by, pose(c), map, scale_m); };
  const auto better = [](const Candidate& a, const Candidate& b) { return a.fit > b.fit; };
  std::vector<Candidate> candidates;
  for (int yaw = -turns; yaw <= turns; ++yaw)
    for (int a = -along; a <= along; ++a)
      for (int b = -aside; b <= aside; ++b) {
        const Eigen::Vector2d place_m =
            ellipse.eigenvectors() * Eigen::Vector2d(b * step_m, a * step_m);
        Candidate c{0, place_m.x(), place_m.y(), yaw * step_rad};
        judge(c, few);
        candidates.push_back(c);
      }
  std::stable_sort(candidates.begin(), candidates.end(), better);
  candidates.resize(std::min(candidates.size(), kHeard));
  Candidate standing;
  judge(standing, judges);
  for (Candidate& c : candidates) judge(c, judges);
  std::erase_if(candidates, [&](const Candidate& c) { return c.fit <= standing.fit + 0.5 * config.clearly_better; });
  std::stable_sort(candidates.begin(), candidates.end(), better);
  std::vector<Candidate> chosen;
  for (const Candidate& c : candidates) {
    if (chosen.size() == static_cast<size_t>(config.finalists)) break;
    const bool near = std::any_of(chosen.begin(), chosen.end(), [&](const Candidate& other) {
      return std::hypot(c.x_m - other.x_m, c.y_m - other.y_m) < 1.5 * step_m &&
             std::abs(c.yaw_rad - other.yaw_rad) < 1.5 * step_rad;
    });
    if (!near) chosen.push_back(c);
  }
  std::vector<SE3> poses;
  for (const Candidate& c : chosen) poses.push_back(pose(c));
  return poses;
}

}  // namespace vsslam

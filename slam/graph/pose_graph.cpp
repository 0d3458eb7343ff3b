#include "slam/graph/pose_graph.h"

#include <Eigen/Cholesky>
#include <stdexcept>

namespace vsslam {

void PoseGraphConfig::fields(Fields& f) {
  f.automatic("odometry_rotation_variance_rad2", odometry_rotation_variance_rad2, positive());
  f.automatic("odometry_translation_variance_m2", odometry_translation_variance_m2, positive());
  f("loop_rotation_variance_rad2", loop_rotation_variance_rad2, positive());
  f("loop_translation_variance_m2", loop_translation_variance_m2, positive());
  f("max_iterations", max_iterations, between(1, 10000));
  f("cost_tolerance", cost_tolerance, between(0, 0.1));
}

Vec6 PoseGraphConfig::loop_variances() const {
  Vec6 variances;
  variances << Vec3::Constant(loop_rotation_variance_rad2), Vec3::Constant(loop_translation_variance_m2);
  return variances;
}

// A block that is set stands alone.
Mat6 PoseGraphConfig::odometry_information(const Mat6& covariance) const {
  Mat6 used = covariance;
  const auto set = [&](const std::optional<double>& variance, int begin) {
    if (!variance) return;
    used.middleRows<3>(begin).setZero();
    used.middleCols<3>(begin).setZero();
    used.block<3, 3>(begin, begin) = *variance * Mat3::Identity();
  };
  set(odometry_rotation_variance_rad2, 0);
  set(odometry_translation_variance_m2, 3);
  const Mat6 information = used.ldlt().solve(Mat6::Identity());
  return 0.5 * (information + information.transpose());
}

Vec6 edge_error(const SE3& T_from_to, const SE3& T_map_from, const SE3& T_map_to) {
  return (T_from_to.inverse() * (T_map_from.inverse() * T_map_to)).log();
}

void PoseGraph::add_node(int id, const SE3& T_map_node) {
  if (!index_.emplace(id, ids_.size()).second) throw std::logic_error("a pose graph has this node already");
  ids_.push_back(id);
  poses_.push_back(T_map_node);
}

void PoseGraph::add_edge(PoseEdge edge) {
  if (!contains(edge.from) || !contains(edge.to))
    throw std::logic_error("an edge of the pose graph lacks a node");
  edges_.push_back(std::move(edge));
}

void PoseGraph::fix_node(int id) {
  if (!contains(id)) throw std::logic_error("a pose graph cannot fix a node that it lacks");
  fixed_.push_back(id);
}

double PoseGraph::cost() const {
  double sum = 0;
  for (const PoseEdge& edge : edges_) {
    const Vec6 r = edge_error(edge.T_from_to, pose(edge.from), pose(edge.to));
    sum += r.dot(edge.information * r);
  }
  return sum;
}

}  // namespace vsslam

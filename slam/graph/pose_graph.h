// Pose graph: min over T_i of sum |Log(Z_ij^-1 T_i^-1 T_j)|^2_Omega (Song et al. 2025, equation 1), solved in
// Ceres from the previous solution. Reads and writes g2o files.
#pragma once

#include <filesystem>
#include <vector>

#include "core/config.h"
#include "core/se3.h"

namespace vsslam {

struct PoseGraphConfig {
  double odometry_rotation_variance_rad2 = 1e-6;
  double odometry_translation_variance_m2 = 1e-4;
  int max_iterations = 50;
  void fields(Fields& f);
};

/// Relative pose of two nodes. Information has the tangent order [rotation; translation].
struct PoseEdge {
  int from = 0, to = 0;        ///< node ids
  SE3 T_from_to;
  Mat6 information = Mat6::Identity();
  bool is_loop = false;
  double cauchy_scale = 0;     ///< 0: quadratic
};

class PoseGraph {
 public:
  /// Node ids are any distinct integers; poses are T_map_node.
  void add_node(int id, const SE3& T_map_node);
  void add_edge(const PoseEdge& edge);
  /// Sum of r^T Omega r over all edges, without robust kernels.
  double cost() const;
  struct Summary {
    double initial_cost = 0, final_cost = 0;  ///< as cost()
    int iterations = 0;
    bool converged = false;
  };
  /// The node added first stays fixed. Deterministic: one thread, no wall-clock limit.
  Summary optimize(const PoseGraphConfig& config);

  const std::vector<int>& ids() const { return ids_; }
  const SE3& pose(int id) const;
  const std::vector<PoseEdge>& edges() const { return edges_; }

  /// VERTEX_SE3:QUAT, EDGE_SE3:QUAT (translation before rotation, information upper triangle in that order), FIX.
  /// Throws InputError with file:line.
  static PoseGraph read_g2o(const std::filesystem::path& path);
  void write_g2o(const std::filesystem::path& path) const;

 private:
  std::vector<int> ids_;
  std::vector<SE3> poses_;  // parallel to ids_
  std::vector<PoseEdge> edges_;
};

}  // namespace vsslam

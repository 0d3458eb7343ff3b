// Pose graph: min over T_i of sum |Log(Z_ij^-1 T_i^-1 T_j)|^2_Omega (Song et al. 2025, equation 1), solved in
// Ceres from the previous solution. Reads and writes g2o files.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "core/config.h"
#include "core/se3.h"

namespace vsslam {

struct PoseGraphConfig {
  /// Of odometry's edges. Automatic: the covariance that registration and prior leave (odometry.h).
  std::optional<double> odometry_rotation_variance_rad2, odometry_translation_variance_m2;
  /// Of the directions of a loop's edge that the planes of both places see.
  double loop_rotation_variance_rad2 = 1e-6;
  double loop_translation_variance_m2 = 1e-4;
  int max_iterations = 100;
  double cost_tolerance = 1e-8;  ///< stop when a step lowers the cost by less than this share of it
  void fields(Fields& f);

  /// Tangent order [rotation; translation]: rad^2, m^2.
  Vec6 loop_variances() const;
  /// Information of an odometry edge whose covariance is this, or what was set in its place.
  Mat6 odometry_information(const Mat6& covariance) const;
};

/// Relative pose of two nodes. Information has the tangent order [rotation; translation].
struct PoseEdge {
  int from = 0, to = 0;  ///< node ids
  SE3 T_from_to;
  Mat6 information = Mat6::Identity();
  bool is_loop = false;
  double cauchy_scale = 0;  ///< 0: quadratic
};

/// Log(T_from_to^-1 T_map_from^-1 T_map_to), [rotation; translation].
Vec6 edge_error(const SE3& T_from_to, const SE3& T_map_from, const SE3& T_map_to);

class PoseGraph {
 public:
  /// Node ids are any distinct integers; poses are T_map_node.
  void add_node(int id, const SE3& T_map_node);
  void add_edge(PoseEdge edge);
  /// Keeps a node where it is. Without any such call the node added first is fixed.
  void fix_node(int id);

  /// Sum of r^T Omega r over all edges, without robust kernels.
  double cost() const;
  struct Summary {
    double initial_cost = 0, final_cost = 0;  ///< as cost()
    int iterations = 0;
    bool converged = false;
  };
  /// Deterministic: one thread, no wall-clock limit.
  Summary optimize(const PoseGraphConfig& config);

  bool contains(int id) const { return index_.contains(id); }
  const std::vector<int>& ids() const { return ids_; }
  const SE3& pose(int id) const { return poses_[index_.at(id)]; }
  const std::vector<PoseEdge>& edges() const { return edges_; }
  const std::vector<int>& fixed() const { return fixed_; }

  /// VERTEX_SE3:QUAT, EDGE_SE3:QUAT, FIX and comments. Throws InputError with file:line.
  ///
  /// The information is taken as GTSAM, Ceres' examples and SE-Sync take it: of [translation; rotation
  /// vector], so reading and writing only exchange the blocks. g2o itself weights [translation; vector part
  /// of the quaternion], half the rotation vector: its chi2 counts rotation a quarter of ours.
  static PoseGraph read_g2o(const std::filesystem::path& path);
  static PoseGraph parse_g2o(std::string_view text, const std::string& name);
  /// Reading it back gives the same graph to the bit (robust kernels and is_loop have no place in the
  /// format).
  void write_g2o(const std::filesystem::path& path) const;
  std::string g2o_text() const;

 private:
  std::vector<int> ids_;
  std::vector<SE3> poses_;  // parallel to ids_
  std::unordered_map<int, size_t> index_;
  std::vector<PoseEdge> edges_;
  std::vector<int> fixed_;
};

}  // namespace vsslam

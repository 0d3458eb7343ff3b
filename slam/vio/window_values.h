// Variables of the window's least-squares problem as its factors (Ceres' cost functions) want them: plain arrays of
// doubles.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "slam/graph/edge_cost.h"
#include "slam/vio/vio.h"

namespace vsslam {

/// [velocity; gyro bias; accel bias]
using MotionBlock = std::array<double, 9>;
using MotionMap = Eigen::Map<const Eigen::Matrix<double, 9, 1>>;

MotionBlock motion_block(const VioState& state);

inline SE3 pose_of(const double* block) {
  SE3 pose;  // the quaternion is a unit quaternion already: from_block and PoseManifold keep it so
  pose.rotation = Eigen::Map<const Quat>(block);
  pose.translation = Eigen::Map<const Vec3>(block + 4);
  return pose;
}

/// A pose block has 7 columns; PoseManifold's PlusJacobian [I; 0] hands the first 6 through.
template <int kRows, class Derived>
void put_pose_jacobian(const Eigen::MatrixBase<Derived>& J, double* out) {
  Eigen::Map<Eigen::Matrix<double, kRows, 7, Eigen::RowMajor>> map(out);
  map.template leftCols<6>() = J;
  map.col(6).setZero();
}
template <int kRows, class Derived>
void put_motion_jacobian(const Eigen::MatrixBase<Derived>& J, double* out) {
  Eigen::Map<Eigen::Matrix<double, kRows, 9, Eigen::RowMajor>>{out} = J;
}

/// A point in a camera: [x / z, y / z, 1 / z]. The last is 0 at infinity.
using InversePoint = Vec3;

enum class VariableKind { pose, motion, point };
constexpr int tangent_size(VariableKind kind) {
  return kind == VariableKind::pose ? 6 : kind == VariableKind::motion ? 9 : 3;
}

/// A frame by its place in the window, or a feature by its place among those that are optimised.
struct Variable {
  VariableKind kind;
  int index;
  auto operator<=>(const Variable&) const = default;
};

struct FrameBlocks {
  PoseBlock pose;
  MotionBlock motion;
};

FrameBlocks frame_blocks(const VioState& state);
/// Stamps are not among the variables.
void read_blocks(const FrameBlocks& blocks, VioState& state);

struct WindowValues {
  std::vector<FrameBlocks> frames;
  std::vector<InversePoint> points;  ///< of features, each in the camera of its anchor

  double* data(Variable v);
  const double* data(Variable v) const { return const_cast<WindowValues*>(this)->data(v); }
};

/// x - at in the tangent space at `at`: Log(at^-1 x) for a pose.
Eigen::VectorXd difference(VariableKind kind, const double* x, const double* at);

}  // namespace vsslam

#include "slam/vio/window_values.h"

namespace vsslam {

MotionBlock motion_block(const VioState& state) {
  MotionBlock block;
  Eigen::Map<Eigen::Matrix<double, 9, 1>>{block.data()} << state.v_vio_mps, state.bias.gyro_radps,
      state.bias.accel_mps2;
  return block;
}

FrameBlocks frame_blocks(const VioState& state) {
  return {to_block(state.T_vio_imu), motion_block(state)};
}

void read_blocks(const FrameBlocks& blocks, VioState& state) {
  const MotionMap m(blocks.motion.data());
  state.T_vio_imu = from_block(blocks.pose);
  state.v_vio_mps = m.head<3>();
  state.bias.gyro_radps = m.segment<3>(3);
  state.bias.accel_mps2 = m.tail<3>();
}

double* WindowValues::data(Variable v) {
  const auto i = static_cast<size_t>(v.index);
  if (v.kind == VariableKind::pose) return frames[i].pose.data();
  if (v.kind == VariableKind::motion) return frames[i].motion.data();
  return points[i].data();
}

Eigen::VectorXd difference(VariableKind kind, const double* x, const double* at) {
  if (kind == VariableKind::pose) return (pose_of(at).inverse() * pose_of(x)).log();
  const int size = tangent_size(kind);
  return Eigen::Map<const Eigen::VectorXd>(x, size) - Eigen::Map<const Eigen::VectorXd>(at, size);
}

}  // namespace vsslam

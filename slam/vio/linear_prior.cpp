#include "slam/vio/linear_prior.h"

#include <algorithm>

namespace vsslam {

PriorFactor::PriorFactor(const LinearPrior& prior) : prior_(prior) {
  set_num_residuals(static_cast<int>(prior.offset.size()));
  for (const LinearPrior::Part& part : prior.parts)
    mutable_parameter_block_sizes()->push_back(part.kind == VariableKind::pose ? 7 : 9);
}

bool PriorFactor::Evaluate(double const* const* parameters, double* residuals, double** jacobians) const {
  const Eigen::Index rows = prior_.offset.size();
  Eigen::Map<Eigen::VectorXd> r(residuals, rows);
  r = prior_.offset;
  Eigen::Index column = 0;
  for (size_t k = 0; k < prior_.parts.size(); ++k) {
    const LinearPrior::Part& part = prior_.parts[k];
    const int size = tangent_size(part.kind);
    const Eigen::VectorXd e = difference(part.kind, parameters[k], part.at.data());
    const auto slope = prior_.slope.middleCols(column, size);
    r += slope * e;
    column += size;
    if (!jacobians || !jacobians[k]) continue;
    const Eigen::Index columns = part.kind == VariableKind::pose ? 7 : 9;
    using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    Eigen::Map<RowMajor> J(jacobians[k], rows, columns);
    if (part.kind == VariableKind::pose) {
      J.leftCols<6>() = slope * se3_right_jacobian_inverse(e);
      J.col(6).setZero();
    } else {
      J = slope;
    }
  }
  return true;
}

LinearPrior prior_of_state(int64_t frame, const VioState& state, const StateSigmas& sigmas) {
  LinearPrior prior;
  prior.parts = {{frame, VariableKind::pose, {}}, {frame, VariableKind::motion, {}}};
  const PoseBlock pose = to_block(state.T_vio_imu);
  const MotionBlock motion = motion_block(state);
  std::copy(pose.begin(), pose.end(), prior.parts[0].at.begin());
  std::copy(motion.begin(), motion.end(), prior.parts[1].at.begin());
  Eigen::Matrix<double, 15, 1> weights;
  weights << 1 / sigmas.tilt_rad, 1 / sigmas.tilt_rad, 1 / sigmas.yaw_rad,
      Vec3::Constant(1 / sigmas.position_m), Vec3::Constant(1 / sigmas.velocity_mps),
      Vec3::Constant(1 / sigmas.gyro_bias_radps), Vec3::Constant(1 / sigmas.accel_bias_mps2);
  prior.slope = weights.asDiagonal();
  // Tilt and yaw are about the axes of `vio`; R Exp(phi) turns about R phi there.
  prior.slope.topLeftCorner<3, 3>() *= state.T_vio_imu.matrix3();
  prior.offset = Eigen::VectorXd::Zero(15);
  return prior;
}

}  // namespace vsslam

// What is known of some states of the window apart from its own measurements: the start, and all that has left the
// window.
#pragma once

#include <ceres/cost_function.h>

#include <Eigen/Core>
#include <vector>

#include "slam/vio/window_values.h"

namespace vsslam {

/// Residual offset + slope (x - at), whitened. The points `at` stay where the state was when it first took part
/// (first estimates; Huang, Mourikis, Roumeliotis, IJRR 2010).
struct LinearPrior {
  struct Part {
    int64_t frame;
    VariableKind kind;  ///< pose or motion
    std::array<double, 9> at;
  };
  std::vector<Part> parts;  ///< in order of frame, pose before motion
  Eigen::MatrixXd slope;    ///< columns in order of parts
  Eigen::VectorXd offset;
};

/// Variables: those of the parts, in their order. `prior` is not copied.
class PriorFactor final : public ceres::CostFunction {
 public:
  explicit PriorFactor(const LinearPrior& prior);
  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override;

 private:
  const LinearPrior& prior_;
};

/// How well the first state of a window is known. Position and yaw are free to choose: their sigmas are small.
struct StateSigmas {
  double tilt_rad, yaw_rad, position_m, velocity_mps, gyro_bias_radps, accel_bias_mps2;
};
LinearPrior prior_of_state(int64_t frame, const VioState& state, const StateSigmas& sigmas);

}  // namespace vsslam

// Removing states from the window without forgetting what they told about the others: the Schur complement of
// their normal equations (Leutenegger et al., IJRR 2015; Qin et al., T-RO 2018).
#pragma once

#include <memory>
#include <vector>

#include "slam/vision/linear_prior.h"
#include "slam/vision/window_values.h"

namespace vsslam {

struct WindowFactor {
  std::unique_ptr<ceres::CostFunction> cost;
  bool robust = false;  ///< Cauchy(1)
  std::vector<Variable> variables;
};

/// Factors at two points: residuals at `now`, slopes at `first`, which differs from `now` in those states that a
/// prior already holds at their first estimates.
struct Linearization {
  WindowValues now, first;
  std::vector<int64_t> frames;  ///< ids, by index
};

/// H dx = -b for dx = x - first, over the poses and motions that `factors` touch; features are eliminated.
struct NormalEquations {
  std::vector<Variable> variables;  ///< in order, poses and motions of a frame side by side
  Eigen::MatrixXd H;
  Eigen::VectorXd b;
};
NormalEquations normal_equations(const std::vector<WindowFactor>& factors, const Linearization& at);

/// Prior on the frames that stay when frame number `leaving` goes. Eigenvalues below 1e-8 count as unknown.
LinearPrior marginalize(const std::vector<WindowFactor>& factors, const Linearization& at, int leaving);

}  // namespace vsslam

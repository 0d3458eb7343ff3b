#include "slam/vio/marginalization.h"

#include <Eigen/Eigenvalues>
#include <algorithm>

namespace vsslam {

namespace {

constexpr double kUnknown = 1e-8;  // eigenvalue of an information matrix

struct Spectrum {
  Eigen::VectorXd values;
  Eigen::MatrixXd vectors;
};

Spectrum decompose(const Eigen::MatrixXd& symmetric) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(0.5 * (symmetric + symmetric.transpose()));
  return {solver.eigenvalues(), solver.eigenvectors()};
}

}  // namespace

LinearPrior marginalize(const std::vector<WindowFactor>& factors, const Linearization& at, int leaving) {
  WindowEquations equations(factors, at.now.points.size());
  equations.linearize(at.now, at.first);
  const NormalEquations all = equations.without_points();
  std::vector<Eigen::Index> gone, kept;
  LinearPrior prior;
  Eigen::Index column = 0;
  for (const Variable v : all.variables) {
    if (v.index != leaving) {
      LinearPrior::Part part{at.frames[static_cast<size_t>(v.index)], v.kind, {}};
      const double* x = at.first.data(v);
      std::copy(x, x + (v.kind == VariableKind::pose ? 7 : 9), part.at.begin());
      prior.parts.push_back(part);
    }
    for (int i = 0; i < tangent_size(v.kind); ++i) (v.index == leaving ? gone : kept).push_back(column++);
  }
  // Schur complement. The leaving state may be unknown in part: its pseudo-inverse.
  const Spectrum left = decompose(all.H(gone, gone));
  const Eigen::VectorXd inverse =
      left.values.unaryExpr([](double l) { return l > kUnknown ? 1.0 / l : 0.0; });
  const Eigen::MatrixXd gain =
      all.H(kept, gone) * left.vectors * inverse.asDiagonal() * left.vectors.transpose();
  const Eigen::MatrixXd H = all.H(kept, kept) - gain * all.H(gone, kept);
  const Eigen::VectorXd b = all.b(kept) - gain * all.b(gone);
  // H = V diag(l) V^T as a square: rows sqrt(l) V^T.
  const Spectrum whole = decompose(H);
  Eigen::Index unknown = 0;
  while (unknown < whole.values.size() && whole.values[unknown] <= kUnknown) ++unknown;
  const Eigen::Index known = whole.values.size() - unknown;
  const Eigen::VectorXd root = whole.values.tail(known).cwiseSqrt();
  prior.slope = root.asDiagonal() * whole.vectors.rightCols(known).transpose();
  prior.offset = root.cwiseInverse().asDiagonal() * (whole.vectors.rightCols(known).transpose() * b);
  return prior;
}

}  // namespace vsslam

#include "slam/vision/marginalization.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <map>

namespace vsslam {

namespace {

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
constexpr double kUnknown = 1e-8;  // eigenvalue of an information matrix

// A factor's residual and slopes to the tangents of its variables.
struct Slopes {
  Eigen::VectorXd r;
  std::vector<Eigen::MatrixXd> J;
};

Slopes slopes_of(const WindowFactor& factor, const Linearization& at) {
  const size_t count = factor.variables.size();
  const int rows = factor.cost->num_residuals();
  std::vector<const double*> now(count), first(count);
  std::vector<RowMajor> ambient(count);
  std::vector<double*> out(count);
  bool moved = false;
  for (size_t k = 0; k < count; ++k) {
    const Variable v = factor.variables[k];
    const int size = factor.cost->parameter_block_sizes()[k];
    now[k] = at.now.data(v);
    first[k] = at.first.data(v);
    moved |= !std::equal(now[k], now[k] + size, first[k]);
    ambient[k].resize(rows, size);
    out[k] = ambient[k].data();
  }
  Slopes slopes;
  slopes.r.resize(rows);
  factor.cost->Evaluate(first.data(), slopes.r.data(), out.data());
  if (moved) factor.cost->Evaluate(now.data(), slopes.r.data(), nullptr);
  // Cauchy(1) as a weight: its derivative at the squared error.
  const double weight = factor.robust ? std::sqrt(1.0 / (1.0 + slopes.r.squaredNorm())) : 1.0;
  for (size_t k = 0; k < count; ++k) {
    const VariableKind kind = factor.variables[k].kind;
    const Eigen::MatrixXd J = ambient[k].leftCols(tangent_size(kind));
    if (moved) slopes.r -= J * difference(kind, now[k], first[k]);
    slopes.J.push_back(weight * J);
  }
  slopes.r *= weight;
  return slopes;
}

// Poses and motions, frame by frame.
bool before(const Variable& a, const Variable& b) {
  return a.index != b.index ? a.index < b.index : a.kind < b.kind;
}

struct Columns {
  std::vector<Variable> variables;
  std::map<Variable, Eigen::Index> begin;
  Eigen::Index size = 0;
};

Columns columns_of(const std::vector<WindowFactor>& factors) {
  Columns columns;
  for (const WindowFactor& factor : factors)
    for (const Variable v : factor.variables)
      if (v.kind != VariableKind::point) columns.variables.push_back(v);
  std::sort(columns.variables.begin(), columns.variables.end(), before);
  columns.variables.erase(std::unique(columns.variables.begin(), columns.variables.end()),
                          columns.variables.end());
  for (const Variable v : columns.variables) {
    columns.begin[v] = columns.size;
    columns.size += tangent_size(v.kind);
  }
  return columns;
}

// Rows of the normal equations of one feature: to itself, to the states, and its gradient.
struct FeatureRows {
  Mat3 H = Mat3::Zero();
  Vec3 b = Vec3::Zero();
  Eigen::Matrix<double, 3, Eigen::Dynamic> to_states;
};

// What is unknown of the point itself (its depth if it was seen without parallax) ties no states together.
Mat3 pseudo_inverse(const Mat3& H) {
  const Eigen::SelfAdjointEigenSolver<Mat3> solver(H);
  const Vec3 inverse = solver.eigenvalues().unaryExpr([](double l) { return l > kUnknown ? 1.0 / l : 0.0; });
  return solver.eigenvectors() * inverse.asDiagonal() * solver.eigenvectors().transpose();
}

void eliminate(const FeatureRows& feature, NormalEquations& equations) {
  const Mat3 inverse = pseudo_inverse(feature.H);
  std::vector<Eigen::Index> touched;
  for (Eigen::Index i = 0; i < feature.to_states.cols(); ++i)
    if (!feature.to_states.col(i).isZero(0)) touched.push_back(i);
  for (const Eigen::Index i : touched) {
    const Vec3 share = inverse * feature.to_states.col(i);
    for (const Eigen::Index j : touched) equations.H(j, i) -= feature.to_states.col(j).dot(share);
    equations.b[i] -= share.dot(feature.b);
  }
}

struct Spectrum {
  Eigen::VectorXd values;
  Eigen::MatrixXd vectors;
};

Spectrum decompose(const Eigen::MatrixXd& symmetric) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(0.5 * (symmetric + symmetric.transpose()));
  return {solver.eigenvalues(), solver.eigenvectors()};
}

}  // namespace

NormalEquations normal_equations(const std::vector<WindowFactor>& factors, const Linearization& at) {
  const Columns columns = columns_of(factors);
  NormalEquations equations{columns.variables, Eigen::MatrixXd::Zero(columns.size, columns.size),
                            Eigen::VectorXd::Zero(columns.size)};
  std::map<int, FeatureRows> features;
  for (const WindowFactor& factor : factors) {
    const Slopes slopes = slopes_of(factor, at);
    const size_t count = factor.variables.size();
    FeatureRows* feature = nullptr;
    size_t point = count;
    for (size_t k = 0; k < count; ++k) {
      if (factor.variables[k].kind != VariableKind::point) continue;
      feature = &features[factor.variables[k].index];
      if (feature->to_states.cols() == 0) feature->to_states.setZero(3, columns.size);
      feature->H += slopes.J[k].transpose() * slopes.J[k];
      feature->b += slopes.J[k].transpose() * slopes.r;
      point = k;
    }
    for (size_t k = 0; k < count; ++k) {
      if (k == point) continue;
      const Eigen::Index a = columns.begin.at(factor.variables[k]), size = slopes.J[k].cols();
      equations.b.segment(a, size) += slopes.J[k].transpose() * slopes.r;
      if (feature) feature->to_states.middleCols(a, size) += slopes.J[point].transpose() * slopes.J[k];
      for (size_t l = 0; l < count; ++l) {
        if (l == point) continue;
        const Eigen::Index c = columns.begin.at(factor.variables[l]);
        equations.H.block(a, c, size, slopes.J[l].cols()) += slopes.J[k].transpose() * slopes.J[l];
      }
    }
  }
  for (const auto& [index, feature] : features) eliminate(feature, equations);
  return equations;
}

LinearPrior marginalize(const std::vector<WindowFactor>& factors, const Linearization& at, int leaving) {
  const NormalEquations all = normal_equations(factors, at);
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

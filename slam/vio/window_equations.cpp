#include "slam/vio/window_equations.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <map>

namespace vsslam {

namespace {

constexpr double kUnknown = 1e-8;  // eigenvalue of an information matrix

using Slope = Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>, 0,
                         Eigen::OuterStride<>>;
template <int kRows, int kColumns, int kStride>
using FixedSlope =
    Eigen::Map<const Eigen::Matrix<double, kRows, kColumns, Eigen::RowMajor>, 0, Eigen::OuterStride<kStride>>;

int ambient_size(const WindowFactor& factor, size_t k) {
  return factor.cost->parameter_block_sizes()[k];
}

// Poses and motions, frame by frame.
bool before(const Variable& a, const Variable& b) {
  return a.index != b.index ? a.index < b.index : a.kind < b.kind;
}

std::vector<Variable> states_of(const std::vector<WindowFactor>& factors) {
  std::vector<Variable> states;
  for (const WindowFactor& factor : factors)
    for (const Variable v : factor.variables)
      if (v.kind != VariableKind::point) states.push_back(v);
  std::sort(states.begin(), states.end(), before);
  states.erase(std::unique(states.begin(), states.end()), states.end());
  return states;
}

Mat3 pseudo_inverse(const Mat3& H) {
  const Eigen::SelfAdjointEigenSolver<Mat3> solver(H);
  const Vec3 inverse = solver.eigenvalues().unaryExpr([](double l) { return l > kUnknown ? 1.0 / l : 0.0; });
  return solver.eigenvectors() * inverse.asDiagonal() * solver.eigenvectors().transpose();
}

}  // namespace

double window_cost(const std::vector<WindowFactor>& factors, const WindowValues& values) {
  double cost = 0;
  std::vector<const double*> x;
  std::vector<double> residuals;
  for (const WindowFactor& factor : factors) {
    x.clear();
    for (const Variable v : factor.variables) x.push_back(values.data(v));
    residuals.resize(static_cast<size_t>(factor.cost->num_residuals()));
    factor.cost->Evaluate(x.data(), residuals.data(), nullptr);
    double r2 = 0;
    for (const double r : residuals) r2 += r * r;
    cost += 0.5 * (factor.robust ? std::log1p(r2) : r2);
  }
  return cost;
}

WindowEquations::WindowEquations(const std::vector<WindowFactor>& factors, size_t points)
    : variables_(states_of(factors)), points_(points) {
  std::map<Variable, Eigen::Index> begin;
  Eigen::Index size = 0;
  for (const Variable v : variables_) {
    begin[v] = size;
    size += tangent_size(v.kind);
  }
  for (const WindowFactor& factor : factors) {
    Term term{.factor = &factor, .columns = {}};
    for (size_t k = 0; k < factor.variables.size(); ++k) {
      const Variable v = factor.variables[k];
      const bool is_point = v.kind == VariableKind::point;
      term.columns.push_back(is_point ? -1 : begin.at(v));
      if (is_point) {
        term.point = v.index;
        term.point_at = k;
      }
    }
    terms_.push_back(std::move(term));
  }
  H_.resize(size, size);
  b_.resize(size);
}

void WindowEquations::PointRows::clear() {
  H.setZero();
  b.setZero();
  for (Tie& tie : ties) tie.rows.setZero();
}

WindowEquations::Mat3X& WindowEquations::PointRows::to(Eigen::Index column, Eigen::Index size) {
  for (Tie& tie : ties)
    if (tie.column == column) return tie.rows;
  ties.push_back({column, Mat3X::Zero(3, size)});
  return ties.back().rows;
}

void WindowEquations::linearize(const WindowValues& now, const WindowValues& first) {
  H_.setZero();
  b_.setZero();
  for (PointRows& point : points_) point.clear();
  for (const Term& term : terms_) {
    evaluate(term, now, first);
    const bool seen_from_two = term.columns.size() == 3 && term.point >= 0 && term.point_at == 2 &&
                               slopes_.r.size() == 2 && ambient_size(*term.factor, 0) == 7 &&
                               ambient_size(*term.factor, 1) == 7;
    seen_from_two ? add_pair(term) : add(term);
  }
}

void WindowEquations::evaluate(const Term& term, const WindowValues& now, const WindowValues& first) {
  const WindowFactor& factor = *term.factor;
  const size_t count = factor.variables.size();
  const int rows = factor.cost->num_residuals();
  Slopes& s = slopes_;
  s.now.resize(count);
  s.first.resize(count);
  s.out.resize(count);
  if (s.ambient.size() < count) s.ambient.resize(count);
  bool moved = false;
  for (size_t k = 0; k < count; ++k) {
    const int size = ambient_size(factor, k);
    s.now[k] = now.data(factor.variables[k]);
    s.first[k] = first.data(factor.variables[k]);
    moved |= &now != &first && !std::equal(s.now[k], s.now[k] + size, s.first[k]);
    s.ambient[k].resize(static_cast<size_t>(rows * size));
    s.out[k] = s.ambient[k].data();
  }
  s.r.resize(rows);
  factor.cost->Evaluate(s.first.data(), s.r.data(), s.out.data());
  if (moved) factor.cost->Evaluate(s.now.data(), s.r.data(), nullptr);
  // Cauchy(1) as a weight: its derivative at the squared error.
  const double weight = factor.robust ? std::sqrt(1.0 / (1.0 + s.r.squaredNorm())) : 1.0;
  for (size_t k = 0; moved && k < count; ++k) {
    const VariableKind kind = factor.variables[k].kind;
    const int size = ambient_size(factor, k);
    s.r -= Slope(s.out[k], rows, tangent_size(kind), Eigen::OuterStride<>(size)) *
           difference(kind, s.now[k], s.first[k]);
  }
  if (weight == 1.0) return;
  s.r *= weight;
  for (size_t k = 0; k < count; ++k)
    for (double& value : s.ambient[k]) value *= weight;
}

// Two poses and a point, two rows: most factors are like this.
void WindowEquations::add_pair(const Term& term) {
  const Eigen::Vector2d r = slopes_.r;
  const FixedSlope<2, 6, 7> i(slopes_.out[0]), j(slopes_.out[1]);
  const FixedSlope<2, 3, 3> p(slopes_.out[2]);
  const Eigen::Index at_i = term.columns[0], at_j = term.columns[1];
  b_.segment<6>(at_i) += i.transpose() * r;
  b_.segment<6>(at_j) += j.transpose() * r;
  H_.block<6, 6>(at_i, at_i) += i.transpose() * i;
  H_.block<6, 6>(at_j, at_j) += j.transpose() * j;
  if (at_i > at_j) {
    H_.block<6, 6>(at_i, at_j) += i.transpose() * j;
  } else {
    H_.block<6, 6>(at_j, at_i) += j.transpose() * i;
  }
  PointRows& point = points_[static_cast<size_t>(term.point)];
  point.H += p.transpose() * p;
  point.b += p.transpose() * r;
  point.to(at_i, 6).leftCols<6>() += p.transpose() * i;
  point.to(at_j, 6).leftCols<6>() += p.transpose() * j;
}

void WindowEquations::add(const Term& term) {
  const Eigen::VectorXd& r = slopes_.r;
  const auto slope = [&](size_t k) {
    return Slope(slopes_.out[k], r.size(), tangent_size(term.factor->variables[k].kind),
                 Eigen::OuterStride<>(ambient_size(*term.factor, k)));
  };
  PointRows* point = term.point < 0 ? nullptr : &points_[static_cast<size_t>(term.point)];
  if (point) {
    const Slope p = slope(term.point_at);
    point->H += p.transpose() * p;
    point->b += p.transpose() * r;
  }
  for (size_t k = 0; k < term.columns.size(); ++k) {
    const Eigen::Index column = term.columns[k];
    if (column < 0) continue;
    const Slope J = slope(k);
    b_.segment(column, J.cols()) += J.transpose() * r;
    if (point) point->to(column, J.cols()) += slope(term.point_at).transpose() * J;
    for (size_t l = 0; l < term.columns.size(); ++l) {
      const Eigen::Index other = term.columns[l];
      if (other < 0 || other > column) continue;
      H_.block(column, other, J.cols(), slope(l).cols()).noalias() += J.transpose() * slope(l);
    }
  }
}

// H and b of the states lose what the point takes with it: W' H_point^-1 W and W' H_point^-1 b_point.
template <class Inverse>
void WindowEquations::eliminate(const PointRows& point, const Inverse& inverse, Eigen::MatrixXd& H,
                                Eigen::VectorXd& b) const {
  for (const PointRows::Tie& a : point.ties) {
    const Mat3X share = inverse * a.rows;
    b.segment(a.column, a.rows.cols()) -= share.transpose() * point.b;
    for (const PointRows::Tie& c : point.ties) {
      if (c.column < a.column) continue;
      if (a.rows.cols() == 6 && c.rows.cols() == 6) {
        H.block<6, 6>(c.column, a.column) -= c.rows.leftCols<6>().transpose() * share.leftCols<6>();
      } else {
        H.block(c.column, a.column, c.rows.cols(), a.rows.cols()) -= c.rows.transpose() * share;
      }
    }
  }
}

NormalEquations WindowEquations::without_points() const {
  NormalEquations equations{variables_, H_, b_};
  for (const PointRows& point : points_) eliminate(point, pseudo_inverse(point.H), equations.H, equations.b);
  equations.H.triangularView<Eigen::StrictlyUpper>() = equations.H.transpose();
  return equations;
}

Eigen::VectorXd WindowEquations::gradient() const {
  Eigen::VectorXd g(b_.size() + 3 * static_cast<Eigen::Index>(points_.size()));
  g.head(b_.size()) = b_;
  for (size_t i = 0; i < points_.size(); ++i)
    g.segment<3>(b_.size() + 3 * static_cast<Eigen::Index>(i)) = points_[i].b;
  return g;
}

Eigen::VectorXd WindowEquations::diagonal() const {
  Eigen::VectorXd d(b_.size() + 3 * static_cast<Eigen::Index>(points_.size()));
  d.head(b_.size()) = H_.diagonal();
  for (size_t i = 0; i < points_.size(); ++i)
    d.segment<3>(b_.size() + 3 * static_cast<Eigen::Index>(i)) = points_[i].H.diagonal();
  return d;
}

double WindowEquations::curvature(const Eigen::VectorXd& v) const {
  const auto states = v.head(b_.size());
  double sum = states.dot(H_.selfadjointView<Eigen::Lower>() * states);
  for (size_t i = 0; i < points_.size(); ++i) {
    const Vec3 p = v.segment<3>(b_.size() + 3 * static_cast<Eigen::Index>(i));
    Vec3 slope = points_[i].H * p;
    for (const PointRows::Tie& tie : points_[i].ties)
      slope += 2 * (tie.rows * states.segment(tie.column, tie.rows.cols()));
    sum += p.dot(slope);
  }
  return sum;
}

std::optional<Eigen::VectorXd> WindowEquations::newton_step(const Eigen::VectorXd& damping) const {
  Eigen::MatrixXd H = H_;
  Eigen::VectorXd b = b_, dx(damping.size());
  H.diagonal() += damping.head(b.size());
  std::vector<Mat3> inverses(points_.size());
  for (size_t i = 0; i < points_.size(); ++i) {
    Mat3 own = points_[i].H;
    own.diagonal() += damping.segment<3>(b.size() + 3 * static_cast<Eigen::Index>(i));
    inverses[i] = own.inverse();
    if (!inverses[i].allFinite()) return std::nullopt;
    eliminate(points_[i], inverses[i], H, b);
  }
  const Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>> llt(H);
  if (llt.info() != Eigen::Success) return std::nullopt;
  dx.head(b.size()) = -llt.solve(b);
  for (size_t i = 0; i < points_.size(); ++i) {
    Vec3 pull = points_[i].b;
    for (const PointRows::Tie& tie : points_[i].ties)
      pull += tie.rows * dx.segment(tie.column, tie.rows.cols());
    dx.segment<3>(b.size() + 3 * static_cast<Eigen::Index>(i)) = -inverses[i] * pull;
  }
  return dx.allFinite() ? std::optional(dx) : std::nullopt;
}

WindowValues WindowEquations::moved(const WindowValues& x, const Eigen::VectorXd& dx) const {
  WindowValues result = x;
  Eigen::Index column = 0;
  for (const Variable v : variables_) {
    double* block = result.data(v);
    if (v.kind == VariableKind::pose) {
      PoseManifold().Plus(x.data(v), dx.data() + column, block);
    } else {
      Eigen::Map<Eigen::Matrix<double, 9, 1>>{block} += dx.segment<9>(column);
    }
    column += tangent_size(v.kind);
  }
  for (size_t i = 0; i < points_.size(); ++i)
    result.points[i] += dx.segment<3>(column + 3 * static_cast<Eigen::Index>(i));
  return result;
}

}  // namespace vsslam

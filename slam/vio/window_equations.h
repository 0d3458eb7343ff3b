// The Gauss-Newton system of a window: its factors linearised, the points of features kept apart so that they are
// eliminated one by one (Schur complement; Triggs et al., Bundle Adjustment, 2000, section 6).
#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <vector>

#include "slam/vio/linear_prior.h"
#include "slam/vio/window_values.h"

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

/// Sum of 1/2 r^2, or of 1/2 log(1 + r^2) where robust.
double window_cost(const std::vector<WindowFactor>& factors, const WindowValues& values);

/// H dx = -b over the poses and motions that the factors touch; points are eliminated.
struct NormalEquations {
  std::vector<Variable> variables;  ///< in order, poses and motions of a frame side by side
  Eigen::MatrixXd H;
  Eigen::VectorXd b;
};

/// H dx = -b for dx = x - first. A vector of the system has the states' tangents first, then three entries per point.
/// A factor has at most one point.
class WindowEquations {
 public:
  /// The factors must outlive the equations. Points are numbered 0 .. points - 1.
  WindowEquations(const std::vector<WindowFactor>& factors, size_t points);

  void linearize(const WindowValues& now, const WindowValues& first);

  /// What is unknown of a point (its depth if it was seen without parallax) ties no states together.
  NormalEquations without_points() const;
  /// b, diagonal of H, and v' H v.
  Eigen::VectorXd gradient() const;
  Eigen::VectorXd diagonal() const;
  double curvature(const Eigen::VectorXd& v) const;
  /// -(H + diag(damping))^-1 b; nullopt if that is not positive definite.
  std::optional<Eigen::VectorXd> newton_step(const Eigen::VectorXd& damping) const;
  /// x moved by a vector of the system.
  WindowValues moved(const WindowValues& x, const Eigen::VectorXd& dx) const;

 private:
  using Mat3X = Eigen::Matrix<double, 3, Eigen::Dynamic, 0, 3, 9>;

  // One factor: where its variables are in the system.
  struct Term {
    const WindowFactor* factor;
    std::vector<Eigen::Index> columns;  // of states; -1 for the point
    int point = -1;
    size_t point_at = 0;  // which of the variables is the point
  };
  // A point's rows of H: to itself, to the states that see it, and its part of b.
  struct PointRows {
    struct Tie {
      Eigen::Index column;
      Mat3X rows;
    };
    Mat3 H = Mat3::Zero();
    Vec3 b = Vec3::Zero();
    std::vector<Tie> ties;
    void clear();
    Mat3X& to(Eigen::Index column, Eigen::Index size);
  };
  // Residual and slopes of one factor, weighted.
  struct Slopes {
    Eigen::VectorXd r;
    std::vector<std::vector<double>> ambient;  // row-major, as Ceres' factors write them
    std::vector<const double*> now, first;
    std::vector<double*> out;
  };

  void evaluate(const Term& term, const WindowValues& now, const WindowValues& first);
  void add_pair(const Term& term);
  void add(const Term& term);
  template <class Inverse>
  void eliminate(const PointRows& point, const Inverse& inverse, Eigen::MatrixXd& H,
                 Eigen::VectorXd& b) const;

  std::vector<Variable> variables_;  // of the states
  std::vector<Term> terms_;
  std::vector<PointRows> points_;
  Eigen::MatrixXd H_;  // of the states; lower triangle
  Eigen::VectorXd b_;
  Slopes slopes_;
};

}  // namespace vsslam

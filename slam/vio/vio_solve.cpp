// Powell's dog leg on the window (Nocedal & Wright, Numerical Optimization, algorithm 4.1 and section 4.1), points
// eliminated; tests compare it with Ceres'.
#include <algorithm>
#include <cmath>

#include "slam/vio/vio_problem.h"

namespace vsslam {

namespace {

constexpr double kFirstRadius = 1e4;
constexpr double kLeastGain = 1e-3;  // of the cost predicted, for a step to be taken

// A step within a trust region. Lengths are in units of the diagonal: |D^1/2 dx|.
class DogLeg {
 public:
  explicit DogLeg(const WindowEquations& equations)
      : equations_(equations),
        gradient_(equations.gradient()),
        scale_(equations.diagonal().cwiseMax(1e-6).cwiseMin(1e32)) {
    for (double share = 1e-8; !newton_ && share < 1; share *= 10)
      newton_ = equations.newton_step(share * scale_);
    // Down the gradient of the scaled problem, to where the quadratic is least.
    steepest_ = -gradient_.cwiseQuotient(scale_);
    steepest_ *= gradient_.dot(gradient_.cwiseQuotient(scale_)) / equations.curvature(steepest_);
  }

  bool possible() const { return newton_ && steepest_.allFinite(); }

  Eigen::VectorXd step(double radius) const {
    const double newton_length = length(*newton_), steepest_length = length(steepest_);
    if (newton_length <= radius) return *newton_;
    if (steepest_length >= radius) return steepest_ * (radius / steepest_length);
    // |steepest + t (newton - steepest)| = radius
    const Eigen::VectorXd leg = *newton_ - steepest_;
    const double a = leg.dot(scale_.cwiseProduct(leg)), b = steepest_.dot(scale_.cwiseProduct(leg)),
                 c = steepest_length * steepest_length - radius * radius;
    return steepest_ + (std::sqrt(b * b - a * c) - b) / a * leg;
  }

  double predicted_gain(const Eigen::VectorXd& step) const {
    return -gradient_.dot(step) - 0.5 * equations_.curvature(step);
  }
  double length(const Eigen::VectorXd& step) const { return std::sqrt(step.dot(scale_.cwiseProduct(step))); }

 private:
  const WindowEquations& equations_;
  Eigen::VectorXd gradient_, scale_, steepest_;
  std::optional<Eigen::VectorXd> newton_;
};

}  // namespace

VioSolution minimize(const std::vector<WindowFactor>& factors, WindowValues& x, int max_iterations,
                     double cost_tolerance) {
  WindowEquations equations(factors, x.points.size());
  double cost = window_cost(factors, x), radius = kFirstRadius;
  VioSolution solution{.initial_cost = cost, .final_cost = cost, .iterations = 0, .usable = false};
  if (!std::isfinite(cost)) return solution;
  for (bool converged = false; !converged && solution.iterations < max_iterations;) {
    equations.linearize(x, x);
    const DogLeg leg(equations);
    if (!leg.possible()) break;
    for (bool accepted = false; !accepted && !converged && solution.iterations < max_iterations;) {
      ++solution.iterations;
      const Eigen::VectorXd step = leg.step(radius);
      const double predicted = leg.predicted_gain(step);
      WindowValues trial = equations.moved(x, step);
      const double trial_cost = window_cost(factors, trial);
      const double gain = (cost - trial_cost) / predicted;  // NaN: not accepted
      accepted = gain > kLeastGain;
      converged =
          predicted <= cost_tolerance * cost || (accepted && cost - trial_cost <= cost_tolerance * cost);
      if (gain > 0.75) radius = std::max(radius, 3 * leg.length(step));
      if (!(gain > 0.25)) radius = 0.5 * std::min(radius, leg.length(step));
      if (!accepted) continue;
      x = std::move(trial);
      cost = trial_cost;
    }
  }
  solution.final_cost = cost;
  solution.usable = solution.iterations > 0;
  return solution;
}

VioSolution solve(VioWindow& window, const VioModel& model, int max_iterations) {
  WindowProblem problem = make_problem(window, usable_features(window, model.config.max_features), model);
  WindowValues& x = problem.at.now;
  const VioSolution solution = minimize(problem.factors, x, max_iterations);
  if (!solution.usable) return solution;
  for (size_t i = 0; i < x.frames.size(); ++i) read_blocks(x.frames[i], window.frames[i].state);
  for (size_t i = 0; i < problem.features.size(); ++i)
    window.features.at(problem.features[i]).point = x.points[i];
  return solution;
}

}  // namespace vsslam

// The only file of the visual-inertial odometry that knows Ceres' solver.
#include <ceres/ceres.h>

#include "slam/vision/vio_problem.h"

namespace vsslam {

namespace {

ceres::Solver::Options solver_options(int max_iterations, bool has_features) {
  ceres::Solver::Options options;
  // Without features Ceres would choose what to eliminate, by addresses.
  options.linear_solver_type = has_features ? ceres::DENSE_SCHUR : ceres::DENSE_NORMAL_CHOLESKY;
  options.trust_region_strategy_type = ceres::DOGLEG;
  options.dense_linear_algebra_library_type = ceres::EIGEN;  // the others round as the host's LAPACK does
  options.num_threads = 1;                                   // sums of several threads are not repeatable
  options.max_num_iterations = max_iterations;               // and no limit on wall-clock time
  options.function_tolerance = 1e-4;
  options.logging_type = ceres::SILENT;
  return options;
}

ceres::Problem::Options problem_options() {
  ceres::Problem::Options options;
  options.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  options.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  options.manifold_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  options.disable_all_safety_checks = true;
  return options;
}

}  // namespace

VioSolution solve(VioWindow& window, const VioModel& model, int max_iterations) {
  WindowProblem ours = make_problem(window, usable_features(window, model.config.max_features), model);
  WindowValues& x = ours.at.now;
  PoseManifold manifold;
  ceres::CauchyLoss cauchy(1.0);
  ceres::Problem problem(problem_options());
  ceres::Solver::Options options = solver_options(max_iterations, !ours.features.empty());
  auto* ordering = new ceres::ParameterBlockOrdering;
  options.linear_solver_ordering.reset(ordering);
  for (InversePoint& point : x.points) {
    problem.AddParameterBlock(point.data(), 3);
    ordering->AddElementToGroup(point.data(), 0);
  }
  for (FrameBlocks& frame : x.frames) {
    problem.AddParameterBlock(frame.pose.data(), 7, &manifold);
    problem.AddParameterBlock(frame.motion.data(), 9);
    ordering->AddElementToGroup(frame.pose.data(), 1);
    ordering->AddElementToGroup(frame.motion.data(), 1);
  }
  std::vector<double*> blocks;
  for (const WindowFactor& factor : ours.factors) {
    blocks.clear();
    for (const Variable v : factor.variables) blocks.push_back(x.data(v));
    problem.AddResidualBlock(factor.cost.get(), factor.robust ? &cauchy : nullptr, blocks);
  }
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  VioSolution solution{summary.initial_cost, summary.final_cost,
                       std::max(0, static_cast<int>(summary.iterations.size()) - 1),
                       summary.IsSolutionUsable()};
  if (!solution.usable) return solution;
  for (size_t i = 0; i < x.frames.size(); ++i) read_blocks(x.frames[i], window.frames[i].state);
  for (size_t i = 0; i < ours.features.size(); ++i) window.features.at(ours.features[i]).point = x.points[i];
  return solution;
}

}  // namespace vsslam

// The only file of the graph that knows Ceres.
#include <ceres/ceres.h>

#include <algorithm>
#include <array>
#include <memory>

#include "slam/graph/edge_cost.h"
#include "slam/graph/pose_graph.h"

namespace vsslam {

namespace {

ceres::Solver::Options solver_options(const PoseGraphConfig& config) {
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  options.sparse_linear_algebra_library_type =
      ceres::EIGEN_SPARSE;  // the others round as the host's BLAS does
  options.num_threads = 1;  // sums of several threads are not repeatable
  options.initial_trust_region_radius =
      1e12;  // Gauss-Newton until a step fails: damping stiffens long chains
  options.max_num_iterations = config.max_iterations;
  options.function_tolerance = config.cost_tolerance;
  options.logging_type = ceres::SILENT;
  return options;
}

ceres::Problem::Options problem_options() {
  ceres::Problem::Options options;
  options.manifold_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  options.loss_function_ownership = ceres::TAKE_OWNERSHIP;
  options.disable_all_safety_checks = true;
  return options;
}

}  // namespace

PoseGraph::Summary PoseGraph::optimize(const PoseGraphConfig& config) {
  Summary summary;
  summary.initial_cost = summary.final_cost = cost();
  summary.converged = true;
  if (edges_.empty()) return summary;

  std::vector<PoseBlock> blocks(poses_.size());
  std::transform(poses_.begin(), poses_.end(), blocks.begin(), to_block);
  const PoseManifold manifold;
  ceres::Problem problem(problem_options());
  for (PoseBlock& block : blocks)
    problem.AddParameterBlock(block.data(), 7, const_cast<PoseManifold*>(&manifold));
  for (const PoseEdge& edge : edges_) {
    ceres::LossFunction* loss = edge.cauchy_scale > 0 ? new ceres::CauchyLoss(edge.cauchy_scale) : nullptr;
    problem.AddResidualBlock(new EdgeCost(edge.T_from_to, edge.information), loss,
                             blocks[index_.at(edge.from)].data(), blocks[index_.at(edge.to)].data());
  }
  for (int id : fixed_) problem.SetParameterBlockConstant(blocks[index_.at(id)].data());
  if (fixed_.empty()) problem.SetParameterBlockConstant(blocks.front().data());

  ceres::Solver::Summary solved;
  ceres::Solve(solver_options(config), &problem, &solved);
  if (solved.IsSolutionUsable()) std::transform(blocks.begin(), blocks.end(), poses_.begin(), from_block);
  summary.final_cost = cost();
  summary.iterations = std::max(0, static_cast<int>(solved.iterations.size()) - 1);
  summary.converged = solved.termination_type == ceres::CONVERGENCE;
  return summary;
}

}  // namespace vsslam

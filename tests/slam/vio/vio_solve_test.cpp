#include <ceres/ceres.h>
#include <gtest/gtest.h>

#include "core/rng.h"
#include "slam/vio/reprojection_factor.h"
#include "slam/vio/vio_problem.h"

namespace vsslam {
namespace {

VioState state_at(const SE3& T_vio_imu) {
  VioState state;
  state.T_vio_imu = T_vio_imu;
  return state;
}

// Frames along a line that look at points ahead; every tenth sighting is far off.
struct Scene {
  LinearPrior start;  // the factors refer to it
  std::vector<WindowFactor> factors;
  WindowValues x;

  Scene(size_t frames, size_t points) {
    const RandomStream noise(7, "scene");
    uint64_t k = 0;
    const auto random = [&](double sigma) {
      k += 3;
      return Vec3(sigma * Vec3(noise.normal(k), noise.normal(k + 1), noise.normal(k + 2)));
    };
    std::vector<SE3> T_vio_imu;
    for (size_t i = 0; i < frames; ++i) {
      T_vio_imu.push_back(
          SE3::from_rpy(random(0.05), {0.1 * static_cast<double>(i), 0, 0.3 * static_cast<double>(i)}));
      x.frames.push_back(frame_blocks(state_at(T_vio_imu.back() * SE3(so3_exp(random(0.01)), random(0.05)))));
    }
    start = prior_of_state(0, state_at(T_vio_imu[0]), {0.01, 0.01, 0.01, 0.1, 0.02, 0.02});
    factors.push_back(
        {std::make_unique<PriorFactor>(start), false, {{VariableKind::pose, 0}, {VariableKind::motion, 0}}});
    const SE3 T_imu_camera = SE3::from_rpy({0.1, -0.2, 0.05}, {0.05, 0.02, 0.1});
    for (size_t p = 0; p < points; ++p) {
      const auto index = static_cast<int>(p);
      const Vec3 point_anchor(2 * noise.uniform(k), 2 * noise.uniform(k + 1) - 1,
                              4 + 6 * noise.uniform(k + 2));
      k += 3;
      const int anchor = static_cast<int>(p % (frames - 1));
      const InversePoint inverse(point_anchor.x() / point_anchor.z(), point_anchor.y() / point_anchor.z(),
                                 1 / point_anchor.z());
      x.points.push_back(inverse + random(0.01));
      factors.push_back(
          {std::make_unique<AnchorRayFactor>(inverse.head<2>(), 300), true, {{VariableKind::point, index}}});
      for (int j = anchor + 1; j < static_cast<int>(frames); ++j) {
        const Vec3 y = scaled_point_camera(T_vio_imu[static_cast<size_t>(anchor)],
                                           T_vio_imu[static_cast<size_t>(j)], T_imu_camera, inverse);
        Vec2 seen = y.hnormalized() + random(0.003).head<2>();
        if (k % 10 == 0) seen += Vec2(0.1, -0.1);
        const std::vector<Variable> variables{
            {VariableKind::pose, anchor}, {VariableKind::pose, j}, {VariableKind::point, index}};
        factors.push_back({std::make_unique<ReprojectionFactor>(T_imu_camera, seen, 300), true, variables});
        if (j == anchor + 1)
          factors.push_back({std::make_unique<DepthFactor>(T_imu_camera, y.z() / inverse.z() * 1.02, 0.03),
                             true, variables});
      }
    }
  }
};

double solved_by_ceres(Scene& scene) {
  ceres::Problem::Options keep;
  keep.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  keep.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  keep.manifold_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ceres::Problem problem(keep);
  PoseManifold manifold;
  ceres::CauchyLoss cauchy(1.0);
  for (FrameBlocks& frame : scene.x.frames) problem.AddParameterBlock(frame.pose.data(), 7, &manifold);
  for (const WindowFactor& factor : scene.factors) {
    std::vector<double*> blocks;
    for (const Variable v : factor.variables) blocks.push_back(scene.x.data(v));
    problem.AddResidualBlock(factor.cost.get(), factor.robust ? &cauchy : nullptr, blocks);
  }
  ceres::Solver::Options options;
  options.max_num_iterations = 200;
  options.function_tolerance = 1e-14;
  options.linear_solver_type = ceres::DENSE_QR;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  return summary.final_cost;
}

TEST(VioSolve, FindsTheMinimumThatCeresFinds) {
  Scene ours(6, 40), theirs(6, 40);
  const double start = window_cost(ours.factors, ours.x);
  const VioSolution solution = minimize(ours.factors, ours.x, 200, 1e-10);
  const double cost = solved_by_ceres(theirs);
  ASSERT_TRUE(solution.usable);
  EXPECT_DOUBLE_EQ(solution.initial_cost, start);
  EXPECT_LT(cost, 0.3 * start);
  EXPECT_NEAR(solution.final_cost, cost, 1e-8 * cost);
  for (size_t i = 0; i < ours.x.frames.size(); ++i) {
    const SE3 between =
        pose_of(ours.x.frames[i].pose.data()).inverse() * pose_of(theirs.x.frames[i].pose.data());
    EXPECT_LT(between.log().norm(), 1e-5) << i;
  }
}

TEST(VioSolve, EveryStepLowersTheCost) {
  Scene scene(4, 20);
  double cost = window_cost(scene.factors, scene.x);
  for (int i = 0; i < 6; ++i) {
    const VioSolution one = minimize(scene.factors, scene.x, 1);
    EXPECT_EQ(one.initial_cost, cost);
    EXPECT_LE(one.final_cost, cost);
    EXPECT_EQ(one.final_cost, window_cost(scene.factors, scene.x));
    cost = one.final_cost;
  }
}

TEST(VioSolve, PredictsTheCostNearby) {
  Scene scene(4, 20);
  WindowEquations equations(scene.factors, scene.x.points.size());
  equations.linearize(scene.x, scene.x);
  const Eigen::VectorXd g = equations.gradient();
  const RandomStream random(1, "direction");
  Eigen::VectorXd v(g.size());
  for (Eigen::Index i = 0; i < v.size(); ++i) v[i] = 1e-5 * random.normal(static_cast<uint64_t>(i));
  const double up = window_cost(scene.factors, equations.moved(scene.x, v)),
               down = window_cost(scene.factors, equations.moved(scene.x, -v));
  EXPECT_NEAR((up - down) / 2, g.dot(v), 1e-5 * std::abs(g.dot(v)));
  // The step solves the whole system, points and all: H dx = -b makes b' dx = -dx' H dx.
  const auto dx = equations.newton_step(Eigen::VectorXd::Constant(g.size(), 1e-9));
  ASSERT_TRUE(dx);
  EXPECT_NEAR(g.dot(*dx), -equations.curvature(*dx), 1e-6 * std::abs(g.dot(*dx)));
  // And H is symmetric: u' H v by polarisation, both ways through the same step.
  const double vHdx = 0.25 * (equations.curvature(v + *dx) - equations.curvature(v - *dx));
  EXPECT_NEAR(vHdx, -g.dot(v), 1e-6 * std::abs(g.dot(v)));
}

TEST(VioSolve, WhatIsNotANumberIsNotUsable) {
  Scene scene(3, 5);
  scene.x.points[0].x() = std::nan("");
  EXPECT_FALSE(minimize(scene.factors, scene.x, 8).usable);
}

}  // namespace
}  // namespace vsslam

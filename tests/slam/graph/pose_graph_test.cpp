#include "slam/graph/pose_graph.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <unsupported/Eigen/MatrixFunctions>

#include "slam/graph/edge_cost.h"
#include "tests/slam/graph/graph_worlds.h"

namespace vsslam {
namespace {

double largest_distance(const PoseGraph& graph, const std::vector<SE3>& poses) {
  double largest = 0;
  for (size_t i = 0; i < poses.size(); ++i)
    largest = std::max(largest, (poses[i].inverse() * graph.pose(graph.ids()[i])).log().norm());
  return largest;
}

/// Moves every node but the first.
PoseGraph shaken(const PoseGraph& graph, double rotation_rad, double translation_m) {
  PoseGraph out;
  const RandomStream stream(3, "shake");
  for (int id : graph.ids())
    out.add_node(id, id == 0 ? graph.pose(id)
                             : graph.pose(id) * SE3::exp(noise(stream, id, rotation_rad, translation_m)));
  for (const PoseEdge& edge : graph.edges()) out.add_edge(edge);
  return out;
}

// An independent twin: 4 x 4 matrices, the general matrix logarithm, difference quotients, a dense solver.
class DenseTwin {
 public:
  explicit DenseTwin(const PoseGraph& graph) : graph_(graph) {
    for (int id : graph.ids()) poses_.push_back(graph.pose(id).matrix4());
  }

  double cost() const {
    double sum = 0;
    for (const PoseEdge& e : graph_.edges()) {
      const Vec6 r = error(e, pose(e.from), pose(e.to));
      sum += r.dot(e.information * r);
    }
    return sum;
  }

  void gauss_newton(int iterations) {
    const int n = static_cast<int>(poses_.size());
    for (int k = 0; k < iterations; ++k) {
      Eigen::MatrixXd H = Eigen::MatrixXd::Zero(6 * n, 6 * n);
      Eigen::VectorXd g = Eigen::VectorXd::Zero(6 * n);
      for (const PoseEdge& e : graph_.edges()) {
        Eigen::Matrix<double, 6, 12> J;
        for (int c = 0; c < 6; ++c) {
          J.col(c) = slope(e, c, true);
          J.col(c + 6) = slope(e, c, false);
        }
        const Vec6 r = error(e, pose(e.from), pose(e.to));
        const int at[2] = {6 * e.from, 6 * e.to};
        for (int a = 0; a < 2; ++a) {
          g.segment<6>(at[a]) += J.middleCols<6>(6 * a).transpose() * e.information * r;
          for (int b = 0; b < 2; ++b)
            H.block<6, 6>(at[a], at[b]) +=
                J.middleCols<6>(6 * a).transpose() * e.information * J.middleCols<6>(6 * b);
        }
      }
      const Eigen::VectorXd step = H.bottomRightCorner(6 * n - 6, 6 * n - 6).ldlt().solve(-g.tail(6 * n - 6));
      for (int i = 1; i < n; ++i) poses_[static_cast<size_t>(i)] *= exp(step.segment<6>(6 * (i - 1)));
    }
  }

 private:
  static Eigen::Matrix4d exp(const Vec6& xi) {
    Eigen::Matrix4d m = Eigen::Matrix4d::Zero();
    m.topLeftCorner<3, 3>() = hat(xi.head<3>());
    m.topRightCorner<3, 1>() = xi.tail<3>();
    return m.exp();
  }
  static Vec6 error(const PoseEdge& e, const Eigen::Matrix4d& from, const Eigen::Matrix4d& to) {
    const Eigen::Matrix4d m = (e.T_from_to.matrix4().inverse() * from.inverse() * to).log();
    Vec6 r;
    r << m(2, 1), m(0, 2), m(1, 0), m(0, 3), m(1, 3), m(2, 3);
    return r;
  }
  Vec6 slope(const PoseEdge& e, int k, bool of_from) const {
    const double h = 1e-6;
    const Eigen::Matrix4d up = exp(h * Vec6::Unit(k)), down = exp(-h * Vec6::Unit(k));
    const Eigen::Matrix4d &a = pose(e.from), &b = pose(e.to);
    const Vec6 d =
        of_from ? error(e, a * up, b) - error(e, a * down, b) : error(e, a, b * up) - error(e, a, b * down);
    return d / (2 * h);
  }
  const Eigen::Matrix4d& pose(int id) const { return poses_[static_cast<size_t>(id)]; }

  const PoseGraph& graph_;
  std::vector<Eigen::Matrix4d> poses_;
};

TEST(PoseGraphConfig, OdometryWeighsByItsCovarianceOrByWhatIsSet) {
  Mat6 covariance = Mat6::Identity();
  covariance(0, 3) = covariance(3, 0) = 0.5;
  covariance(5, 5) = 4;
  PoseGraphConfig config;
  EXPECT_LT((config.odometry_information(covariance) * covariance - Mat6::Identity()).norm(), 1e-12);
  config.odometry_translation_variance_m2 = 0.01;
  const Mat6 information = config.odometry_information(covariance);
  EXPECT_NEAR(information(0, 0), 1, 1e-12);
  EXPECT_NEAR(information(5, 5), 100, 1e-9);
  EXPECT_NEAR(information(0, 3), 0, 1e-12);
}

TEST(PoseGraph, JacobiansOfAnEdgeAgreeWithDifferences) {
  const RandomStream stream(2, "poses");
  for (int i = 0; i < 20; ++i) {
    const double turn = i < 10 ? 0.01 : 0.6;  // near the measurement and far from it
    const SE3 a = SE3::exp(noise(stream, 3 * i, 1, 3)), Z = SE3::exp(noise(stream, 3 * i + 1, 1, 3));
    const SE3 b = a * Z * SE3::exp(noise(stream, 3 * i + 2, turn, 1));
    const EdgeCost cost(Z, random_information(i));
    const PoseBlock block_a = to_block(a), block_b = to_block(b);
    const double* blocks[] = {block_a.data(), block_b.data()};
    Vec6 r;
    Eigen::Matrix<double, 6, 7, Eigen::RowMajor> J[2];
    double* slopes[] = {J[0].data(), J[1].data()};
    ASSERT_TRUE(cost.Evaluate(blocks, r.data(), slopes));
    for (int block = 0; block < 2; ++block)
      for (int k = 0; k < 6; ++k) {
        const double h = 1e-6;
        Vec6 moved[2];
        for (int side = 0; side < 2; ++side) {
          const PoseBlock m = to_block((block == 0 ? a : b) * SE3::exp((side ? h : -h) * Vec6::Unit(k)));
          const double* at[] = {block == 0 ? m.data() : block_a.data(),
                                block == 1 ? m.data() : block_b.data()};
          ASSERT_TRUE(cost.Evaluate(at, moved[side].data(), nullptr));
        }
        EXPECT_LT(((moved[1] - moved[0]) / (2 * h) - J[block].col(k)).norm(), 1e-6 * (1 + J[block].norm()));
      }
    EXPECT_NEAR(r.squaredNorm(), edge_error(Z, a, b).dot(random_information(i) * edge_error(Z, a, b)), 1e-9);
  }
}

TEST(PoseGraph, ManifoldPlusAndMinusInvert) {
  const PoseManifold manifold;
  const RandomStream stream(4, "poses");
  for (int i = 0; i < 10; ++i) {
    const PoseBlock x = to_block(SE3::exp(noise(stream, i, 1, 3)));
    const Vec6 xi = noise(stream, 100 + i, 0.3, 1);
    PoseBlock y;
    Vec6 back;
    ASSERT_TRUE(manifold.Plus(x.data(), xi.data(), y.data()));
    ASSERT_TRUE(manifold.Minus(y.data(), x.data(), back.data()));
    EXPECT_LT((back - xi).norm(), 1e-12);
  }
}

TEST(PoseGraph, ExactMeasurementsGiveTheTruthBack) {
  const GraphWorld worlds[] = {surface_world(8, 25, 0, 20), surface_world(8, 25, 15, 4),
                               manhattan_world(200)};
  for (const GraphWorld& world : worlds) {
    PoseGraph graph = shaken(measure(world, 0, 0, true), 0.1, 0.5);
    ASSERT_GT(graph.edges().size(), world.truth.size());
    ASSERT_GT(graph.cost(), 10);
    const PoseGraph::Summary summary = graph.optimize({});
    EXPECT_LT(summary.final_cost, 1e-9);
    EXPECT_TRUE(summary.converged);
    EXPECT_LT(largest_distance(graph, world.truth), 1e-5);
    EXPECT_EQ(graph.pose(0).translation, world.truth[0].translation);
  }
}

TEST(PoseGraph, NoisyMeasurementsGiveTheOptimumOfADenseTwin) {
  const GraphWorld worlds[] = {surface_world(4, 10, 0, 5), manhattan_world(40)};
  for (const GraphWorld& world : worlds) {
    PoseGraph graph = measure(world, 0.02, 0.05, true);
    DenseTwin twin(graph);
    EXPECT_NEAR(graph.cost(), twin.cost(), 1e-7 * twin.cost());
    twin.gauss_newton(10);
    const PoseGraph::Summary summary = graph.optimize({});
    EXPECT_GT(summary.initial_cost, 2 * summary.final_cost);
    EXPECT_NEAR(summary.final_cost, twin.cost(), 1e-7 * twin.cost());
    EXPECT_EQ(summary.final_cost, graph.cost());
  }
}

TEST(PoseGraph, SameBytesTwice) {
  const GraphWorld world = surface_world(10, 40, 10, 5);
  PoseGraph a = measure(world, 0.02, 0.05, true), b = measure(world, 0.02, 0.05, true);
  a.optimize({});
  b.optimize({});
  EXPECT_EQ(a.g2o_text(), b.g2o_text());
}

TEST(PoseGraph, ASecondSolveStartsFromTheFirst) {
  PoseGraph graph = measure(surface_world(6, 20, 0, 10), 0.02, 0.05, true);
  const int cold = graph.optimize({}).iterations;
  EXPECT_LT(graph.optimize({}).iterations, std::max(2, cold));
}

TEST(PoseGraph, FixedNodesStay) {
  const GraphWorld world = surface_world(4, 20, 0, 10);
  PoseGraph graph = shaken(measure(world, 0, 0, false), 0.05, 0.2);
  const SE3 first = graph.pose(0), other = graph.pose(30);
  graph.fix_node(30);
  graph.optimize({});
  EXPECT_EQ(graph.pose(30).translation, other.translation);
  EXPECT_NE(graph.pose(0).translation, first.translation);  // a fixed node takes the first one's place
}

TEST(PoseGraph, CauchyKernelShrugsOffAFalseLoop) {
  const GraphWorld world = surface_world(4, 20, 0, 10);
  for (double cauchy_scale : {0.0, 1.0}) {
    PoseGraph graph = measure(world, 0, 0, false);
    PoseEdge lie;
    lie.from = 5;
    lie.to = 60;
    lie.T_from_to = SE3(Quat::Identity(), {40, 0, 0});
    lie.cauchy_scale = cauchy_scale;
    graph.add_edge(lie);
    graph.optimize({});
    if (cauchy_scale > 0) {
      EXPECT_LT(largest_distance(graph, world.truth), 0.3);
    } else {
      EXPECT_GT(largest_distance(graph, world.truth), 1);
    }
  }
}

TEST(PoseGraph, WithoutEdgesNothingMoves) {
  PoseGraph graph;
  EXPECT_EQ(graph.optimize({}).final_cost, 0);
  graph.add_node(4, SE3());
  EXPECT_TRUE(graph.optimize({}).converged);
}

TEST(PoseGraph, UnconnectedPartsAreSolvedWhereTheyAre) {
  PoseGraph graph;
  for (int i = 0; i < 4; ++i) graph.add_node(i, SE3(Quat::Identity(), {2.0 * i, 0, 0}));
  for (int i : {0, 2})
    graph.add_edge({.from = i, .to = i + 1, .T_from_to = SE3(Quat::Identity(), {1, 0, 0})});
  const PoseGraph::Summary summary = graph.optimize({});
  EXPECT_DOUBLE_EQ(summary.initial_cost, 2);
  EXPECT_LT(summary.final_cost, 1e-9);
}

}  // namespace
}  // namespace vsslam

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "core/errors.h"
#include "core/files.h"
#include "slam/graph/pose_graph.h"
#include "tests/scratch.h"
#include "tests/slam/graph/graph_worlds.h"

namespace vsslam {
namespace {

using testing::AllOf;
using testing::HasSubstr;

const std::string kVertices =
    "VERTEX_SE3:QUAT 0 0 0 0 0 0 0 1\n"
    "VERTEX_SE3:QUAT 7 1 2 3 0 0 0.7071067811865476 0.7071067811865476\n";
const std::string kIdentity21 = " 1 0 0 0 0 0 1 0 0 0 0 1 0 0 0 1 0 0 1 0 1";

std::string error_of(const std::string& text) {
  try {
    PoseGraph::parse_g2o(text, "some.g2o");
  } catch (const InputError& e) {
    return e.what();
  }
  return "no error";
}

TEST(G2o, InformationIsTranslationFirst) {
  // Omega = diag(1 2 3 | 4 5 6) with 0.5 between x and the rotation about x.
  const PoseGraph graph = PoseGraph::parse_g2o(
      kVertices + "EDGE_SE3:QUAT 0 7 1 0 0 0 0 0 1 1 0 0 0.5 0 0 2 0 0 0 0 3 0 0 0 4 0 0 5 0 6\n",
      "some.g2o");
  ASSERT_EQ(graph.edges().size(), 1u);
  const Mat6& information = graph.edges()[0].information;
  Vec6 diagonal;
  diagonal << 4, 5, 6, 1, 2, 3;
  EXPECT_EQ(Vec6(information.diagonal()), diagonal);
  EXPECT_EQ(information(0, 3), 0.5);
  EXPECT_EQ(information(3, 0), 0.5);
  EXPECT_EQ(graph.pose(7).translation, Vec3(1, 2, 3));
}

TEST(G2o, CostByHand) {
  // A pure rotation error of 90 deg about z and a pure translation error, each with weight 3.
  const std::string weights = " 3 0 0 0 0 0 3 0 0 0 0 3 0 0 0 3 0 0 3 0 3\n";
  const PoseGraph turned = PoseGraph::parse_g2o(
      "VERTEX_SE3:QUAT 0 0 0 0 0 0 0 1\nVERTEX_SE3:QUAT 1 1 0 0 0 0 1 1\nEDGE_SE3:QUAT 0 1 1 0 0 0 0 0 1" +
          weights,
      "turned.g2o");
  EXPECT_NEAR(turned.cost(), 3 * M_PI * M_PI / 4, 1e-12);
  const PoseGraph moved = PoseGraph::parse_g2o(
      "VERTEX_SE3:QUAT 0 0 0 0 0 0 0 1\nVERTEX_SE3:QUAT 1 1 2 3 0 0 0 1\nEDGE_SE3:QUAT 0 1 1 0 0 0 0 0 1" +
          weights,
      "moved.g2o");
  EXPECT_NEAR(moved.cost(), 3 * (4 + 9), 1e-12);
}

TEST(G2o, RoundTripIsExact) {
  PoseGraph graph = measure(surface_world(5, 12, 4, 2), 0.05, 0.1, true);
  graph.fix_node(3);
  graph.optimize({});
  const std::filesystem::path path = scratch_folder() / "round_trip.g2o";
  graph.write_g2o(path);
  const PoseGraph back = PoseGraph::read_g2o(path);
  EXPECT_EQ(read_file(path), back.g2o_text());
  EXPECT_EQ(back.ids(), graph.ids());
  EXPECT_EQ(back.fixed(), graph.fixed());
  ASSERT_EQ(back.edges().size(), graph.edges().size());
  for (size_t i = 0; i < graph.edges().size(); ++i) {
    EXPECT_EQ(back.edges()[i].information, graph.edges()[i].information);
    EXPECT_EQ(back.edges()[i].T_from_to.translation, graph.edges()[i].T_from_to.translation);
    EXPECT_EQ(back.edges()[i].T_from_to.rotation.coeffs(), graph.edges()[i].T_from_to.rotation.coeffs());
  }
  EXPECT_EQ(back.cost(), graph.cost());
}

TEST(G2o, CommentsBlankLinesWindowsLineEndsAndOrderDoNotMatter) {
  const PoseGraph graph = PoseGraph::parse_g2o(
      "# a comment\r\n\r\nFIX 7\r\nPARAMS_SE3OFFSET 0 0 0 0 0 0 0 1\n"
      "EDGE_SE3:QUAT 0 7\t+1 0 0 0 0 0 1" +
          kIdentity21 + " # measured twice\n" + kVertices,
      "some.g2o");
  EXPECT_EQ(graph.ids(), (std::vector<int>{0, 7}));
  EXPECT_EQ(graph.fixed(), std::vector<int>{7});
}

TEST(G2o, QuaternionsOfFewDigitsAreNormalised) {
  const PoseGraph graph = PoseGraph::parse_g2o("VERTEX_SE3:QUAT 0 0 0 0 0 0 0.71 0.71\n", "some.g2o");
  EXPECT_NEAR(graph.pose(0).rotation.norm(), 1, 1e-15);
}

TEST(G2o, BadLinesAreNamed) {
  const auto bad_edge = [&](const std::string& line) { return error_of(kVertices + line + "\n"); };
  const std::string edge = "EDGE_SE3:QUAT 0 7 0 0 0 0 0 0 1";
  EXPECT_THAT(error_of("VERTEX_SE3:QUAT 0 0 0 nan 0 0 0 1\n"),
              AllOf(HasSubstr("some.g2o:1: "), HasSubstr("finite")));
  EXPECT_THAT(error_of("\nVERTEX_SE3:QUAT 0 0 0 1e999 0 0 0 1\n"), HasSubstr("some.g2o:2: "));
  EXPECT_THAT(error_of("VERTEX_SE3:QUAT 0 0 0 0 0 0 0 0\n"), HasSubstr("quaternion"));
  EXPECT_THAT(error_of("VERTEX_SE3:QUAT 0 0 0 0 0 0 1\n"), HasSubstr("expected 8 values, got 7"));
  EXPECT_THAT(error_of("VERTEX_SE3:QUAT x 0 0 0 0 0 0 1\n"), HasSubstr("vertex id"));
  EXPECT_THAT(error_of("VERTEX_SE3:QUAT 99999999999 0 0 0 0 0 0 1\n"), HasSubstr("vertex id"));
  EXPECT_THAT(error_of(kVertices + kVertices), AllOf(HasSubstr("some.g2o:3: "), HasSubstr("twice")));
  EXPECT_THAT(error_of(kVertices + "VERTEX_XY 3 0 0\n"), AllOf(HasSubstr(":3: "), HasSubstr("VERTEX_XY")));
  EXPECT_THAT(error_of(kVertices + "FIX 9\n"), AllOf(HasSubstr(":3: "), HasSubstr("does not exist")));
  EXPECT_THAT(error_of("FIX\n"), HasSubstr("at least one"));
  EXPECT_THAT(bad_edge("EDGE_SE3:QUAT 0 8 0 0 0 0 0 0 1" + kIdentity21),
              AllOf(HasSubstr("some.g2o:3: "), HasSubstr("vertex 8 does not exist")));
  EXPECT_THAT(bad_edge("EDGE_SE3:QUAT 7 7 0 0 0 0 0 0 1" + kIdentity21), HasSubstr("itself"));
  EXPECT_THAT(bad_edge(edge), HasSubstr("expected 30 values, got 9"));
  EXPECT_THAT(bad_edge(edge + kIdentity21 + " 1"), HasSubstr("got 31"));
  EXPECT_THAT(bad_edge(edge + " 1 0 0 0 0 0 1 0 0 0 0 1 0 0 0 1 0 0 1 0 -1"), HasSubstr("positive definite"));
  EXPECT_THAT(bad_edge(edge + " 1 2 0 0 0 0 1 0 0 0 0 1 0 0 0 1 0 0 1 0 1"), HasSubstr("positive definite"));
  EXPECT_THAT(bad_edge(edge + " 1 0 0 0 0 0 1 0 0 0 0 1 0 0 0 1 0 0 1 0 inf"), HasSubstr("finite"));
  EXPECT_THAT(bad_edge("EDGE_SE3:QUAT 0 7 1e300 0 0 0 0 0 1" + kIdentity21), HasSubstr("too large"));
}

TEST(G2o, SmallWeightsArePositiveDefiniteToo) {
  const std::string text =
      kVertices +
      "EDGE_SE3:QUAT 0 7 0 0 0 0 0 0 1 1e-12 0 0 0 0 0 1e-12 0 0 0 0 1e-12 0 0 0 1e12 0 0 1e12 "
      "0 1e12\n";
  EXPECT_EQ(error_of(text), "no error");
}

TEST(G2o, AMissingFileIsBadInput) {
  EXPECT_THROW(PoseGraph::read_g2o("/nowhere/at/all.g2o"), InputError);
}

}  // namespace
}  // namespace vsslam

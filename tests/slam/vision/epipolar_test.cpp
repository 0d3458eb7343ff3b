#include "slam/vision/epipolar.h"

#include <gtest/gtest.h>

#include <numeric>
#include <opencv2/core.hpp>

#include "core/rng.h"
#include "slam/vision/essential.h"

namespace vsslam {
namespace {

const RandomStream kRandom(1, "epipolar test");
constexpr double kPixel = 1 / 460.0;

Vec3 unit_depth(const Vec3& p) {
  return p / p.z();
}

// Matches of 100 points, from 2 to 12 m deep or all on one plane, seen before and after the motion.
std::vector<RayMatch> matches(const SE3& T_last_now, bool plane, double noise_px = 0.2) {
  std::vector<RayMatch> result;
  for (uint64_t i = 0; i < 100; ++i) {
    const Vec3 ray(1.4 * kRandom.uniform(i, 0) - 0.7, kRandom.uniform(i, 1) - 0.5, 1);
    const double depth_m = plane ? 5 / (1 + 0.4 * ray.x()) : 2 + 10 * kRandom.uniform(i, 2);
    const Vec3 noise(kRandom.normal(i, 3), kRandom.normal(i, 4), 0);
    result.push_back({ray, unit_depth(T_last_now.inverse() * (depth_m * ray)) + noise_px * kPixel * noise});
  }
  return result;
}
int count(const std::vector<uint8_t>& flags) {
  return std::accumulate(flags.begin(), flags.end(), 0);
}

const SE3 kForward(so3_exp({0.01, 0.03, -0.01}), {0.02, 0.01, 0.15});
const SE3 kSideways(so3_exp({0, 0.05, 0}), {0.1, 0.01, 0.01});
const SE3 kTurn(so3_exp({0.01, 0.06, 0.01}), Vec3::Zero());
const SE3 kStill;

TEST(Epipolar, KeepsEveryMatchOfARigidScene) {
  for (const SE3& T_last_now : {kForward, kSideways, kTurn, kStill})
    for (const bool plane : {false, true})
      EXPECT_GE(count(rigid_motion(matches(T_last_now, plane), &T_last_now.rotation, {1}, {}).fits), 99);
}

TEST(Epipolar, KeepsNearlyEveryMatchWithoutAGyroscope) {
  for (const SE3& T_last_now : {kForward, kSideways, kTurn, kStill})
    for (const bool plane : {false, true})  // a plane has a twin motion that fits nearly as well
      EXPECT_GE(count(rigid_motion(matches(T_last_now, plane), nullptr, {1}, {}).fits), plane ? 75 : 96);
}

TEST(Epipolar, DropsWhatMovesByItself) {
  for (const SE3& T_last_now : {kForward, kSideways, kTurn, kStill})
    for (const bool with_rotation : {true, false}) {
      std::vector<RayMatch> mixed = matches(T_last_now, false);
      for (size_t i = 0; i < 30; ++i)  // a third moves 5 px, across the flow of the rest
        mixed[i].now += Vec3(-mixed[i].last.y(), mixed[i].last.x() + 0.1, 0).normalized() * 5 * kPixel;
      const auto fits = rigid_motion(mixed, with_rotation ? &T_last_now.rotation : nullptr, {1}, {}).fits;
      EXPECT_LE(std::accumulate(fits.begin(), fits.begin() + 30, 0), 8);
      EXPECT_GE(std::accumulate(fits.begin() + 30, fits.end(), 0), with_rotation ? 69 : 62);
    }
}

TEST(Epipolar, DropsWhatWouldLieBehindTheCamera) {
  std::vector<RayMatch> mixed = matches(kSideways, false, 0);
  const Mat3 R_now_last = kSideways.rotation.conjugate().toRotationMatrix();
  for (size_t i = 0; i < 20; ++i) {
    const Vec3 turned = unit_depth(R_now_last * mixed[i].last);
    mixed[i].now = turned - (mixed[i].now - turned);  // on its epipolar line, the wrong way
  }
  const auto fits = rigid_motion(mixed, &kSideways.rotation, {1}, {}).fits;
  for (size_t i = 0; i < 100; ++i) {
    const double flow_px = (mixed[i].now - unit_depth(R_now_last * mixed[i].last)).norm() / kPixel;
    EXPECT_TRUE(flow_px < 1.1 || fits[i] == (i >= 20)) << i;
  }
}

TEST(Epipolar, RecoversFromAWrongRotation) {
  const Quat spike = so3_exp({0.2, -0.1, 0.3});
  const RigidMotion motion = rigid_motion(matches(kForward, false), &spike, {1}, {});
  EXPECT_GE(count(motion.fits), 95);
  EXPECT_LT(motion.q_last_now.angularDistance(kForward.rotation), 0.01);
}

TEST(Epipolar, EstimatesTheRotation) {
  for (const SE3& T_last_now : {kForward, kSideways, kTurn}) {
    const auto q_last_now = rotation_of_matches(matches(T_last_now, false, 0.05), kPixel);
    ASSERT_TRUE(q_last_now);
    EXPECT_LT(q_last_now->angularDistance(T_last_now.rotation), 0.01);
  }
}

TEST(Epipolar, FewOrEqualMatchesDoNotMatter) {
  for (size_t n = 0; n < 6; ++n) {
    std::vector<RayMatch> few = matches(kForward, false);
    few.resize(n);
    EXPECT_EQ(rigid_motion(few, nullptr, {1}, {}).fits, std::vector<uint8_t>(n, 1));
  }
  const std::vector<RayMatch> equal(50, {{0.1, 0.2, 1}, {0.3, 0.2, 1}});
  EXPECT_EQ(rigid_motion(equal, nullptr, {1}, {}).fits.size(), 50u);
  const std::vector<RayMatch> still(50, {{0.1, 0.2, 1}, {0.1, 0.2, 1}});
  EXPECT_EQ(count(rigid_motion(still, nullptr, {1}, {}).fits), 50);
}

TEST(Epipolar, SameMatchesSameAnswer) {
  std::vector<RayMatch> mixed = matches(kForward, false, 1.0);
  for (const bool with_rotation : {true, false}) {
    const Quat* rotation = with_rotation ? &kForward.rotation : nullptr;
    const RigidMotion once = rigid_motion(mixed, rotation, {7}, {});
    cv::theRNG().state = 99;
    const RigidMotion again = rigid_motion(mixed, rotation, {7}, {});
    EXPECT_EQ(again.fits, once.fits);
    EXPECT_EQ(again.q_last_now.coeffs(), once.q_last_now.coeffs());
  }
}

}  // namespace
}  // namespace vsslam

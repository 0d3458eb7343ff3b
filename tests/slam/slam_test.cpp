#include "slam/slam.h"

#include <gtest/gtest.h>

#include "tests/slam/drive.h"

namespace vsslam {
namespace {

using namespace testing_scene;

Motion circle_in_room() {
  return [](double t) {
    const double u = std::max(t - 1.0, 0.0);
    const double angle = 0.3 * (u < 1 ? u * u * u * (1 - u / 2) : u - 0.5);
    return SE3::from_rpy({0, 0, angle + 0.5 * std::numbers::pi},
                         {1.8 * std::cos(angle) - 0.5, 1.8 * std::sin(angle), 0.2});
  };
}

TEST(Slam, HoldsItsPlaceInARoomToMillimetres) {
  DriveOptions options;
  options.duration_s = 12;
  const Driven driven = drive(room(), circle_in_room(), options);
  EXPECT_LT(driven.position_rmse_m, 0.005);
  EXPECT_LT(driven.worst_m, 0.02);
  EXPECT_LT(driven.worst_rotation_rad, 0.003);
  for (size_t i = 1; i < driven.reports.size(); ++i) {
    EXPECT_TRUE(driven.reports[i].converged) << i;
    EXPECT_LE(driven.reports[i].degenerate_directions, 1) << i;
  }
}

}  // namespace
}  // namespace vsslam

#include "slam/vision/camera_model.h"

#include <gtest/gtest.h>

namespace vsslam {
namespace {

CameraCalibration distorted() {
  CameraCalibration c;
  c.k1 = -0.28;
  c.k2 = 0.07;
  c.p1 = 0.001;
  c.p2 = -0.002;
  return c;
}

TEST(CameraModel, DistortsByBrownsFormula) {
  // x = 0.3, y = -0.2: r2 = 0.13, radial = 1 - 0.28 * 0.13 + 0.07 * 0.0169 = 0.964783.
  // x' = 0.3 * 0.964783 + 2 * 0.001 * -0.06 - 0.002 * (0.13 + 0.18) = 0.2886949
  // y' = -0.2 * 0.964783 + 0.001 * (0.13 + 0.08) + 2 * -0.002 * -0.06 = -0.1925066
  const CameraCalibration c = distorted();
  const Vec2 pixel = CameraModel(c).pixel_px({0.3, -0.2});
  EXPECT_NEAR(pixel.x(), c.cx_px + c.fx_px * 0.2886949, 1e-9);
  EXPECT_NEAR(pixel.y(), c.cy_px + c.fy_px * -0.1925066, 1e-9);
}

TEST(CameraModel, UndistortsExactly) {
  for (const CameraCalibration& c : {distorted(), CameraCalibration{}}) {
    const CameraModel camera(c);
    for (double y = 0; y < c.height_px; y += 17)
      for (double x = 0; x < c.width_px; x += 13) {
        const auto ray = camera.ray_camera({x, y});
        ASSERT_TRUE(ray) << x << " " << y;
        EXPECT_LT((camera.pixel_px(*ray) - Vec2(x, y)).norm(), 1e-9);
      }
  }
}

TEST(CameraModel, HasNoDirectionBeyondTheFold) {
  CameraCalibration c;
  c.k1 = -0.5;  // r (1 - r2 / 2) never exceeds 0.544
  const CameraModel camera(c);
  EXPECT_TRUE(camera.ray_camera({c.cx_px + 0.53 * c.fx_px, c.cy_px}));
  EXPECT_FALSE(camera.ray_camera({c.cx_px + 0.56 * c.fx_px, c.cy_px}));
}

}  // namespace
}  // namespace vsslam

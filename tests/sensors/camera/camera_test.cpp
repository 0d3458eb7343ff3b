#include "sensors/camera/camera.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/errors.h"
#include "core/ordered_parallel.h"
#include "tests/sensors/camera/views.h"

namespace vsslam {
namespace {

CameraConfig distorted(CameraConfig config) {
  config.k1 = -0.28, config.k2 = 0.07, config.p1 = 1e-3, config.p2 = -5e-4;
  return config;
}

TEST(CameraOptics, RaysProjectToTheirPixels) {
  for (const CameraConfig& config : {CameraConfig{}, distorted({})}) {
    const CameraOptics optics(config);
    for (double y = -0.5; y < 480; y += 31.3)
      for (double x = -0.5; x < 640; x += 37.7) {
        const Vec2 pixel = *optics.project(3 * optics.ray({x, y}));
        EXPECT_NEAR(pixel.x(), x, 1e-9);
        EXPECT_NEAR(pixel.y(), y, 1e-9);
      }
    EXPECT_FALSE(optics.project({0.1, 0.1, -1}));
    EXPECT_FALSE(optics.project({0.1, 0.1, 0}));
  }
}

TEST(CameraOptics, DistortsAsOpenCvDoes) {
  // x = 0.5, y = -0.2: r^2 = 0.29, radial 1 - 0.0812 + 0.005887, tangential by hand.
  const CameraOptics optics(distorted({}));
  const double radial = 0.924687;
  const double x = 0.5 * radial + 2 * 1e-3 * 0.5 * -0.2 - 5e-4 * (0.29 + 2 * 0.25);
  const double y = -0.2 * radial + 1e-3 * (0.29 + 2 * 0.04) + 2 * -5e-4 * 0.5 * -0.2;
  const Vec2 pixel = *optics.project({1, -0.4, 2});
  EXPECT_NEAR(pixel.x(), 384.2 * x + 319.5, 1e-9);
  EXPECT_NEAR(pixel.y(), 384.2 * y + 236.4, 1e-9);
}

TEST(CameraOptics, RefusesADistortionThatFolds) {
  CameraConfig config;
  config.k1 = -0.6;
  EXPECT_THROW(CameraOptics(config).rays(), InputError);
}

/// The saddle of the brightness near `at`: of a quadratic fitted to a small window, again and again around the last one.
Vec2 corner_near(const std::vector<float>& grey, int width, Vec2 at) {
  const Vec2 start = at;
  for (int round = 0; round < 12 && (at - start).norm() < 3; ++round) {
    Mat6 A = Mat6::Zero();
    Vec6 b = Vec6::Zero();
    const int cx = static_cast<int>(std::lround(at.x())), cy = static_cast<int>(std::lround(at.y()));
    for (int y = cy - 5; y <= cy + 5; ++y)
      for (int x = cx - 5; x <= cx + 5; ++x) {
        const double dx = x - at.x(), dy = y - at.y(),
                     weight = std::exp(-(dx * dx + dy * dy) / (2 * 1.2 * 1.2));
        const Vec6 row{{1, dx, dy, dx * dx / 2, dx * dy, dy * dy / 2}};
        A += weight * row * row.transpose();
        b += weight * static_cast<double>(grey[static_cast<size_t>(y * width + x)]) * row;
      }
    const Vec6 c = A.ldlt().solve(b);
    Eigen::Matrix2d hessian;
    hessian << c[3], c[4], c[4], c[5];
    at -= hessian.inverse() * Vec2(c[1], c[2]);
  }
  return at;
}

// Corners in the image against the projection of the corners in the world. The squares' edges are soft over a few mm,
// so that one ray per pixel samples them without aliasing.
void expect_corners_in_place(CameraConfig config) {
  config.gain = 1;
  config.truth.clean = true;
  const double cell_m = 0.12, distance_m = 1.0;
  const auto wave = [=](double x) { return std::tanh(3 * std::sin(std::numbers::pi * x / cell_m)); };
  const auto board =
      views::plane(distance_m, [=](double x, double y) { return 85 + 65 * wave(x) * wave(y); });
  const SE3 T_world_camera = SE3::from_rpy({0.12, -0.2, 0.3}, {0.03, -0.02, 0.05});
  const auto images = views::film(config, 1, board, shapes::at_rest(T_world_camera, 0.3));
  const CameraOptics optics(config);
  int corners = 0;
  double worst_px = 0;
  for (int i = -20; i <= 20; ++i)
    for (int j = -20; j <= 20; ++j) {
      const auto truth = optics.project(T_world_camera.inverse() * Vec3(i * cell_m, j * cell_m, distance_m));
      if (!truth || (truth->array() < 10).any() || truth->x() > config.width_px - 11 ||
          truth->y() > config.height_px - 11)
        continue;
      ++corners;
      const Vec2 found = corner_near(images[0].clean_grey, config.width_px, *truth + Vec2(0.4, -0.3));
      worst_px = std::max(worst_px, (found - *truth).norm());
    }
  EXPECT_GT(corners, 100);
  EXPECT_LT(worst_px, 0.02);
}

TEST(Camera, CornersOfAChequerboardAreInPlace) {
  expect_corners_in_place(CameraConfig::ideal());
  expect_corners_in_place(distorted(CameraConfig::ideal()));
}

TEST(Camera, StampsAreTheMiddleOfTheExposureAtThirtyHertz) {
  CameraConfig config = views::small_ideal();
  config.exposure_s = 0.002000003;  // an odd number of ns
  Camera camera(config, {}, 1);
  camera.power_on(Time{0});
  const Trajectory rest = shapes::at_rest(SE3(), 3);
  int64_t index = 1;  // the exposure of image 0 would begin before time 0
  for (int i = 0; i < 60; ++i, ++index) {
    const Time begin = camera.begin(), end = camera.end();
    const CameraMeasurement image = camera.take(1, rest, SE3(), views::even(10)).at(0);
    EXPECT_EQ(image.true_stamp.ns, std::llround(static_cast<double>(index) * 1e9 / 30));
    EXPECT_EQ(begin.ns + end.ns, 2 * image.true_stamp.ns);
    EXPECT_EQ((end - begin).ns, std::llround(image.exposure_s * 1e9));
    EXPECT_EQ(image.end, end);
    EXPECT_EQ(image.frame.stamp, image.true_stamp);
    EXPECT_NEAR(image.exposure_s, config.exposure_s, 1.1e-9);
  }
}

TEST(Camera, PhaseShiftsTheClock) {
  CameraConfig config = views::small_ideal();
  config.phase_s = 0.0125;
  Camera camera(config, {}, 1);
  camera.power_on(Time{40'000'000});
  EXPECT_EQ(camera.stamp().ns, 45'833'333);
}

struct Edge {
  double position_px, width_px;  ///< of the box that blurs it
};

/// Mean and spread of the derivative of a row across an edge from dark to bright.
Edge edge_of(const std::vector<uint8_t>& grey, int width, int row) {
  double sum = 0, first = 0, second = 0;
  for (int x = 1; x < width; ++x) {
    const auto at = static_cast<size_t>(row * width + x);
    const double step = static_cast<double>(grey[at]) - static_cast<double>(grey[at - 1]);
    sum += step, first += step * (x - 0.5), second += step * (x - 0.5) * (x - 0.5);
  }
  const double mean = first / sum;
  return {mean, std::sqrt(12 * (second / sum - mean * mean))};
}

TEST(Camera, MotionBlursAnEdgeByItsPath) {
  CameraConfig config = views::small_ideal();
  config.samples_per_pixel = 16;
  config.exposure_s = 0.01, config.gain = 1;
  const double speed_mps = 5, distance_m = 1;
  const ViewSource edge = views::plane(distance_m, [](double x, double) { return x > 0.4 ? 150.0 : 10.0; });
  const Trajectory drive =
      shapes::along([&](double t) { return SE3(Quat::Identity(), Vec3(speed_mps * t, 0, 0)); }, 0.2);
  const double length_px = 96 * speed_mps / distance_m * config.exposure_s;  // 4.8
  for (const bool blur : {true, false}) {
    config.motion_blur = blur;
    const CameraMeasurement image = views::film(config, 2, edge, drive).at(1);
    const Edge found = edge_of(image.frame.grey, 160, 60);
    // The pixel itself is a box of 1 px.
    if (blur)
      EXPECT_NEAR(found.width_px, std::hypot(length_px, 1.0), 0.06);
    else
      EXPECT_LT(found.width_px, std::sqrt(3) + 0.01);  // one or two pixels
    const double middle_m = speed_mps * image.true_stamp.seconds();
    EXPECT_NEAR(found.position_px, 79.5 + 96 * (0.4 - middle_m) / distance_m, 0.05) << blur;
  }
}

TEST(Camera, TakesAsManyViewsAsTheFlowDemands) {
  CameraConfig config = views::small_ideal();
  config.motion_blur = true;
  config.exposure_s = 0.01;
  const auto views_at = [&](double speed_mps) {
    std::atomic<int> views = 0;
    const ViewSource source = views::counted(views::even(50), 160 * 120, views);
    views::film(
        config, 1, source,
        shapes::along([&](double t) { return SE3(Quat::Identity(), Vec3(speed_mps * t, 0, 0)); }, 0.2));
    return views.load();
  };
  config.blur_view_spacing_px = 2;
  EXPECT_EQ(views_at(0), 1);
  EXPECT_EQ(views_at(2.0), 1);   // 1.92 px
  EXPECT_EQ(views_at(2.2), 2);   // 2.11 px
  EXPECT_EQ(views_at(8.0), 4);   // 7.68 px
  EXPECT_EQ(views_at(40.0), 8);  // 38 px: the most
  config.motion_blur = false;
  EXPECT_EQ(views_at(40.0), 1);
}

// A textured wall, passed and turned away from fast, with instants between few views and with nothing but views.
TEST(Camera, InstantsBetweenViewsAreAsGoodAsViews) {
  CameraConfig config = views::small_ideal();
  config.exposure_s = 0.01, config.gain = 1;
  config.motion_blur = true;
  config.blur_spacing_px = 0.5;
  const ViewSource wall = views::plane(
      1.5, [](double x, double y) { return 80 + 60 * std::sin(20 * x + 5 * y) * std::cos(14 * y - 3 * x); });
  const Trajectory drive = shapes::along(
      [](double t) {
        return SE3::from_rpy({0.5 * t, 3 * t, 2 * t}, {3 * t, -t, 2 * t});
      },
      0.2);
  const auto image = [&](double view_spacing_px, int most) {
    config.blur_view_spacing_px = view_spacing_px;
    config.max_blur_views = most;
    return views::film(config, 2, wall, drive).at(1).frame.grey;
  };
  const std::vector<uint8_t> truth = image(0.1, 64), few = image(4, 8);
  config.motion_blur = false;
  const std::vector<uint8_t> sharp = image(4, 8);
  // Away from the edge of the image, beyond which a view does not see.
  int worst = 0;
  double blurred = 0, off = 0;
  for (size_t y = 8; y < 112; ++y)
    for (size_t x = 8; x < 152; ++x) {
      const size_t i = y * 160 + x;
      worst = std::max(worst, std::abs(few[i] - truth[i]));
      off += std::abs(few[i] - truth[i]);
      blurred += std::abs(sharp[i] - truth[i]);
    }
  EXPECT_GT(blurred / (104 * 144), 3);
  EXPECT_LT(off / (104 * 144), 0.3);
  EXPECT_LE(worst, 2);
}

TEST(Camera, TruthIsCleanDeepAndFlows) {
  CameraConfig config = views::small_ideal();
  config.exposure_s = 0.02, config.gain = 0.5;
  config.shot_noise = true;
  config.truth = {.clean = true, .depth = true, .flow = true};
  const ViewSource wall =
      views::plane(2, [](double x, double y) { return 60 + 30 * std::sin(9 * x) * std::cos(7 * y); });
  const Trajectory drive = shapes::along(
      [](double t) {
        return SE3::from_rpy({0, 0.5 * t, 0}, {0.4 * t, 0, 1.5 * t});
      },
      0.5);
  const std::vector<CameraMeasurement> images = views::film(config, 6, wall, drive);
  const CameraOptics optics(config);
  const ViewRays rays = optics.rays();
  EXPECT_EQ(images[0].flow_px.size(), rays.direction_camera.size());
  for (size_t n = 1; n < images.size(); ++n) {
    const CameraMeasurement& m = images[n];
    View still;
    wall(m.T_world_camera, rays, still);
    for (size_t i = 0; i < rays.direction_camera.size(); i += 97) {
      EXPECT_NEAR(m.clean_grey[i], 255 * still.luminance[i] * 4 * 20 * 0.5 / 8000, 1e-3);
      EXPECT_FLOAT_EQ(m.depth_m[i], still.depth_m[i]);
      const Vec3 ray = rays.direction_camera[i].cast<double>();
      const Vec3 point_world = m.T_world_camera * (ray * (still.depth_m[i] / ray.z()));
      const Vec2 before = *optics.project(images[n - 1].T_world_camera.inverse() * point_world);
      const Vec2 now(static_cast<double>(i % 160), static_cast<double>(i / 160));
      EXPECT_NEAR((now + m.flow_px[i].cast<double>() - before).norm(), 0, 1e-4);
    }
  }
}

TEST(Camera, FlowOfNothingIsItsRotation) {
  CameraConfig config = views::small_ideal();
  config.truth.flow = true;
  const auto nothing = [](const SE3&, const ViewRays& rays, View& view) {
    view.luminance.assign(rays.direction_camera.size(), 0.0f);
    view.depth_m.assign(rays.direction_camera.size(), std::numeric_limits<float>::infinity());
  };
  const Trajectory drive = shapes::along(
      [](double t) {
        return SE3::from_rpy({0, 0.6 * t, 0}, {5 * t, 0, 0});
      },
      0.3);
  const CameraMeasurement image = views::film(config, 3, nothing, drive).at(2);
  // Turning right by 0.02 rad: what is on the axis was to the right.
  const size_t centre = 59 * 160 + 79;
  EXPECT_NEAR(image.flow_px[centre].x(), 96 * std::tan(0.02), 0.01);
  EXPECT_NEAR(image.flow_px[centre].y(), 0, 0.01);
  for (const uint8_t grey : image.frame.grey) EXPECT_EQ(grey, 0);
}

std::vector<CameraMeasurement> lively_film(const CameraConfig& config, const SensorEvents& events = {}) {
  const ViewSource wall =
      views::plane(6, [](double x, double y) { return 40 + 30 * std::sin(9 * x) * std::sin(8 * y); });
  return views::film(config, 7, wall, shapes::along(shapes::lively, 0.5), events);
}

TEST(Camera, SameBytesForAnyNumberOfThreadsAndTwice) {
  CameraConfig config;
  config.width_px = 160, config.height_px = 120, config.fx_px = config.fy_px = 96;
  config.cx_px = 79.5, config.cy_px = 59;
  set_thread_count(1);
  const auto one = lively_film(config), again = lively_film(config);
  set_thread_count(2);
  const auto two = lively_film(config);
  ASSERT_EQ(one.size(), 7u);
  for (size_t i = 0; i < one.size(); ++i) {
    EXPECT_EQ(one[i].frame.grey, again[i].frame.grey);
    EXPECT_EQ(one[i].frame.grey, two[i].frame.grey);
    EXPECT_EQ(one[i].exposure_s, two[i].exposure_s);
    EXPECT_EQ(one[i].gain, two[i].gain);
  }
}

TEST(Camera, HowManyAreTakenTogetherDoesNotShow) {
  CameraConfig config;
  config.width_px = 64, config.height_px = 48, config.fx_px = config.fy_px = 40;
  config.cx_px = 31.5, config.cy_px = 23.5;
  const ViewSource dusk = views::even(3);
  const Trajectory rest = shapes::at_rest(SE3(), 1);
  Camera singly(config, {}, 1), together(config, {}, 1);
  singly.power_on(Time{0}), together.power_on(Time{0});
  for (int i = 0; i < 5; ++i)
    for (const CameraMeasurement& m : together.take(3, rest, SE3(), dusk)) {
      const CameraMeasurement alone = singly.take(1, rest, SE3(), dusk).at(0);
      EXPECT_EQ(m.frame.grey, alone.frame.grey);
      EXPECT_EQ(m.gain, alone.gain);
      EXPECT_EQ(m.end, alone.end);
    }
}

TEST(Camera, ACoveredLensIsNearlyBlackAndADropoutSilent) {
  CameraConfig config = views::small_ideal();
  config.read_noise_e = 5;
  SensorEvents events;
  events.camera_covered.push_back({{0.06, 0.12}, 0.002});
  events.camera_dropouts.push_back({{0.13, 0.18}});
  const auto whole = lively_film(config), hurt = lively_film(config, events);
  // Images at 33, 67, 100, 133, 167, 200 and 233 ms: two covered, two missing.
  ASSERT_EQ(whole.size(), 7u);
  ASSERT_EQ(hurt.size(), 5u);
  for (const size_t covered : {1u, 2u}) {
    const views::Moments m = views::moments(hurt[covered].frame.grey);
    EXPECT_LT(m.mean, 1.5);
    EXPECT_GT(m.variance, 0);
    EXPECT_GT(views::moments(whole[covered].frame.grey).mean, 30);
  }
  EXPECT_EQ(hurt[0].frame.grey, whole[0].frame.grey);
  EXPECT_EQ(hurt[3].frame.grey, whole[5].frame.grey);
  EXPECT_EQ(hurt[4].true_stamp, whole[6].true_stamp);
}

}  // namespace
}  // namespace vsslam

#include "slam/vision/corners.h"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/imgproc.hpp>

#include "slam/vision/corner_response.h"
#include "slam/vision/window_shape.h"
#include "tests/slam/vision/visual_scene.h"

namespace vsslam {
namespace {

using namespace testing_vision;

GreyView view(const CameraFrame& image) {
  return {image.grey.data(), image.width_px, image.height_px, image.width_px};
}

template <class F>
CameraFrame draw(int width_px, int height_px, const F& grey) {
  CameraFrame image{{}, width_px, height_px, {}};
  for (int y = 0; y < height_px; ++y)
    for (int x = 0; x < width_px; ++x) image.grey.push_back(to_byte(grey(x, y)));
  return image;
}

TEST(Corners, RespondToTheWeakerGradient) {
  // A plane of slope (2, 5) has one direction of gradient only; a corner of two such planes has both.
  const CameraFrame ramp = draw(32, 32, [](int x, int y) { return 2 * x + 5 * y; });
  EXPECT_FLOAT_EQ(corner_response(view(ramp), 16, 16), 0);
  // dx = +-3 in alternating halves, dy = 4 everywhere: mean of xx 9, of yy 16, of xy 0 over a symmetric block.
  const CameraFrame roof = draw(32, 32, [](int x, int y) { return 3 * std::abs(x - 16) + 4 * y; });
  EXPECT_FLOAT_EQ(corner_response(view(roof), 16, 16), 9 * 4 / 5.0f);  // the ridge itself has dx = 0
  EXPECT_FLOAT_EQ(corner_response(view(roof), 10, 16), 0);
}

TEST(Corners, RespondAlikeOneByOneAndInTiles) {
  const CameraFrame image = render(WaveTexture(5), small_camera(), before_plane(), {}, {.noise_grey = 3});
  ResponseTile tile;
  tile.compute(view(image), 40, 50);
  for (int y = 0; y < ResponseTile::kSize; y += ResponseTile::kStep) {
    const auto best = tile.best_of_blocks(y);
    for (size_t block = 0; block < best.size(); ++block) {
      float strongest = 0;
      for (int v = y; v < y + ResponseTile::kStep; ++v)
        for (int u = 0; u < ResponseTile::kStep; ++u)
          strongest =
              std::max(strongest, corner_response(view(image), 40 + 8 * static_cast<int>(block) + u, 50 + v));
      EXPECT_EQ(best[block].response, strongest);
      EXPECT_EQ(corner_response(view(image), 40 + best[block].x, 50 + best[block].y), strongest);
    }
  }
}

TEST(Corners, AreFoundWhereSquaresMeet) {
  // Squares of 40 px: corners at multiples of 40, and nowhere else.
  const CameraFrame board = draw(240, 200, [](int x, int y) { return (x / 40 + y / 40) % 2 ? 200 : 50; });
  const auto corners = find_corners(view(board), 0, {}, 100, {.min_distance_px = 12});
  EXPECT_EQ(corners.size(), 20u);
  for (const Eigen::Vector2f& c : corners) {
    EXPECT_NEAR(c.x(), 40 * std::round(c.x() / 40) - 0.5, 1.6);
    EXPECT_NEAR(c.y(), 40 * std::round(c.y() / 40) - 0.5, 1.6);
  }
}

TEST(Corners, KeepTheirDistanceFromThoseThatAreThere) {
  const CameraFrame image = render(WaveTexture(5), small_camera(), before_plane(), {});
  const CornerConfig config{.min_distance_px = 20};
  const auto first = find_corners(view(image), 0, {}, 30, config);
  ASSERT_EQ(first.size(), 30u);
  auto all = first;
  for (const Eigen::Vector2f& c : find_corners(view(image), 0, first, 30, config)) all.push_back(c);
  EXPECT_GT(all.size(), 50u);
  for (size_t i = 0; i < all.size(); ++i)
    for (size_t j = 0; j < i; ++j) EXPECT_GE((all[i] - all[j]).norm(), 20);
}

TEST(Corners, GoToThePoorestCellFirst) {
  // All the strong corners on the left: the faint ones on the right get their share.
  const WaveTexture texture(5);
  const CameraModel camera(small_camera());
  const CameraFrame image = draw(320, 240, [&](int x, int y) {
    return 128 + (x < 160 ? 1.0 : 0.25) * (texture(point_odom(camera, before_plane(), Vec2(x, y))) - 128);
  });
  const auto corners = find_corners(view(image), 0, {}, 24, {.min_distance_px = 12, .cell_px = 80});
  ASSERT_EQ(corners.size(), 24u);
  const auto left = std::count_if(corners.begin(), corners.end(), [](const auto& c) { return c.x() < 160; });
  EXPECT_NEAR(static_cast<double>(left), 12, 2);
}

TEST(Corners, NoiseIsMeasuredBesideTexture) {
  for (const double sigma : {1.0, 2.0, 6.0}) {
    const CameraFrame flat = blank(small_camera(), {}, 128, sigma);
    EXPECT_NEAR(noise_sigma_grey(view(flat)), sigma, 0.1 * sigma + 0.15);
    const CameraFrame textured =
        render(WaveTexture(5), small_camera(), before_plane(), {}, {.noise_grey = sigma});
    EXPECT_NEAR(noise_sigma_grey(view(textured)), sigma, 0.2 * sigma + 0.3);
  }
}

TEST(Corners, SmoothedNoiseIsNoCorner) {
  for (const double sigma : {2.0, 6.0, 20.0}) {
    CameraFrame image = blank(small_camera(), {}, 128, sigma);
    const cv::Mat pixels(image.height_px, image.width_px, CV_8U, image.grey.data());
    cv::GaussianBlur(pixels, pixels, {0, 0}, 1);
    EXPECT_LE(find_corners(view(image), sigma, {}, 100, {}).size(), 1u) << sigma;
  }
}

TEST(Corners, SmallImagesHaveNone) {
  const CameraFrame image = draw(30, 30, [](int x, int y) { return (x / 8 + y / 8) % 2 ? 255 : 0; });
  EXPECT_TRUE(find_corners(view(image), 0, {}, 10, {}).empty());
}

TEST(Corners, AWindowGoesWithThePointWhereItsLinesMeet) {
  // Two edges that cross at (30.5, 24.5), in a window around (27, 27).
  const CameraFrame cross = draw(64, 64, [](int x, int y) { return (x > 30) == (y > 24) ? 200 : 50; });
  for (const WindowSize window : {WindowSize{21, 21}, WindowSize{24, 21}}) {
    const WindowShape shape = window_shape(view(cross), 27, 27, window);
    EXPECT_LT((shape.centre_px() - Eigen::Vector2f(3.5f, -2.5f)).norm(), 0.1f);
    EXPECT_LT((shape.flow_of(0.1f * Eigen::Matrix2f::Identity()) - 0.1f * shape.centre_px()).norm(), 1e-6f);
  }
  const CameraFrame flat = draw(64, 64, [](int, int) { return 100; });
  EXPECT_EQ(window_shape(view(flat), 27, 27, {21, 21}).centre_px(), Eigen::Vector2f(0, 0));
}

}  // namespace
}  // namespace vsslam

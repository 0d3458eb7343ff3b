#include "sensors/camera/camera_blur.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace vsslam {
namespace {

constexpr int kWidth = 40, kHeight = 30;

template <typename Luminance>
View picture(Luminance luminance) {
  View view;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) view.luminance.push_back(luminance(x, y));
  return view;
}

std::vector<float> smeared(const View& view, const Vec2f& flow_px, float spacing_px) {
  std::vector<float> light(view.luminance.size(), 0.0f);
  add_smeared(view, kWidth, std::vector<Vec2f>(light.size(), flow_px), spacing_px, light);
  return light;
}

TEST(CameraBlur, StillPixelsStayAndLightAddsUp) {
  const View view = picture([](int x, int y) { return static_cast<float>(7 * x + y * y % 11); });
  EXPECT_EQ(smeared(view, {0, 0}, 1), view.luminance);
  EXPECT_EQ(smeared(view, {0.6f, 0.6f}, 1), view.luminance);  // shorter than the spacing
  const float far = std::numeric_limits<float>::infinity();
  EXPECT_EQ(smeared(view, {far, far}, 1), view.luminance);
  std::vector<float> light(view.luminance.size(), 3.0f);
  add_smeared(view, kWidth, std::vector<Vec2f>(light.size(), Vec2f::Zero()), 1, light);
  EXPECT_EQ(light[50], 3 + view.luminance[50]);
}

TEST(CameraBlur, KeepsARamp) {
  const View view =
      picture([](int x, int y) { return 3.0f * static_cast<float>(x) - static_cast<float>(y); });
  const std::vector<float> light = smeared(view, {4.2f, -3.1f}, 0.7f);
  for (size_t y = 4; y < kHeight - 4; ++y)
    for (size_t x = 4; x < kWidth - 4; ++x)
      EXPECT_NEAR(light[y * kWidth + x], view.luminance[y * kWidth + x], 1e-3);
}

// The box of the flow takes sin(k x) to sinc(k f / 2) sin(k x).
TEST(CameraBlur, WeakensAWaveByTheSincOfItsFlow) {
  constexpr float kWave = 0.3f, kFlow_px = 8.0f;
  const View view = picture([](int x, int) { return std::sin(kWave * static_cast<float>(x)); });
  const std::vector<float> light = smeared(view, {kFlow_px, 0}, 0.5f);
  const float sinc = std::sin(kWave * kFlow_px / 2) / (kWave * kFlow_px / 2);
  for (size_t x = 5; x < kWidth - 5; ++x)
    EXPECT_NEAR(light[10 * kWidth + x], sinc * view.luminance[10 * kWidth + x], 0.015);
}

TEST(CameraBlur, BeyondTheEdgeTheLastPixelsGoOn) {
  const View view = picture([](int x, int) { return x < kWidth / 2 ? 2.0f : 5.0f; });
  const std::vector<float> light = smeared(view, {12, 9}, 1);
  EXPECT_FLOAT_EQ(light.front(), 2);
  EXPECT_FLOAT_EQ(light.back(), 5);
  for (const float l : light) EXPECT_TRUE(l >= 2 && l <= 5);
}

}  // namespace
}  // namespace vsslam

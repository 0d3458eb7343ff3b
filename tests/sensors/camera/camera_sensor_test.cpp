#include "sensors/camera/camera_sensor.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "sensors/camera/pixel_noise.h"
#include "tests/sensors/camera/views.h"

namespace vsslam {
namespace {

std::vector<float> noise_of(const RandomStream& stream, uint64_t image, size_t count) {
  const PixelNoise noise(stream, image);
  std::vector<float> all(count);
  float block[PixelNoise::kBlock];
  for (size_t first = 0; first < count; first += PixelNoise::kBlock) {
    noise.block(static_cast<uint32_t>(first), block);
    std::copy(std::begin(block), std::end(block), all.begin() + static_cast<std::ptrdiff_t>(first));
  }
  return all;
}

TEST(PixelNoise, HasTheMomentsAndTailsOfANormal) {
  double sum[5] = {};
  std::array<double, 5> beyond{};  // 1 .. 5 sigma, both sides
  double count = 0;
  const RandomStream stream(7, "camera.shot");
  for (uint64_t image = 0; image < 16; ++image)
    for (const float x : noise_of(stream, image, 640 * 480)) {
      double power = 1;
      for (double& s : sum) s += power, power *= x;
      for (size_t k = 0; k < 5; ++k) beyond[k] += std::abs(x) > static_cast<float>(k + 1);
      ++count;
    }
  // Tolerances: five standard deviations of each moment at 4.9 million samples.
  const double sigma = 5 / std::sqrt(count);
  EXPECT_NEAR(sum[1] / count, 0, sigma);
  EXPECT_NEAR(sum[2] / count, 1, sigma * std::sqrt(2));
  EXPECT_NEAR(sum[3] / count, 0, sigma * std::sqrt(15));
  EXPECT_NEAR(sum[4] / count, 3, sigma * std::sqrt(96));
  for (size_t k = 0; k < 5; ++k) {
    const double expected = count * std::erfc(static_cast<double>(k + 1) / std::sqrt(2));
    const double t = static_cast<double>(k + 1),
                 density = std::exp(-t * t / 2) / std::sqrt(2 * std::numbers::pi);
    const double step = 0.004 * 2 * count * density;  // the values are 0.007 apart
    EXPECT_NEAR(beyond[k], expected, 5 * std::sqrt(expected) + step + 1) << t;
  }
}

TEST(PixelNoise, PixelsImagesAndStreamsAreIndependent) {
  const size_t n = 640 * 480;
  const RandomStream stream(7, "camera.shot");
  const std::vector<float> a = noise_of(stream, 1, n), b = noise_of(stream, 2, n),
                           c = noise_of(RandomStream(7, "camera.read"), 1, n),
                           d = noise_of(RandomStream(8, "camera.shot"), 1, n);
  const auto correlation = [&](const std::vector<float>& x, const std::vector<float>& y, size_t shift) {
    double sum = 0;
    for (size_t i = shift; i < n; ++i) sum += static_cast<double>(x[i]) * static_cast<double>(y[i - shift]);
    return sum / static_cast<double>(n);
  };
  const double bound = 5 / std::sqrt(static_cast<double>(n));
  for (const size_t shift : {1u, 2u, 8u, 64u, 640u, 641u, 4096u})
    EXPECT_LT(std::abs(correlation(a, a, shift)), bound);
  for (const auto* other : {&b, &c, &d})
    for (const size_t shift : {0u, 1u, 640u}) EXPECT_LT(std::abs(correlation(a, *other, shift)), bound);
  EXPECT_EQ(a, noise_of(stream, 1, n));
}

// Grey per electron of the small camera: 255 * gain / full well.
constexpr double kGreyPerElectron = 255 * 5 / 8000.0;
double electrons(double luminance) {
  return luminance * 4 * 2;
}

TEST(ImageSensor, VarianceGrowsWithTheSignal) {
  CameraConfig config = views::small_ideal();
  config.shot_noise = true;
  for (const double read_e : {0.0, 8.0}) {
    config.read_noise_e = read_e;
    for (const double luminance : {10.0, 40.0, 80.0, 160.0}) {
      const auto image = views::film_at_rest(config, 1, views::even(luminance)).at(0);
      const views::Moments m = views::moments(image.frame.grey);
      const double variance_e = electrons(luminance) + read_e * read_e;
      const double expected = kGreyPerElectron * kGreyPerElectron * variance_e + 1.0 / 12;  // of the rounding
      EXPECT_NEAR(m.mean, kGreyPerElectron * electrons(luminance), 0.1);
      EXPECT_NEAR(m.variance / expected, 1, 0.05);  // five deviations of 19 200 pixels
    }
  }
}

TEST(ImageSensor, NoisesAndFixedPatternsAreIndependentSwitches) {
  CameraConfig config = views::small_ideal();
  config.read_noise_e = 30;
  const auto grey = [](const CameraConfig& c, double luminance, uint64_t seed = 1) {
    return views::film_at_rest(c, 1, views::even(luminance), {}, seed).at(0).frame.grey;
  };
  // In the dark there is no shot noise: the read noise must be the same to the bit.
  CameraConfig both = config;
  both.shot_noise = true;
  EXPECT_EQ(grey(config, 0), grey(both, 0));
  EXPECT_GT(views::moments(grey(config, 0)).variance, 1);
  EXPECT_NE(grey(config, 20), grey(both, 20));
  // A pattern or another noise that is all but zero draws its numbers and changes next to no rounding.
  CameraConfig shot = views::small_ideal();
  shot.shot_noise = true;
  CameraConfig almost = shot;
  almost.read_noise_e = almost.fixed_gain_sigma = almost.fixed_offset_e = 1e-6;
  const auto a = grey(shot, 61), b = grey(almost, 61);
  size_t different = 0;
  for (size_t i = 0; i < a.size(); ++i) different += a[i] != b[i];
  EXPECT_LT(different, 20u);
  EXPECT_NE(grey(shot, 61, 1), grey(shot, 61, 2));
}

TEST(ImageSensor, TheFixedPatternStays) {
  CameraConfig config = views::small_ideal();
  config.fixed_gain_sigma = 0.03;
  config.gain = 7;
  const auto images = views::film_at_rest(config, 3, views::even(100));
  EXPECT_EQ(images[0].frame.grey, images[1].frame.grey);
  EXPECT_EQ(images[0].frame.grey, images[2].frame.grey);
  const views::Moments m = views::moments(images[0].frame.grey);
  EXPECT_NEAR(std::sqrt(m.variance - 1.0 / 12) / m.mean, 0.03, 0.001);
  EXPECT_NE(images[0].frame.grey, views::film_at_rest(config, 1, views::even(100), {}, 2).at(0).frame.grey);

  CameraConfig offset = views::small_ideal();
  offset.fixed_offset_e = 40;
  const auto dim = views::film_at_rest(offset, 1, views::even(40)).at(0).frame.grey;
  const auto bright = views::film_at_rest(offset, 1, views::even(120)).at(0).frame.grey;
  EXPECT_NEAR(std::sqrt(views::moments(dim).variance), 40 * kGreyPerElectron, 0.3);
  EXPECT_NEAR(std::sqrt(views::moments(bright).variance), 40 * kGreyPerElectron, 0.3);
}

TEST(ImageSensor, VignettesWithTheCosine) {
  CameraConfig config = views::small_ideal();
  config.vignetting_exponent = 4;
  config.truth.clean = true;
  const auto image = views::film_at_rest(config, 1, views::even(150)).at(0);
  for (int y = 0; y < 120; y += 7)
    for (int x = 0; x < 160; x += 7) {
      const double u = (x - 79.5) / 96, v = (y - 59) / 96.0, cosine = 1 / std::sqrt(1 + u * u + v * v);
      const double grey = kGreyPerElectron * electrons(150) * std::pow(cosine, 4);
      const auto at = static_cast<size_t>(y * 160 + x);
      EXPECT_NEAR(image.clean_grey[at], grey, 1e-3);
      EXPECT_NEAR(image.frame.grey[at], grey, 0.502);
    }
}

TEST(ImageSensor, RespondsLinearlyOrByGammaAndSaturates) {
  for (const double gamma : {1.0, 2.2}) {
    CameraConfig config = views::small_ideal();
    config.gamma = gamma;
    config.truth.clean = true;
    for (const double luminance : {0.0, 0.3, 5.0, 50.0, 150.0, 199.0, 300.0, 1e9}) {
      const auto image = views::film_at_rest(config, 1, views::even(luminance)).at(0);
      const double signal = std::min(1.0, luminance / 200);
      const double grey = 255 * std::pow(signal, 1 / gamma);
      EXPECT_NEAR(image.frame.grey[1000], grey, 0.6) << gamma << " " << luminance;
      EXPECT_NEAR(image.clean_grey[1000], grey, 0.01);
    }
  }
  // At a gain below 1 the well is full before the converter is.
  CameraConfig config = views::small_ideal();
  config.gain = 0.5;
  EXPECT_EQ(views::film_at_rest(config, 1, views::even(1e6)).at(0).frame.grey[1000], 128);
}

TEST(ImageSensor, EveryEffectAtOnceStaysFinite) {
  CameraConfig config = views::small_ideal();
  config.shot_noise = true;
  config.read_noise_e = 50, config.fixed_gain_sigma = 0.2, config.fixed_offset_e = 50;
  config.vignetting_exponent = 4, config.gamma = 2.2;
  config.truth = {.clean = true, .depth = true, .flow = true};
  for (const double luminance : {0.0, 1e-9, 1.0, 1e12})
    for (const CameraMeasurement& m : views::film_at_rest(config, 2, views::even(luminance))) {
      for (const float grey : m.clean_grey) ASSERT_TRUE(std::isfinite(grey) && grey >= 0 && grey <= 255);
      for (const float depth : m.depth_m) ASSERT_TRUE(std::isfinite(depth));
      for (const Vec2f& f : m.flow_px) ASSERT_TRUE(f.allFinite());
    }
}

}  // namespace
}  // namespace vsslam

#include "sensors/camera/camera_exposure.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/sensors/camera/views.h"

namespace vsslam {
namespace {

/// Mean grey of an even scene: linear until it saturates.
double grey_at(const Exposure& exposure, double light) {
  return std::min(255.0, light * exposure.product_s());
}

TEST(ExposureControl, FollowsAStepOfLightWithoutOvershooting) {
  const CameraConfig config;
  for (const double factor : {0.2, 8.0}) {
    ExposureControl control(config);
    double light = 2e4;
    for (int i = 0; i < 100; ++i) control.saw(grey_at(control.ahead(0), light));
    const double before = control.ahead(0).product_s();
    EXPECT_NEAR(grey_at(control.ahead(0), light), 110, 0.2);
    light *= factor;
    double last = before;
    for (int i = 0; i < 60; ++i) {
      const double product_s = control.ahead(0).product_s();
      // Always towards the new setting, never beyond it.
      const double step = product_s / last, to_go = before / factor / product_s;
      EXPECT_TRUE(factor > 1 ? step < 1.0001 && to_go < 1.001 : step > 0.9999 && to_go > 0.999);
      last = product_s;
      control.saw(grey_at(control.ahead(0), light));
      if (i == 30) {
        EXPECT_NEAR(grey_at(control.ahead(0), light) / 110, 1, 0.05);
      }
    }
    EXPECT_NEAR(grey_at(control.ahead(0), light), 110, 0.5);
  }
}

TEST(ExposureControl, ActsAfterItsDelay) {
  CameraConfig config;
  config.auto_exposure.delay_frames = 4;
  config.auto_exposure.share_per_frame = 1;
  config.gain = 4;
  ExposureControl control(config);
  EXPECT_EQ(control.known(), 4);
  const double first = control.ahead(0).product_s();
  control.saw(55);
  for (int k = 0; k < 3; ++k) EXPECT_DOUBLE_EQ(control.ahead(k).product_s(), first);
  EXPECT_NEAR(control.ahead(3).product_s(), 2 * first, 1e-9);
  control.missed();
  EXPECT_NEAR(control.ahead(3).product_s(), 2 * first, 1e-9);
}

TEST(ExposureControl, TimeGoesFirstThenGainWithinLimits) {
  CameraConfig config;
  config.auto_exposure.max_exposure_s = 0.002;
  ExposureControl control(config);
  for (int i = 0; i < 200; ++i) control.saw(0);  // black
  EXPECT_DOUBLE_EQ(control.ahead(0).time.seconds(), 0.002);
  EXPECT_DOUBLE_EQ(control.ahead(0).gain, 16);
  const double light = 2e5;  // 110 at 0.55 ms
  for (int i = 0; i < 200; ++i) control.saw(grey_at(control.ahead(0), light));
  EXPECT_NEAR(control.ahead(0).time.seconds(), 0.00055, 1e-6);
  EXPECT_DOUBLE_EQ(control.ahead(0).gain, 1);
  for (int i = 0; i < 200; ++i) control.saw(255);  // blinded
  EXPECT_DOUBLE_EQ(control.ahead(0).time.seconds(), 5e-5);
  EXPECT_DOUBLE_EQ(control.ahead(0).gain, 1);
}

TEST(ExposureControl, StaysWhenSwitchedOff) {
  CameraConfig config;
  config.auto_exposure.enabled = false;
  config.exposure_s = 0.0085, config.gain = 2;
  ExposureControl control(config);
  for (int i = 0; i < 10; ++i) control.saw(3);
  EXPECT_DOUBLE_EQ(control.ahead(2).time.seconds(), 0.0085);
  EXPECT_DOUBLE_EQ(control.ahead(2).gain, 2);
}

TEST(ExposureControl, SettlesOnTheImagesOfACamera) {
  for (const double gamma : {1.0, 2.2}) {
    CameraConfig config = views::small_ideal();
    config.width_px = 64, config.height_px = 48;
    config.shot_noise = true, config.read_noise_e = 5, config.vignetting_exponent = 4;
    config.auto_exposure.enabled = true;
    config.gamma = gamma;
    const auto images = views::film_at_rest(config, 60, views::even(60));
    EXPECT_NEAR(views::moments(images.back().frame.grey).mean, 110, 2) << gamma;
    EXPECT_NEAR(images.back().exposure_s, 0.003, 1e-9);
    EXPECT_NEAR(images[50].gain, images[59].gain, 0.03 * images[59].gain);
  }
}

}  // namespace
}  // namespace vsslam

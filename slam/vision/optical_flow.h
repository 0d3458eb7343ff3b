// Where points of the last image are in the newest one: pyramidal Lucas-Kanade, there and, where asked, back.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "core/config.h"
#include "core/samples.h"
#include "slam/vision/corners.h"
#include "slam/vision/window_shape.h"

namespace vsslam {

enum class Equalize { automatic, always, never };

struct OpticalFlowConfig {
  int window_px = 21;          ///< odd: the window's height; see window()
  int levels = 3;              ///< of the pyramid above the image itself, each half the size
  double max_return_px = 0.5;  ///< a point followed there and back must come home to within this
  double smoothing_px = 1.0;   ///< sigma of the Gaussian that all images go through: noise in the gradients
                               ///< holds tracks back
  /// Contrast-limited adaptive histogram equalisation (Zuiderveld 1994) of the smoothed image.
  Equalize equalize = Equalize::automatic;
  double clip_limit = 3.0;
  int clahe_tiles = 8;            ///< per side
  double dark_grey = 50.0;        ///< automatic: if the image's median is below this,
  double bright_grey = 205.0;     ///< or above this,
  double hysteresis_grey = 10.0;  ///< until it is back by this much
  double max_noise_grey = 1.5;    ///< and if it is not noisier: where noise, not the step of the grey values,
                                  ///< hides the texture, it would be amplified with it, and that unsteadily
  void fields(Fields& f);
  /// Wide enough to be followed eight pixels at a time: OpenCV takes what remains of a row one by one, which makes
  /// 21 columns three times as slow as 24.
  WindowSize window() const { return {(window_px + 7) / 8 * 8, window_px}; }
};

class OpticalFlow {
 public:
  OpticalFlow(const OpticalFlowConfig& config, int width_px, int height_px);
  ~OpticalFlow();

  /// The newest image becomes the last one; `image` the newest. Its pyramid is built once, for both.
  void push(const CameraFrame& image);
  /// The newest image as features see it (equalised where that is on); valid until the next push.
  GreyView newest() const;
  bool equalized() const;
  /// Standard deviation of the newest image's noise, were it not smoothed; with equalisation at most so much.
  double noise_grey() const;

  /// Needs two images. `guess_px`: where to start looking. With `and_back` a point is found only if the way back leads
  /// home. Empty: lost.
  std::vector<std::optional<Eigen::Vector2f>> follow(const std::vector<Eigen::Vector2f>& last_px,
                                                     const std::vector<Eigen::Vector2f>& guess_px,
                                                     bool and_back) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace vsslam

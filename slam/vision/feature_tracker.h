// From images to tracked features: corners spread over the image, pyramidal Lucas-Kanade with a
// forward-backward check, RANSAC on epipolar geometry.
#pragma once

#include <memory>

#include "core/calibration.h"
#include "core/config.h"
#include "core/samples.h"
#include "slam/vision/visual_frame.h"

namespace vsslam {

struct FeatureTrackerConfig {
  int max_features = 150;
  void fields(Fields& f);
};

/// Deterministic: the same images give the same features. Not thread-safe.
class FeatureTracker {
 public:
  FeatureTracker(const FeatureTrackerConfig& config, const CameraCalibration& camera);
  ~FeatureTracker();

  /// Frames in order of time. `q_last_now` is the camera's rotation since the last frame (coordinates of the
  /// new camera frame into the last one), where the gyroscope knows it: the guess of where features went.
  /// Throws InputError if the image does not fit the calibration.
  VisualFrame track(const CameraFrame& image, const Quat* q_last_now = nullptr);
  /// Forgets all tracks; ids go on.
  void reset();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace vsslam

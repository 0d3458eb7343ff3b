// From images to tracked features: corners spread over the image, pyramidal Lucas-Kanade with a
// forward-backward check, RANSAC on epipolar geometry (the visual front end of VINS-Mono and LVI-SAM: Qin, Li,
// Shen, T-RO 2018; Shan et al., ICRA 2021).
#pragma once

#include <memory>

#include "core/calibration.h"
#include "core/config.h"
#include "core/samples.h"
#include "slam/vision/corners.h"
#include "slam/vision/epipolar.h"
#include "slam/vision/optical_flow.h"
#include "slam/vision/visual_frame.h"

namespace vsslam {

struct FeatureTrackerConfig {
  int max_features = 150;
  CornerConfig corners;
  OpticalFlowConfig flow;
  EpipolarConfig epipolar;
  void fields(Fields& f);
};

/// What became of the features of one image.
struct TrackingCounts {
  int followed = 0;  ///< of the last image's features, those found in this one
  int rejected = 0;  ///< of these, dropped because they do not fit the camera's motion
  int detected = 0;  ///< new ones
  bool equalized = false;
};

/// Deterministic: the same images give the same features. Not thread-safe.
class FeatureTracker {
 public:
  /// Throws InputError if the calibration describes no image that features could be found in.
  FeatureTracker(const FeatureTrackerConfig& config, const CameraCalibration& camera);
  ~FeatureTracker();

  /// Frames in order of time. `q_last_now` is the camera's rotation since the last frame (coordinates of the
  /// new camera frame into the last one), where the gyroscope knows it: the guess of where features went.
  /// In an image to `keep`, one that is made use of, features are followed there and back and lost ones are replaced;
  /// the images between only lead from one such to the next.
  /// Throws InputError if the image does not fit the calibration.
  VisualFrame track(const CameraFrame& image, const Quat* q_last_now = nullptr, bool keep = true);
  /// Forgets all tracks; ids go on.
  void reset();
  const TrackingCounts& counts() const;  ///< of the last image

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace vsslam

// What the visual-inertial odometry remembers: frames with their states, features with where they were seen, and
// a prior on what has left.
#pragma once

#include <deque>
#include <map>
#include <optional>
#include <vector>

#include "slam/vio/linear_prior.h"
#include "slam/vio/rest_detector.h"
#include "slam/vio/vio.h"
#include "slam/vio/vio_predict.h"

namespace vsslam {

struct WindowFrame {
  int64_t id = 0;  ///< 0, 1, 2, ... never used again
  VioState state;
  bool key = false;
  /// From the frame before: the IMU, or rest.
  ImuSpan span;
  std::optional<ImuPreintegration> motion;
  std::optional<RestMeans> rest;
};

struct Sighting {
  int64_t frame = 0;
  Vec2 ray_camera = Vec2::Zero();
  double depth_m = 0;  ///< as in VisualFeature
};

struct WindowFeature {
  std::vector<Sighting> seen;         ///< in order of frame; the first is the anchor
  std::optional<InversePoint> point;  ///< in the camera of the anchor
};

struct VioWindow {
  std::deque<WindowFrame> frames;             ///< in order of time
  std::map<int64_t, WindowFeature> features;  ///< by id
  LinearPrior prior;

  WindowFrame& newest() { return frames.back(); }
  const WindowFrame& newest() const { return frames.back(); }
  size_t index_of(int64_t frame) const;
  const SE3& T_vio_imu(int64_t frame) const { return frames[index_of(frame)].state.T_vio_imu; }

  void append(WindowFrame frame, const VisualFrame& seen);
  /// The point of a feature in the camera of another frame; nullopt if it is behind it or too near.
  std::optional<InversePoint> point_in(int64_t frame, const WindowFeature& feature,
                                       const SE3& T_imu_camera) const;
  /// Forgets what a frame saw; a feature anchored there is anchored where it was seen next.
  void forget_sightings(int64_t frame, const SE3& T_imu_camera);
};

/// How the newest frame is tied to the one before it.
struct NewestView {
  int tracks = 0;          ///< features of the newest frame that were seen before
  double parallax_px = 0;  ///< their mean displacement since the frame before, without rotation
};
NewestView view_newest(const VioWindow& window, const SE3& T_imu_camera);

/// Depth of the features that have none and whose rays, or LiDAR depths, give one.
void triangulate(VioWindow& window, const SE3& T_imu_camera, const VioConfig& config);

/// Distance in pixels (focal length 460) between where a feature was seen and where its point is, mean over one
/// sighting less than there are: the anchor places the point.
double mean_error_px(const VioWindow& window, const WindowFeature& feature, const SE3& T_imu_camera);
/// Removes features that do not fit, or lie behind the camera. Returns how many.
int remove_outliers(VioWindow& window, const SE3& T_imu_camera, double limit_px);

}  // namespace vsslam

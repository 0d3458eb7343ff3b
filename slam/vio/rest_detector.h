// Does the robot stand still?
#pragma once

#include <deque>
#include <optional>

#include "slam/inertial/imu_track.h"
#include "slam/vio/vio.h"

namespace vsslam {

/// What the IMU read on average since rest began (or over the last seconds of a long rest).
struct RestMeans {
  Vec3 gyro_radps = Vec3::Zero(), accel_mps2 = Vec3::Zero();
  double duration_s = 0;
};

/// At constant velocity the IMU is as quiet as at rest, and without texture the image does not flow either: both
/// are asked. The image is compared with the one in which rest began, so that creeping shows. Rest that has begun
/// goes on in the dark.
class RestDetector {
 public:
  explicit RestDetector(const VioRestConfig& config) : config_(config) {}

  /// Frames in order of time. `imu` reaches back for at least the configured time. Nothing in motion.
  std::optional<RestMeans> update(const VisualFrame& frame, const ImuTrack& imu);
  /// The frame in which rest began; only at rest.
  const VisualFrame& reference() const { return *reference_; }

 private:
  struct Quiet {
    RestMeans means;
    bool is = false;
  };
  Quiet quiet(Time now, const ImuTrack& imu) const;
  bool still(const VisualFrame& frame) const;
  void average(const ImuTrack& imu, Time until);

  VioRestConfig config_;
  std::deque<VisualFrame> recent_;
  std::optional<VisualFrame> reference_;
  RestMeans means_;
  Time averaged_until_;
};

/// Displacement of the features that both frames show, median, in pixels at focal length 460; nothing if they
/// share fewer than 10.
std::optional<double> median_flow_px(const VisualFrame& a, const VisualFrame& b);

}  // namespace vsslam

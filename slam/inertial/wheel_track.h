// Wheel odometry: a differential drive whose track is wider than the real one, to fit a skid-steered robot.
#pragma once

#include <deque>
#include <optional>

#include "core/calibration.h"
#include "core/samples.h"
#include "slam/inertial/usual_gap.h"

namespace vsslam {

/// What the wheels have done since power-on.
struct WheelTravel {
  double forward_m = 0;
  double yaw_rad = 0;
};

/// Angles of wheels whose joints are reported within a turn (-pi .. pi, or 0 .. 2 pi), going on where they wrap: no wheel
/// turns half a turn from sample to sample.
class WheelTurns {
 public:
  WheelSample unwrapped(WheelSample sample);

 private:
  std::optional<WheelSample> last_;  // unwrapped
  double left_turns_rad_ = 0, right_turns_rad_ = 0;
};

class WheelTrack {
 public:
  WheelTrack(const WheelCalibration& wheels, double max_gap_s) : wheels_(wheels), max_gap_s_(max_gap_s) {}

  /// Ignores samples that are not finite or not newer than the last. Angles may wrap at a turn.
  void add(const WheelSample& sample);
  /// Keeps what interpolation at `stamp` needs.
  void forget_before(Time stamp);

  const std::deque<WheelSample>& samples() const { return samples_; }
  /// Interpolated; continued at the last rate up to half the largest gap beyond the last sample.
  std::optional<WheelTravel> at(Time stamp) const;

 private:
  double max_gap_s() const { return std::max(max_gap_s_, usual_gap_.longest_s()); }
  WheelTravel travel(double left_rad, double right_rad) const;
  WheelCalibration wheels_;
  double max_gap_s_;
  std::deque<WheelSample> samples_;
  UsualGap usual_gap_;
  WheelTurns turns_;
};

}  // namespace vsslam

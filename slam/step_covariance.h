// How well the step from key scan to key scan is known: the covariance of odometry's edges in the pose graph.
#pragma once

#include <optional>

#include "core/se3.h"

namespace vsslam {

/// The priors since the last key scan say how far it is, and so do the registrations of both key scans against nearly the
/// same map; each of them as well as its scan was undistorted. All covariances are of right perturbations [rotation;
/// translation] of the base.
class StepCovariance {
 public:
  /// A scan that takes `scan_s` and was predicted `dt_s` after the last one, with the covariance `step` of T_last_predicted.
  /// `measured`: by an IMU whose noise is known, so that turns err as claimed and each anew; else by what is assumed of
  /// how robots move.
  void add_prediction(const SE3& T_last_predicted, const Mat6& step, double dt_s, double scan_s, bool measured);
  /// Where the scan was registered, against where it was predicted, and how well that was known.
  void add_registration(const Vec6& shift, const Mat6& predicted, const Mat6& known);
  /// A key scan, whose registration errs by `known` beside others against the same map. The covariance of its pose in the
  /// frame of the key scan before; of the first one: `known`.
  Mat6 add_key(const SE3& T_odom_base, const Mat6& known);
  /// The same of the last step, but for what its scans were bent by: large where neither priors nor scans saw how far it was.
  const Mat6& unseen() const { return unseen_; }

 private:
  struct Key {
    SE3 T_odom_base;
    Mat6 known, by_scan;  // with and without what the scan was bent by
  };
  Mat6 bend() const;
  std::optional<Key> last_key_;
  Mat6 missed_ = Mat6::Zero();     // by the priors since then, at the last scan, as if each step erred by itself
  Mat6 meanwhile_ = Mat6::Zero();  // by the prior while the last scan was taken, as it claims
  double steps_ = 0;
  bool measured_ = false;  // the last prediction
  Mat6 unseen_ = Mat6::Zero();
  double surprise_[2] = {1, 1};  // of rotation and translation, running means: 1 where the priors err as they claim
};

}  // namespace vsslam

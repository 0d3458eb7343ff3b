// How well the step from key scan to key scan is known: the covariance of odometry's edges in the pose graph.
#pragma once

#include <optional>

#include "core/se3.h"

namespace vsslam {

/// The priors since the last key scan say how far it is, and so do the registrations of both key scans against nearly the
/// same map. All covariances are of right perturbations [rotation; translation] of the base.
class StepCovariance {
 public:
  /// A scan's prediction. What it adds to the covariance of the last scan's pose is the prior's own error since.
  void add_prediction(const SE3& T_last_predicted, const Mat6& last, const Mat6& predicted);
  /// A key scan, whose registration errs by `known` beside others against the same map. The covariance of its pose in the
  /// frame of the key scan before; of the first one: `known`.
  Mat6 add_key(const SE3& T_odom_base, const Mat6& known);

 private:
  struct Key {
    SE3 T_odom_base;
    Mat6 known;
  };
  std::optional<Key> last_key_;
  Mat6 missed_ = Mat6::Zero();  // by the priors since then, at the last scan
};

}  // namespace vsslam

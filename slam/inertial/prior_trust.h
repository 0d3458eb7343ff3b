// Is what the prior promises true? Each registered scan tells how far the prior was off, against how far it said it
// might be.
#pragma once

#include "core/se3.h"

namespace vsslam {

class PriorTrust {
 public:
  /// A scan: the step from the predicted to the registered pose, what the prior claimed of it, and what was known
  /// afterwards. `rival` is the same step of standing by the last velocity; both right perturbations of the base. A scan
  /// that is `blind` in some direction cannot judge: there it followed whoever was believed.
  void add(const Vec6& shift, const Mat6& claimed, const Mat6& known, const Vec6& rival, bool blind);

  /// Whether the prior is worth more than the last velocity. Refused when it is off by five times what it claims, scan
  /// after scan, and by more than the last velocity; taken back once it has been right for two seconds of scans.
  bool believed() const { return believed_; }
  /// For good: what it is made from cannot be.
  void refuse() { believed_ = false, refused_ = true; }
  /// By how much its covariance is too small (>= 1): the mean of shift' claimed^-1 shift over what the scan could see.
  double inflation() const { return believed_ && mean_ > 1 ? mean_ : 1; }

 private:
  double mean_ = 1;
  double own_m_ = 0, rival_m_ = 0;  // running means of the errors
  int good_ = 0;
  bool believed_ = true, refused_ = false;
};

}  // namespace vsslam

// How far apart the samples of a sensor usually are, whatever its sheet says.
#pragma once

#include <algorithm>

namespace vsslam {

class UsualGap {
 public:
  /// A gap counts as at most twice the usual: it may be a dropout.
  void add(double gap_s) {
    constexpr double kMemory = 0.9;
    usual_s_ = usual_s_ == 0 ? gap_s : kMemory * usual_s_ + (1 - kMemory) * std::min(gap_s, 2 * usual_s_);
  }
  /// Longer is a dropout. No robot's motion is told by less than three samples a second.
  double longest_s() const {
    constexpr double kPeriods = 3, kMost_s = 0.3;
    return std::min(kPeriods * usual_s_, kMost_s);
  }

 private:
  double usual_s_ = 0;
};

}  // namespace vsslam

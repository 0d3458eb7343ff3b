#include <algorithm>

#include "slam/inertial/motion_prior.h"

namespace vsslam {

void MotionPath::append(Time stamp, const SE3& T_begin_t) {
  if (stamp > knots_.back().stamp) knots_.push_back({stamp, T_begin_t});
}

SE3 MotionPath::at(Time stamp) const {
  if (knots_.size() < 2 || stamp <= knots_.front().stamp) return knots_.front().pose;
  auto after = std::upper_bound(knots_.begin() + 1, knots_.end() - 1, stamp,
                                [](Time t, const StampedPose& knot) { return t < knot.stamp; });
  const StampedPose& a = *(after - 1);
  const StampedPose& b = *after;
  return interpolate(a.pose, b.pose, seconds_between(a.stamp, stamp) / seconds_between(a.stamp, b.stamp));
}

MotionPath MotionPath::bent(const Vec6& change) const {
  const Time begin = knots_.front().stamp;
  const double whole_s = seconds_between(begin, knots_.back().stamp);
  MotionPath path(begin);
  for (const StampedPose& knot : knots_)
    path.append(knot.stamp, knot.pose * SE3::exp(seconds_between(begin, knot.stamp) / whole_s * change));
  return path;
}

}  // namespace vsslam

#include "slam/step_covariance.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <utility>

#include "slam/inertial/pose_covariance.h"

namespace vsslam {

namespace {

// Of what two sources tell that err by themselves.
Mat6 together(const Mat6& a, const Mat6& b) {
  const Mat6 information = a.ldlt().solve(Mat6::Identity()) + b.ldlt().solve(Mat6::Identity());
  return information.ldlt().solve(Mat6::Identity());
}

}  // namespace

void StepCovariance::add_prediction(const SE3& T_last_predicted, const Mat6& step, double dt_s, double scan_s,
                                    bool measured) {
  missed_ = moved_covariance(missed_, T_last_predicted) + step;
  ++steps_;
  // Of a step that is longer than the scan: the error of a velocity grows with time, white noise with its root.
  const double share = scan_s / dt_s;
  meanwhile_ = (measured ? share : share * share) * step;
  measured_ = measured;
}

void StepCovariance::add_registration(const Vec6& shift, const Mat6& predicted, const Mat6& known) {
  constexpr double kMemory = 0.95;  // two seconds of scans
  for (const int block : {0, 1}) {
    const Vec3 off = shift.segment<3>(3 * block);
    const auto claimed = predicted.block<3, 3>(3 * block, 3 * block).ldlt();
    const double seen = 3 - claimed.solve(known.block<3, 3>(3 * block, 3 * block)).trace();
    if (seen < 0.5) continue;  // the scan had no say
    surprise_[block] = kMemory * surprise_[block] + (1 - kMemory) * off.dot(claimed.solve(off)) / seen;
  }
}

// The pose of a scan is that of its stamp, its points were moved there by the prior: on average they err as the mean of a
// random walk does, by a third of the variance at its end.
Mat6 StepCovariance::bend() const {
  const double least = measured_ ? 1 : 0;
  Vec6 factor;
  factor << Vec3::Constant(std::sqrt(std::max(least, surprise_[0]) / 3)),
      Vec3::Constant(std::sqrt(std::max(least, surprise_[1]) / 3));
  return factor.asDiagonal() * meanwhile_ * factor.asDiagonal();
}

Mat6 StepCovariance::add_key(const SE3& T_odom_base, const Mat6& known_by_scan) {
  const Mat6 known = known_by_scan + bend();
  const std::optional<Key> last = std::exchange(last_key_, Key{T_odom_base, known, known_by_scan});
  // The error of a velocity lasts: n steps that err alike have n times the variance of n that err by themselves.
  const double n = std::exchange(steps_, 0);
  Vec6 alike;
  alike << Vec3::Constant(measured_ ? 1 : std::sqrt(n)), Vec3::Constant(std::sqrt(n));
  const Mat6 missed = alike.asDiagonal() * std::exchange(missed_, Mat6::Zero()) * alike.asDiagonal();
  if (!last) return known;
  const SE3 T_last_now = last->T_odom_base.inverse() * T_odom_base;
  unseen_ = together(missed, moved_covariance(last->by_scan, T_last_now) + known_by_scan);
  return together(missed, moved_covariance(last->known, T_last_now) + known);
}

}  // namespace vsslam

#include "slam/inertial/dead_reckoning.h"

#include "slam/inertial/pose_covariance.h"

namespace vsslam {

namespace {

// The step is bent by half the rotation: constant curvature.
Vec3 arc(const Vec3& rotation, double forward_m) {
  return so3_exp(0.5 * rotation) * Vec3(forward_m, 0, 0);
}

}  // namespace

Vec3 way_sigma_m(const InertialConfig& config, double way_m, double turn_rad) {
  constexpr double kStep_m = 1e-3;  // of an encoder, and of a wheel that rolls over the grain of the floor
  constexpr double kSkid_m = 0.05;  // from the base's origin to where a robot without steering turns about, along it
  const double forward_m = config.wheel_slip * way_m + kStep_m;
  return {forward_m, 2 * forward_m + kSkid_m * turn_rad, 2 * forward_m};
}

DeadReckoning::DeadReckoning(const InertialConfig& config, const RigCalibration& rig, bool use_wheels)
    : config_(config), use_wheels_(use_wheels), wheels_(rig.wheels, config.max_gap_s), fixes_(config) {}

void DeadReckoning::add(const WheelSample& sample) {
  if (use_wheels_) wheels_.add(sample);
}

// At the stamps of the samples, and where there are none as the last fixes moved.
MotionPath DeadReckoning::path(Time begin, Time end) const {
  constexpr Duration kLongest{20'000'000};
  MotionPath path(begin);
  std::vector<Time> knots{begin};
  const auto fill_until = [&](Time stamp) {
    while (stamp - knots.back() > kLongest) knots.push_back(knots.back() + kLongest);
    knots.push_back(stamp);
  };
  for (const WheelSample& sample : wheels_.samples())
    if (sample.stamp > begin && sample.stamp < end) fill_until(sample.stamp);
  if (end > begin) fill_until(end);
  SE3 T_begin_t;
  for (size_t i = 1; i < knots.size(); ++i) {
    const auto a = wheels_.at(knots[i - 1]), b = wheels_.at(knots[i]);
    const double dt_s = seconds_between(knots[i - 1], knots[i]);
    if (a && b) {
      const Vec3 rotation(0, 0, b->yaw_rad - a->yaw_rad);
      T_begin_t = T_begin_t * SE3(so3_exp(rotation), arc(rotation, b->forward_m - a->forward_m));
    } else {
      T_begin_t = T_begin_t * SE3::exp(fixes_.twist() * dt_s);
    }
    path.append(knots[i], T_begin_t);
  }
  return path;
}

std::optional<Vec3> DeadReckoning::way(const MotionPath& path) const {
  const std::vector<StampedPose>& knots = path.knots();
  Vec3 way = Vec3::Zero();
  for (size_t i = 1; i < knots.size(); ++i) {
    const auto a = wheels_.at(knots[i - 1].stamp), b = wheels_.at(knots[i].stamp);
    if (!a || !b) return std::nullopt;
    const Quat& q_begin_a = knots[i - 1].pose.rotation;
    way += q_begin_a * arc(so3_log(q_begin_a.conjugate() * knots[i].pose.rotation), b->forward_m - a->forward_m);
  }
  return knots.size() > 1 ? std::optional(way) : std::nullopt;
}

std::optional<double> DeadReckoning::rolled_m(Time from, Time to) const {
  const auto a = wheels_.at(from), b = wheels_.at(to);
  return a && b ? std::optional(b->forward_m - a->forward_m) : std::nullopt;
}

// What the wheels leave open, the velocity of the last fixes says.
Mat6 DeadReckoning::covariance(Time end, const Mat6& last_pose, Mat6 covariance) const {
  const auto& last = fixes_.last();
  if (!last || end <= last->stamp || !wheels_.at(last->stamp) || !wheels_.at(end)) return covariance;
  const SE3 T_last_end = path(last->stamp, end).end_pose();
  const Mat6 known = moved_covariance(last_pose, T_last_end);
  const double turn_rad = config_.wheel_turn_slip * T_last_end.angle() + 0.01 * seconds_between(last->stamp, end);
  covariance(2, 2) = known(2, 2) + turn_rad * turn_rad;
  covariance.bottomRightCorner<3, 3>() = known.bottomRightCorner<3, 3>();
  const Vec3 sigma_m = way_sigma_m(config_, T_last_end.translation.norm(), T_last_end.angle());
  covariance.diagonal().tail<3>() += sigma_m.cwiseAbs2();
  covariance.topRightCorner<3, 3>().setZero();
  covariance.bottomLeftCorner<3, 3>().setZero();
  return covariance;
}

Mat6 DeadReckoning::covariance(Time end) const {
  return covariance(end, fixes_.last() ? fixes_.last()->covariance : Mat6::Zero(), fixes_.covariance(end));
}

Mat6 DeadReckoning::step_covariance(Time end) const {
  return covariance(end, Mat6::Zero(), fixes_.step_covariance(end));
}

void DeadReckoning::correct(const OdometryFix& fix) {
  fixes_.add(fix);
  wheels_.forget_before(fix.stamp);
}

}  // namespace vsslam

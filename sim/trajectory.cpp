#include "sim/trajectory.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>

namespace vsslam {

namespace {

// The cumulative cubic basis functions lambda_1..3 of u in [0, 1], and their derivatives by u.
struct Basis {
  std::array<double, 3> value;
  explicit Basis(double u)
      : value{(5 + u * (3 + u * (u - 3))) / 6, (1 + u * (3 + u * (3 - 2 * u))) / 6, u * u * u / 6} {}
};
std::array<double, 3> basis_slope(double u) {
  return {(3 + u * (3 * u - 6)) / 6, (3 + u * (6 - 6 * u)) / 6, 0.5 * u * u};
}
std::array<double, 3> basis_curvature(double u) {
  return {u - 1, 1 - 2 * u, u};
}

[[noreturn]] void abort_with(const std::string& message) {
  std::fprintf(stderr, "trajectory: %s\n", message.c_str());
  std::abort();
}

}  // namespace

Trajectory::Trajectory(Duration knot_interval) : interval_(knot_interval) {
  if (interval_.ns <= 0) abort_with("the knot interval must be positive");
}

void Trajectory::push(Time stamp, const SE3& T_world_base) {
  Knot knot{.T_world_base = T_world_base};
  if (knots_.empty()) {
    first_knot_ns_ = stamp.ns;
  } else {
    const int64_t expected_ns = first_knot_ns_ + interval_.ns * static_cast<int64_t>(knots_.size());
    if (stamp.ns != expected_ns)
      abort_with(fmt::format("knot at {} ns, expected at {} ns", stamp.ns, expected_ns));
    const SE3& before = knots_.back().T_world_base;
    knot.rotation_step = so3_log(before.rotation.conjugate() * T_world_base.rotation);
    knot.translation_step = T_world_base.translation - before.translation;
  }
  knots_.push_back(knot);
}

void Trajectory::forget_before(Time stamp) {
  while (knots_.size() > 4 && first_knot_ns_ + 2 * interval_.ns <= stamp.ns) {
    knots_.pop_front();
    first_knot_ns_ += interval_.ns;
  }
}

Time Trajectory::begin() const {
  return {first_knot_ns_ + interval_.ns};
}

Time Trajectory::end() const {
  return {first_knot_ns_ + interval_.ns * (static_cast<int64_t>(knots_.size()) - 2)};
}

Trajectory::Segment Trajectory::segment(Time stamp) const {
  if (knots_.size() < 4 || stamp < begin() || stamp > end())
    abort_with(fmt::format("asked for {} ns, defined from {} to {} ns", stamp.ns, begin().ns, end().ns));
  const int64_t since_begin_ns = stamp.ns - begin().ns;
  const int64_t index = std::min(since_begin_ns / interval_.ns, static_cast<int64_t>(knots_.size()) - 4);
  Segment out;
  for (size_t k = 0; k < 4; ++k) out.knots[k] = &knots_[static_cast<size_t>(index) + k];
  out.u = static_cast<double>(since_begin_ns - index * interval_.ns) / static_cast<double>(interval_.ns);
  return out;
}

SE3 Trajectory::pose(Time stamp) const {
  const Segment s = segment(stamp);
  const Basis lambda(s.u);
  SE3 T_world_base = s.knots[0]->T_world_base;
  for (size_t k = 0; k < 3; ++k) {
    const Knot& knot = *s.knots[k + 1];
    T_world_base.rotation = T_world_base.rotation * so3_exp(lambda.value[k] * knot.rotation_step);
    T_world_base.translation += lambda.value[k] * knot.translation_step;
  }
  T_world_base.rotation.normalize();
  return T_world_base;
}

// Sommer et al., "Efficient Derivative Computation for Cumulative B-Splines on Lie Groups", CVPR 2020, eqs.
// 20-23: with A = Exp(lambda d), omega <- A^T omega + lambda' d and alpha <- A^T alpha + lambda' omega x d +
// lambda'' d.
Kinematics Trajectory::at(Time stamp) const {
  const Segment s = segment(stamp);
  const Basis lambda(s.u);
  const std::array<double, 3> slope = basis_slope(s.u), curvature = basis_curvature(s.u);
  const double rate_hz = 1.0 / interval_.seconds();
  Kinematics out{.T_world_base = s.knots[0]->T_world_base};
  for (size_t k = 0; k < 3; ++k) {
    const Knot& knot = *s.knots[k + 1];
    const Vec3& d = knot.rotation_step;
    const double lambda_dot = rate_hz * slope[k], lambda_ddot = rate_hz * rate_hz * curvature[k];
    const Quat a = so3_exp(lambda.value[k] * d);
    out.omega_base = a.conjugate() * out.omega_base + lambda_dot * d;
    out.alpha_base = a.conjugate() * out.alpha_base + lambda_dot * out.omega_base.cross(d) + lambda_ddot * d;
    out.T_world_base.rotation = out.T_world_base.rotation * a;
    out.T_world_base.translation += lambda.value[k] * knot.translation_step;
    out.v_world += lambda_dot * knot.translation_step;
    out.a_world += lambda_ddot * knot.translation_step;
  }
  out.T_world_base.rotation.normalize();
  return out;
}

}  // namespace vsslam

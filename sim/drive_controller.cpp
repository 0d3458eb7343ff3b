#include "sim/drive_controller.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace vsslam {

namespace {

constexpr double kReach_m = 0.6;    // distance in which an offset from the path decays
constexpr double kSteepest = 0.57;  // sine of the angle at which the path is approached: 35 deg
constexpr double kAhead_m = 0.15;
constexpr double kPreview_s = 0.06;  // the command runs ahead by what the yaw rate lags
constexpr double kAligned_rad = 0.05, kMisaligned_rad = 1.1;
constexpr double kTurned_rad = 0.003;
constexpr double kArrived_m = 0.01;
constexpr double kCreep_mps = 0.05, kStanding_mps = 0.01;

}  // namespace

DriveController::DriveController(const ScoutConfig& scout, DrivePlan plan)
    : scout_(scout), effective_track_m_(effective_track_m(scout)), plan_(std::move(plan)) {}

Sides DriveController::drive(const PlanarPose& believed, double dt_s) {
  Targets targets;
  distance_m_ = 0;
  if (!finished()) {
    const PlannedStep& step = plan_.steps[step_];
    if (const auto* r = std::get_if<PlannedRest>(&step)) targets = rest(*r, dt_s);
    if (const auto* t = std::get_if<PlannedTurn>(&step)) targets = turn(*t, believed.yaw_rad);
    if (const auto* f = std::get_if<PlannedFollow>(&step)) targets = follow(*f, believed);
  }
  approach(targets, dt_s);
  const double half_difference_mps = 0.5 * yaw_rate_radps_ * effective_track_m_;
  return {(speed_mps_ - half_difference_mps) / scout_.wheel_radius_m,
          (speed_mps_ + half_difference_mps) / scout_.wheel_radius_m};
}

void DriveController::approach(const Targets& targets, double dt_s) {
  const auto towards = [dt_s](double& value, double target, double rate) {
    value += std::clamp(target - value, -rate * dt_s, rate * dt_s);
  };
  towards(speed_mps_, std::clamp(targets.speed_mps, 0.0, scout_.max_speed_mps), scout_.accel_mps2);
  const double fastest_radps = scout_.max_yaw_rate_radps;
  towards(yaw_rate_radps_, std::clamp(targets.yaw_rate_radps, -fastest_radps, fastest_radps),
          scout_.yaw_accel_radps2);
}

void DriveController::next_step() {
  ++step_;
  rested_s_ = along_m_ = 0;
  turning_ = aligning_ = false;
}

DriveController::Targets DriveController::rest(const PlannedRest& rest, double dt_s) {
  rested_s_ += dt_s;
  if (rested_s_ >= rest.duration_s) next_step();
  return {};
}

// The fastest rate from which the turn can still be ended in time.
double DriveController::turning_rate(double remaining_rad, double fastest_radps) const {
  const double braking_radps = std::sqrt(2 * 0.7 * scout_.yaw_accel_radps2 * std::abs(remaining_rad));
  return std::copysign(std::min({fastest_radps, braking_radps, 5 * std::abs(remaining_rad)}), remaining_rad);
}

DriveController::Targets DriveController::turn(const PlannedTurn& turn, double yaw_rad) {
  if (!turning_) {
    turning_ = true;
    to_turn_rad_ = turn.angle_rad + wrap_angle(turn.from_rad - yaw_rad);  // makes up for an error before
    last_yaw_rad_ = yaw_rad;
  }
  to_turn_rad_ -= wrap_angle(yaw_rad - last_yaw_rad_);
  last_yaw_rad_ = yaw_rad;
  if (std::abs(to_turn_rad_) < kTurned_rad) {
    next_step();
    return {};
  }
  return {0, turning_rate(to_turn_rad_, turn.rate_radps)};
}

// Steers by the path's curvature and, second order in arc length, back to the path:
// kappa = kappa_path - 2 sin(heading error) / reach - offset / reach^2.
DriveController::Targets DriveController::follow(const PlannedFollow& follow, const PlanarPose& believed) {
  const Path& path = follow.path;
  along_m_ = path.nearest(believed.position_m, along_m_, along_m_ + 1.0);
  const Path::Place place = path.at(along_m_);
  const Vec2 from_path = believed.position_m - place.position_m;
  const Vec2 left(-std::sin(place.heading_rad), std::cos(place.heading_rad));
  const double offset_m = left.dot(from_path);
  const double heading_error_rad = wrap_angle(believed.yaw_rad - place.heading_rad);
  distance_m_ = from_path.norm();

  const Path::Place ahead = path.at(along_m_ + speed_mps_ * kPreview_s);
  const double remaining_m = path.length_m() - along_m_;
  if (remaining_m < kArrived_m) {
    if (speed_mps_ < kStanding_mps) next_step();
    return {};
  }
  aligning_ = std::abs(heading_error_rad) > (aligning_ ? kAligned_rad : kMisaligned_rad);
  if (aligning_) return {0, speed_mps_ < kStanding_mps ? -turning_rate(heading_error_rad, 0.5) : 0};

  const double back = 0.5 * std::clamp(offset_m / kReach_m, -2 * kSteepest, 2 * kSteepest);
  const double curvature_radpm = ahead.curvature_radpm / std::max(0.5, 1 - ahead.curvature_radpm * offset_m) -
                                 2 / kReach_m * (std::sin(heading_error_rad) + back);
  const double braking_mps = std::sqrt(2 * 0.8 * scout_.accel_mps2 * remaining_m);
  // The profile a little ahead, for what the robot lags; towards the end braking_mps alone decides.
  const double profile_m = remaining_m > 2 * kAhead_m ? along_m_ + kAhead_m : along_m_;
  const double reachable_mps = std::max(kCreep_mps, path.at(profile_m).speed_mps);
  const double turnable_mps = 0.9 * scout_.max_yaw_rate_radps / std::max(std::abs(curvature_radpm), 1e-6);
  const double speed_mps = std::min({reachable_mps, std::max(kCreep_mps, braking_mps), turnable_mps});
  return {speed_mps, std::min(speed_mps_, speed_mps + 0.05) * curvature_radpm};
}

std::string DriveController::doing() const {
  if (finished()) return "at the end of the drive";
  const std::string count = fmt::format("step {} of {}", step_ + 1, plan_.steps.size());
  const PlannedStep& step = plan_.steps[step_];
  if (const auto* f = std::get_if<PlannedFollow>(&step))
    return fmt::format("following {}, {:.1f} of {:.1f} m ({})", f->name, along_m_, f->path.length_m(), count);
  return fmt::format("{} ({})", std::holds_alternative<PlannedTurn>(step) ? "turning in place" : "resting",
                     count);
}

}  // namespace vsslam

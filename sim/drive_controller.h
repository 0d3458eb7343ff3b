// The driver: turns a plan and the pose that the robot believes to have into wheel speeds.
#pragma once

#include <string>

#include "core/time.h"
#include "sim/drive_plan.h"
#include "sim/dynamics.h"

namespace vsslam {

class DriveController {
 public:
  /// A robot farther than this from its path has lost it.
  static constexpr double kLost_m = 2.0;

  DriveController(const ScoutConfig& scout, DrivePlan plan);

  /// Wheel speeds (rad/s) for the time until the next call, `dt_s` later.
  Sides drive(const PlanarPose& believed, double dt_s);
  /// All steps done; the robot is told to stand.
  bool finished() const { return step_ == plan_.steps.size(); }
  /// Speeds that the robot should have now.
  bool wants_to_move() const { return speed_mps_ > 0.02 || std::abs(yaw_rate_radps_) > 0.02; }
  /// Believed distance to the path at the last call, m; 0 where no path is followed.
  double distance_to_path_m() const { return distance_m_; }
  /// For a person: "following ring, 12.3 of 45.0 m".
  std::string doing() const;
  const DrivePlan& plan() const { return plan_; }

 private:
  struct Targets {
    double speed_mps = 0, yaw_rate_radps = 0;
  };
  Targets rest(const PlannedRest& rest, double dt_s);
  Targets turn(const PlannedTurn& turn, double yaw_rad);
  Targets follow(const PlannedFollow& follow, const PlanarPose& believed);
  double turning_rate(double remaining_rad, double fastest_radps) const;
  void approach(const Targets& targets, double dt_s);
  void next_step();

  const ScoutConfig scout_;
  const double effective_track_m_;
  DrivePlan plan_;
  size_t step_ = 0;
  // Of the step that runs.
  double rested_s_ = 0;
  bool turning_ = false;  // the turn has begun and last_yaw_rad_, to_turn_rad_ hold
  double last_yaw_rad_ = 0, to_turn_rad_ = 0;
  double along_m_ = 0;     // on the path
  bool aligning_ = false;  // turning towards the path's heading in place
  double distance_m_ = 0;
  // What is commanded; changes with limited acceleration.
  double speed_mps_ = 0, yaw_rate_radps_ = 0;
};

}  // namespace vsslam

// What happens: rigid-body dynamics of the Scout in the world at 1 kHz, driven by a script.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/se3.h"
#include "core/time.h"
#include "sim/drive_script.h"
#include "sim/motion.h"
#include "sim/scout.h"
#include "worlds/world.h"

namespace vsslam {

enum class DriveOutcome { driving, finished, stuck, collided };

/// The `robot` and `sim` side of a run. Deterministic: same inputs, same states to the bit.
class Simulation {
 public:
  /// The robot stands still at time 0. Throws InputError: a script that cannot be driven in this world, a start inside
  /// an object.
  Simulation(const World& world, const ScoutConfig& scout, const DriveScript& script);
  ~Simulation();
  Simulation(const Simulation&) = delete;
  Simulation& operator=(const Simulation&) = delete;

  /// Steps the dynamics (1 kHz) until now() >= until, or the drive ends for a reason other than `driving`.
  /// After the drive has ended the robot rests where it is and time still advances.
  void advance(Time until);

  Time now() const;
  /// Truth up to trajectory().end(), a little before now().
  const Trajectory& trajectory() const;
  WheelState wheels(Time stamp) const;
  /// A copy of the truth from `from` to `until`, both within what the trajectory knows.
  Motion motion_since(Time from, Time until) const;
  /// Drops what is only needed before `stamp`.
  void forget_before(Time stamp);

  DriveOutcome outcome() const;
  /// What happened, where and when, for a person: "stuck at (12.3, 4.5) m after 31.2 s: ...".
  std::string outcome_text() const;
  /// Expected length of the whole script in seconds, for progress.
  double expected_duration_s() const;

  /// Closed loop: from now on the controller steers by this pose instead of the truth, extrapolated by the
  /// wheel rotation since `stamp`.
  void set_believed_pose(Time stamp, const SE3& T_world_base);

  /// Largest deviation of the spline from the states of the dynamics so far.
  struct Deviation {
    double translation_m = 0, rotation_rad = 0;
  };
  Deviation spline_deviation() const;

  /// Wheel slip: between the two times the floor's friction under the left and right wheels is scaled.
  /// Overlapping intervals multiply. Call before the interval begins.
  void scale_friction(Time from, Time to, double left_scale, double right_scale);

  /// Objects that move or appear: current placement of an object of the world, see events.
  void set_object_pose(int object, const Eigen::Affine3d& T_world_object, bool present);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace vsslam

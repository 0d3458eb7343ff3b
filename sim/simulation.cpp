#include "sim/simulation.h"

#include <fmt/format.h>

#include <algorithm>
#include <deque>

#include "core/errors.h"
#include "sim/drive_controller.h"
#include "sim/dynamics.h"
#include "sim/vibration.h"
#include "sim/wheel_log.h"

namespace vsslam {

namespace {

constexpr double kStep_s = 1e-9 * static_cast<double>(Dynamics::kStep_ns);
constexpr int kSettleSteps = 1000;  // the robot comes to rest on its tyres before time 0

struct FrictionChange {
  Time from, to;
  Sides scale;
};

// Notices when a robot that should move does not.
class ProgressWatch {
 public:
  static constexpr double kPatience_s = 4.0;

  bool stuck(Time now, bool should_move, const PlanarPose& pose) {
    constexpr double kMoved_m = 0.05, kTurned_rad = 0.05;
    const PlanarPose moved = relative(reference_, pose);
    if (!should_move || moved.position_m.norm() > kMoved_m || std::abs(moved.yaw_rad) > kTurned_rad) {
      reference_ = pose;
      since_ = now;
    }
    return seconds_between(since_, now) > kPatience_s;
  }

 private:
  PlanarPose reference_;
  Time since_;
};

// Compares each state of the dynamics with the spline, as soon as the spline reaches it.
class DeviationWatch {
 public:
  void push(Time stamp, const SE3& T_world_base) { waiting_.push_back({stamp, T_world_base}); }
  void compare(const Trajectory& trajectory) {
    if (trajectory.knot_count() < 4) return;
    for (; !waiting_.empty() && waiting_.front().stamp <= trajectory.end(); waiting_.pop_front()) {
      const SE3 &state = waiting_.front().pose, spline = trajectory.pose(waiting_.front().stamp);
      largest_.translation_m =
          std::max(largest_.translation_m, (spline.translation - state.translation).norm());
      const Vec3 turned = so3_log(state.rotation.conjugate() * spline.rotation);
      largest_.rotation_rad = std::max(largest_.rotation_rad, turned.norm());
    }
  }
  Simulation::Deviation largest() const { return largest_; }

 private:
  std::deque<StampedPose> waiting_;
  Simulation::Deviation largest_;
};

}  // namespace

struct Simulation::Impl {
  Impl(const World& world_, const ScoutConfig& scout_, const DriveScript& script)
      : scout(scout_),
        driver(scout, plan_drive(script, world_, scout)),
        dynamics(world_, scout, driver.plan().start.position_m.x(), driver.plan().start.position_m.y(),
                 driver.plan().start.yaw_rad),
        vibration(scout),
        wheels(scout) {
    for (const Object& object : world_.objects) object_names.push_back(object.name);
    settle();
  }

  void settle() {
    for (int i = 0; i < kSettleSteps; ++i) {
      dynamics.step({}, {1, 1});
      if (dynamics.touched_object() >= 0)
        throw InputError(
            fmt::format("drive.start: at {} the robot touches {}", place_text(), touched_name()));
    }
    trajectory.push(now - trajectory.knot_interval(),
                    dynamics.state().T_world_base * vibration.T_still_base());
    record();
  }

  void step() {
    now = now + Duration{Dynamics::kStep_ns};
    const Sides wheel_radps = driver.drive(believed_pose(), kStep_s);
    dynamics.step(outcome == DriveOutcome::driving ? wheel_radps : Sides{}, friction_scale());
    record();
    if (outcome == DriveOutcome::driving) judge();
  }

  void record() {
    const RobotState& state = dynamics.state();
    wheels.push(now, state);
    vibration.roll_on(state, kStep_s);
    const SE3 T_world_base = state.T_world_base * vibration.T_still_base();
    deviation.push(now, T_world_base);
    if (now.ns % trajectory.knot_interval().ns != 0) return;
    trajectory.push(now, T_world_base);
    deviation.compare(trajectory);
  }

  void judge() {
    if (dynamics.touched_object() >= 0) {
      end(DriveOutcome::collided, fmt::format("collided with {}", touched_name()));
    } else if (progress.stuck(now, driver.wants_to_move(), planar(dynamics.state().T_world_base))) {
      end(DriveOutcome::stuck, fmt::format("stuck, no progress for {} s", ProgressWatch::kPatience_s));
    } else if (driver.distance_to_path_m() > DriveController::kLost_m) {
      end(DriveOutcome::stuck, fmt::format("lost, {:.1f} m from its path", driver.distance_to_path_m()));
    } else if (driver.finished()) {
      end(DriveOutcome::finished, "finished");
    }
  }

  void end(DriveOutcome why, const std::string& what) {
    outcome = why;
    outcome_text = fmt::format("{} at {} after {:.1f} s", what, place_text(), now.seconds());
    if (why != DriveOutcome::finished) outcome_text += ": " + driver.doing();
  }

  // The truth, or in closed loop what the estimate says, carried on by the wheels.
  PlanarPose believed_pose() const {
    if (!believed) return planar(dynamics.state().T_world_base);
    return compose(planar(believed->pose), wheels.moved_since(believed->stamp));
  }

  Sides friction_scale() const {
    Sides scale{1, 1};
    for (const FrictionChange& change : friction_changes) {
      if (now < change.from || now >= change.to) continue;
      scale.left *= change.scale.left;
      scale.right *= change.scale.right;
    }
    return scale;
  }

  std::string place_text() const {
    const Vec3& p_world = dynamics.state().T_world_base.translation;
    return fmt::format("({:.2f}, {:.2f}) m", p_world.x(), p_world.y());
  }
  std::string touched_name() const {
    const size_t object = static_cast<size_t>(dynamics.touched_object());
    return object_names[object].empty() ? fmt::format("object {}", object) : object_names[object];
  }

  const ScoutConfig scout;
  std::vector<std::string> object_names;
  DriveController driver;
  Dynamics dynamics;
  Vibration vibration;
  Time now;
  Trajectory trajectory;
  WheelLog wheels;
  DeviationWatch deviation;
  ProgressWatch progress;
  std::vector<FrictionChange> friction_changes;
  std::optional<StampedPose> believed;  // T_world_base
  DriveOutcome outcome = DriveOutcome::driving;
  std::string outcome_text = "driving";
};

Simulation::Simulation(const World& world, const ScoutConfig& scout, const DriveScript& script)
    : impl_(std::make_unique<Impl>(world, scout, script)) {}
Simulation::~Simulation() = default;

void Simulation::advance(Time until) {
  const DriveOutcome before = impl_->outcome;
  while (impl_->now < until && impl_->outcome == before) impl_->step();
}

Time Simulation::now() const {
  return impl_->now;
}
const Trajectory& Simulation::trajectory() const {
  return impl_->trajectory;
}
WheelState Simulation::wheels(Time stamp) const {
  return impl_->wheels.at(stamp);
}

Motion Simulation::motion_since(Time from, Time until) const {
  Motion motion{until, impl_->trajectory, impl_->wheels.since(from)};
  motion.trajectory.forget_before(from);
  return motion;
}

void Simulation::forget_before(Time stamp) {
  impl_->trajectory.forget_before(stamp);
  impl_->wheels.forget_before(stamp);
}

DriveOutcome Simulation::outcome() const {
  return impl_->outcome;
}
std::string Simulation::outcome_text() const {
  return impl_->outcome_text;
}
double Simulation::expected_duration_s() const {
  return impl_->driver.plan().duration_s(impl_->scout);
}

void Simulation::scale_friction(Time from, Time to, double left_scale, double right_scale) {
  impl_->friction_changes.push_back({from, to, {left_scale, right_scale}});
}

void Simulation::set_believed_pose(Time stamp, const SE3& T_world_base) {
  impl_->believed = StampedPose{stamp, T_world_base};
}

Simulation::Deviation Simulation::spline_deviation() const {
  return impl_->deviation.largest();
}

void Simulation::set_object_pose(int object, const Eigen::Affine3d& T_world_object, bool present) {
  impl_->dynamics.set_object_pose(object, T_world_object, present);
}

}  // namespace vsslam

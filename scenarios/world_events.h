// What changes during a run, by the simulated clock.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/config.h"
#include "core/time.h"
#include "sensors/sensor_events.h"
#include "worlds/world.h"

namespace vsslam {

/// An object that appears, disappears or moves (a door that opens turns about its own origin).
struct ObjectEvent {
  enum class Action { appear, disappear, move };
  double t_s = 0;
  std::string object;  ///< name of an object of the world
  Action action = Action::move;
  Vec3 offset_m = Vec3::Zero();  ///< from its place in the world file, in the world frame
  double yaw_deg = 0;            ///< about its own origin, counterclockwise seen from above
  void fields(Fields& f);
};

/// Wheels that lose their grip: oil, wet leaves, a threshold.
struct WheelSlipEvent {
  double t_s = 0, duration_s = 1;
  double left_friction = 0.1, right_friction = 0.1;  ///< share of the normal friction
  void fields(Fields& f);
};

/// Lamps that go off, on, or are dimmed. For cameras.
struct LightEvent {
  double t_s = 0;
  std::string group;  ///< of lights; empty: all
  double level = 0;   ///< share of the intensity in the world file
  void fields(Fields& f);
};

/// The `events` section of a scenario.
struct EventsConfig {
  SensorEvents sensors;
  std::vector<WheelSlipEvent> wheel_slip;
  std::vector<ObjectEvent> objects;
  std::vector<LightEvent> lights;
  void fields(Fields& f);
};

/// State of an object at a time.
struct ObjectState {
  int object = 0;  ///< index into World::objects
  Eigen::Affine3d T_world_object = Eigen::Affine3d::Identity();
  bool present = true;
};

/// Object events in order of time, resolved against a world.
class ObjectTimeline {
 public:
  /// Throws InputError for an object that the world does not have, with the nearest name.
  ObjectTimeline(const World& world, const std::vector<ObjectEvent>& events);

  /// Objects that are not there at the start because they appear later.
  const std::vector<ObjectState>& initial() const { return initial_; }
  /// Time of the next event after those taken; nullopt when none is left.
  std::optional<Time> next() const;
  /// Changes due at or before `now`, each returned once.
  std::vector<ObjectState> take(Time now);

 private:
  struct Change {
    Time stamp;
    ObjectState state;
  };
  std::vector<ObjectState> initial_;
  std::vector<Change> changes_;
  size_t taken_ = 0;
};

}  // namespace vsslam

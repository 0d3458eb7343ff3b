// Objects that appear, disappear or slide during a run: where they are at a given time.
#pragma once

#include <map>
#include <utility>
#include <vector>

#include "core/time.h"
#include "sensors/measurement/sensor_events.h"
#include "worlds/world.h"

namespace vsslam {

struct ObjectState {
  Eigen::Affine3d T_world_object = Eigen::Affine3d::Identity();
  bool present = true;
  bool operator==(const ObjectState& other) const {
    return present == other.present && T_world_object.matrix() == other.T_world_object.matrix();
  }
};

/// The events of each object in order of time. An object whose first event is to appear is absent before.
class MovingObjects {
 public:
  /// Throws InputError if the world has no such object.
  MovingObjects(const World& world, const std::vector<ObjectEvent>& events);
  /// Objects with events: index into World::objects.
  const std::vector<int>& objects() const { return indices_; }
  ObjectState state(int object, Time stamp) const;
  /// The objects that are not as `placed` says, in order of objects(); `placed` then says it. It begins empty: all
  /// objects are new.
  std::vector<std::pair<int, ObjectState>> changes(Time stamp, std::vector<ObjectState>& placed) const;

 private:
  const World& world_;
  std::vector<int> indices_;
  std::map<int, std::vector<ObjectEvent>> events_;
};

}  // namespace vsslam

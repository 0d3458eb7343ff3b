// How strongly each group of lights shines at a given time, by the scenario's light events.
#pragma once

#include <string>
#include <vector>

#include "sensors/measurement/sensor_events.h"
#include "sensors/render/renderer.h"

namespace vsslam {

class LightSwitches {
 public:
  /// Throws InputError if an event names a group that there is not.
  LightSwitches(const std::vector<std::string>& groups, const std::vector<LightEvent>& events);
  /// In order of the groups. All shine fully until an event says otherwise.
  LightLevels levels(Time stamp) const;

 private:
  size_t groups_;
  std::vector<LightEvent> events_;   // in order of time
  std::vector<int> group_of_event_;  // -1: all
};

}  // namespace vsslam

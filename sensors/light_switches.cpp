#include "sensors/light_switches.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/errors.h"

namespace vsslam {

namespace {

constexpr int kAll = -1;

int find_group(const std::vector<std::string>& groups, const std::string& name) {
  if (name.empty()) return kAll;
  const auto found = std::find(groups.begin(), groups.end(), name);
  if (found != groups.end()) return static_cast<int>(found - groups.begin());
  const std::string near = nearest(name, groups);
  throw InputError(fmt::format("events.lights: the world has no group of lights \"{}\"{}", name,
                               near.empty() ? "" : fmt::format(" (did you mean {}?)", near)));
}

}  // namespace

LightSwitches::LightSwitches(const std::vector<std::string>& groups, const std::vector<LightEvent>& events)
    : groups_(groups.size()), events_(events) {
  std::stable_sort(events_.begin(), events_.end(),
                   [](const LightEvent& a, const LightEvent& b) { return a.at_s < b.at_s; });
  for (const LightEvent& event : events_) group_of_event_.push_back(find_group(groups, event.group));
}

LightLevels LightSwitches::levels(Time stamp) const {
  LightLevels levels{std::vector<float>(groups_, 1.0f)};
  for (size_t i = 0; i < events_.size() && events_[i].at_s <= stamp.seconds(); ++i) {
    const auto level = static_cast<float>(events_[i].level);
    if (group_of_event_[i] == kAll)
      levels.of_group.assign(groups_, level);
    else
      levels.of_group[static_cast<size_t>(group_of_event_[i])] = level;
  }
  return levels;
}

}  // namespace vsslam

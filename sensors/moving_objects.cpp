#include "sensors/moving_objects.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/errors.h"

namespace vsslam {

namespace {

int find_object(const World& world, const std::string& name) {
  std::vector<std::string> names;
  for (size_t i = 0; i < world.objects.size(); ++i) {
    if (world.objects[i].name == name) return static_cast<int>(i);
    names.push_back(world.objects[i].name);
  }
  const std::string near = nearest(name, names);
  throw InputError(fmt::format("events: world \"{}\" has no object \"{}\"{}", world.name, name,
                               near.empty() ? "" : fmt::format(" (did you mean {}?)", near)));
}

}  // namespace

MovingObjects::MovingObjects(const World& world, const std::vector<ObjectEvent>& events) : world_(world) {
  for (const ObjectEvent& event : events) events_[find_object(world, event.object)].push_back(event);
  for (auto& [index, list] : events_) {
    indices_.push_back(index);
    std::stable_sort(list.begin(), list.end(),
                     [](const ObjectEvent& a, const ObjectEvent& b) { return a.at_s < b.at_s; });
  }
}

ObjectState MovingObjects::state(int object, Time stamp) const {
  ObjectState state;
  state.T_world_object = world_.objects[static_cast<size_t>(object)].T_world_object;
  const auto found = events_.find(object);
  if (found == events_.end()) return state;
  state.present = found->second.front().action != ObjectEvent::Action::appear;
  for (const ObjectEvent& event : found->second) {
    const double elapsed_s = stamp.seconds() - event.at_s;
    if (elapsed_s < 0) break;
    if (event.action != ObjectEvent::Action::slide) {
      state.present = event.action == ObjectEvent::Action::appear;
      continue;
    }
    const double share = event.duration_s > 0 ? std::min(1.0, elapsed_s / event.duration_s) : 1.0;
    state.T_world_object.translation() += share * event.by_m;
  }
  return state;
}

std::vector<std::pair<int, ObjectState>> MovingObjects::changes(Time stamp,
                                                                std::vector<ObjectState>& placed) const {
  std::vector<std::pair<int, ObjectState>> changed;
  for (size_t i = 0; i < indices_.size(); ++i) {
    const ObjectState now = state(indices_[i], stamp);
    if (i < placed.size() && now == placed[i]) continue;
    placed.resize(std::max(placed.size(), i + 1));
    placed[i] = now;
    changed.emplace_back(indices_[i], now);
  }
  return changed;
}

}  // namespace vsslam

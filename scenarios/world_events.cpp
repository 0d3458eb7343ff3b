#include "scenarios/world_events.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "core/errors.h"

namespace vsslam {

void ObjectEvent::fields(Fields& f) {
  f("t_s", t_s, non_negative());
  f("object", object);
  f.choice("action", action, {{"appear", Action::appear}, {"disappear", Action::disappear}, {"move", Action::move}});
  f("offset_m", offset_m);
  f("yaw_deg", yaw_deg);
  f.check(!object.empty(), "object", "the name of an object of the world");
}

void WheelSlipEvent::fields(Fields& f) {
  f("t_s", t_s, non_negative());
  f("duration_s", duration_s, positive());
  f("left_friction", left_friction, between(0, 10));
  f("right_friction", right_friction, between(0, 10));
}

void LightEvent::fields(Fields& f) {
  f("t_s", t_s, non_negative());
  f("group", group);
  f("level", level, non_negative());
}

void EventsConfig::fields(Fields& f) {
  f("sensors", sensors);
  f("wheel_slip", wheel_slip);
  f("objects", objects);
  f("lights", lights);
}

namespace {

int find_object(const World& world, const std::string& name) {
  for (size_t i = 0; i < world.objects.size(); ++i)
    if (world.objects[i].name == name) return static_cast<int>(i);
  std::vector<std::string> names;
  for (const Object& object : world.objects) names.push_back(object.name);
  const std::string near = nearest(name, names);
  throw InputError(fmt::format("events.objects: the world \"{}\" has no object \"{}\"{}", world.name, name,
                               near.empty() ? "" : fmt::format(" (did you mean {}?)", near)));
}

Eigen::Affine3d moved(const Eigen::Affine3d& T_world_object, const ObjectEvent& event) {
  constexpr double kRadPerDeg = 0.017453292519943295;
  const Vec3 v_world_object = T_world_object.translation();
  Eigen::Affine3d turned = Eigen::AngleAxisd(event.yaw_deg * kRadPerDeg, Vec3::UnitZ()) *
                           Eigen::Affine3d(T_world_object.linear());
  turned.translation() = v_world_object + event.offset_m;
  return turned;
}

}  // namespace

ObjectTimeline::ObjectTimeline(const World& world, const std::vector<ObjectEvent>& events) {
  std::vector<ObjectEvent> sorted = events;
  std::stable_sort(sorted.begin(), sorted.end(), [](const auto& a, const auto& b) { return a.t_s < b.t_s; });
  std::set<int> seen;
  for (const ObjectEvent& event : sorted) {
    const int object = find_object(world, event.object);
    const Eigen::Affine3d& T_world_object = world.objects[static_cast<size_t>(object)].T_world_object;
    if (seen.insert(object).second && event.action == ObjectEvent::Action::appear)
      initial_.push_back({object, T_world_object, false});
    changes_.push_back({Time::from_seconds(event.t_s),
                        {object, moved(T_world_object, event), event.action != ObjectEvent::Action::disappear}});
  }
}

std::optional<Time> ObjectTimeline::next() const {
  if (taken_ == changes_.size()) return std::nullopt;
  return changes_[taken_].stamp;
}

std::vector<ObjectState> ObjectTimeline::take(Time now) {
  std::vector<ObjectState> due;
  while (taken_ < changes_.size() && changes_[taken_].stamp <= now) due.push_back(changes_[taken_++].state);
  return due;
}

}  // namespace vsslam

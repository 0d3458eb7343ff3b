#include "sensors/rig_camera.h"

#include <algorithm>
#include <utility>

namespace vsslam {

RigCamera::RigCamera(const World& world, const Raycaster& raycaster, const MovingObjects& objects,
                     const CameraConfig& config, const SE3& T_base_camera, const LightingConfig& lighting,
                     const SensorEvents& events, uint64_t seed)
    : objects_(objects),
      T_base_camera_(T_base_camera),
      renderer_(world, raycaster, lighting),
      lights_(renderer_.light_groups(), events.lights),
      camera_(config, events, seed) {}

bool RigCamera::same_world(Time a, Time b) const {
  return lights_.levels(a).of_group == lights_.levels(b).of_group &&
         std::all_of(objects_.objects().begin(), objects_.objects().end(),
                     [&](int object) { return objects_.state(object, a) == objects_.state(object, b); });
}

void RigCamera::take(Time until, const Trajectory& trajectory,
                     const std::function<void(Time)>& place_objects) {
  int count = 1;
  while (count < camera_.known() && camera_.end(count) <= until &&
         same_world(camera_.stamp(), camera_.stamp(count)))
    ++count;
  place_objects(camera_.stamp());
  renderer_.set_light_levels(lights_.levels(camera_.stamp()));
  for (int k = 0; k < count; ++k) waiting_.push_back({camera_.end(k), std::nullopt});
  auto waiting = waiting_.begin();
  for (CameraMeasurement& image : camera_.take(
           count, trajectory, T_base_camera_,
           [this](const SE3&pose, const ViewRays&rays, View&view) { renderer_.render(pose, rays, view); })) {
    while (waiting->end < image.end) ++waiting;
    waiting->image = std::move(image);
  }
}

std::optional<CameraMeasurement> RigCamera::measure(Time until, const Trajectory& trajectory,
                                                    const std::function<void(Time)>& place_objects) {
  if (waiting_.empty()) take(until, trajectory, place_objects);
  std::optional<CameraMeasurement> image = std::move(waiting_.front().image);
  waiting_.pop_front();
  return image;
}

}  // namespace vsslam

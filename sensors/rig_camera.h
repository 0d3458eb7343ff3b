// The camera's place in the rig: its renderer, the lights and objects that it sees, and images that were taken together
// waiting for their turn.
#pragma once

#include <deque>
#include <optional>
#include <utility>

#include "sensors/camera/camera.h"
#include "sensors/light_switches.h"
#include "sensors/moving_objects.h"
#include "sensors/render/renderer.h"

namespace vsslam {

class RigCamera {
 public:
  /// Bakes the light maps. World, raycaster and objects must outlive it.
  RigCamera(const World& world, const Raycaster& raycaster, const MovingObjects& objects,
            const CameraConfig& config, const SE3& T_base_camera, const LightingConfig& lighting,
            const SensorEvents& events, uint64_t seed);

  void power_on(Time first) { camera_.power_on(first); }
  void leave_out(std::function<std::optional<double>(Time)> taken) { camera_.leave_out(std::move(taken)); }
  /// End of exposure of the next image (or of one that a dropout swallows).
  Time next_end() const { return waiting_.empty() ? camera_.end() : waiting_.front().end; }
  Time needed_from() const { return camera_.needed_from(); }
  /// The image that ends at next_end(), unless a dropout swallows it. The trajectory must reach `until`: images that
  /// end by then and see the world in the same state are taken side by side. `place_objects` puts the raycaster's
  /// objects where they are at a time.
  std::optional<CameraMeasurement> measure(Time until, const Trajectory& trajectory,
                                           const std::function<void(Time)>& place_objects);

 private:
  /// An image, or none in a dropout.
  struct Waiting {
    Time end;
    std::optional<CameraMeasurement> image;
  };
  bool same_world(Time a, Time b) const;
  void take(Time until, const Trajectory& trajectory, const std::function<void(Time)>& place_objects);

  const MovingObjects& objects_;
  SE3 T_base_camera_;
  Renderer renderer_;
  LightSwitches lights_;
  Camera camera_;
  std::deque<Waiting> waiting_;
};

}  // namespace vsslam

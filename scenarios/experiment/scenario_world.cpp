#include "scenarios/experiment/scenario_world.h"

namespace vsslam {

const World& ScenarioWorld::world() {
  std::call_once(world_once_, [this] { world_ = make_world(scenario_.world); });
  return *world_;
}

const SurfaceDistance& ScenarioWorld::surface() {
  std::call_once(surface_once_, [this] { surface_ = std::make_unique<SurfaceDistance>(world()); });
  return *surface_;
}

}  // namespace vsslam

// A scenario and the world that it takes place in.
#pragma once

#include <memory>
#include <mutex>
#include <optional>

#include "scenarios/experiment/scenario.h"
#include "scenarios/oracles/map_error.h"

namespace vsslam {

/// Makes the world when it is first asked for, so that an experiment of many scenarios holds only those it is
/// busy with. Thread-safe.
class ScenarioWorld {
 public:
  explicit ScenarioWorld(Scenario scenario) : scenario_(std::move(scenario)) {}

  const Scenario& scenario() const { return scenario_; }
  /// Throws InputError if the world is not possible.
  const World& world();
  const SurfaceDistance& surface();

 private:
  Scenario scenario_;
  std::once_flag world_once_, surface_once_;
  std::optional<World> world_;
  std::unique_ptr<SurfaceDistance> surface_;
};

}  // namespace vsslam

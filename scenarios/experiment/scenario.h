// An experiment: one YAML file = one struct with defaults. What it resolves to is saved beside every result
// and is itself a scenario that gives the same run.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/config.h"
#include "scenarios/experiment/expectations.h"
#include "scenarios/experiment/handed.h"
#include "scenarios/experiment/world_events.h"
#include "sensors/rig.h"
#include "sim/drive_script.h"
#include "sim/scout.h"
#include "slam/slam_config.h"
#include "worlds/factory/world_source.h"
#include "worlds/lighting.h"

namespace vsslam {

struct Scenario {
  std::string name;         ///< names the result folder; default: the file's name without .yaml
  std::string description;  ///< one line, for `list`
  WorldSource world;
  LightingConfig lighting;
  ScoutConfig robot;
  RigConfig rig;
  DriveScript drive;
  EventsConfig events;
  HandedConfig handed;
  std::vector<std::string> methods{"vs-slam"};  ///< names, or "all"
  SlamConfig slam;
  std::vector<uint64_t> seeds{1};      ///< of the sensors' noise
  bool closed_loop = false;            ///< the robot drives on the estimate instead of the truth
  double closed_loop_latency_s = 0.2;  ///< from the end of a scan until its pose steers the robot
  double max_duration_s = 3600;        ///< simulated; the run ends there whatever the drive does
  double map_voxel_m = 0.1;            ///< of map.ply
  Expectations expect;

  void fields(Fields& f);
};

/// A name from the library or a path, with overrides. Throws InputError.
Scenario load_scenario(const std::string& name_or_path, const std::vector<Override>& overrides = {});

/// The methods that `names` stand for, in order and without repeats. Throws InputError.
std::vector<Method> resolve_methods(const std::vector<std::string>& names);

}  // namespace vsslam

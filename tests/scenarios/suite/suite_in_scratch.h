// A suite in the scratch folder with results that tests write by hand.
#pragma once

#include <fmt/format.h>

#include <filesystem>
#include <string>

#include "core/files.h"
#include "scenarios/experiment/fingerprint.h"
#include "scenarios/results/metrics.h"
#include "scenarios/suite/suite_plan.h"
#include "tests/scratch.h"

namespace vsslam {

inline std::filesystem::path fresh_folder(const std::string& name) {
  const std::filesystem::path folder = scratch_folder() / name;
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder);
  return folder;
}

inline std::string written(const std::filesystem::path& path, const std::string& text) {
  write_file(path, text);
  return path.string();
}

/// A room for some seconds: what the smallest whole run takes.
inline std::string tiny_scenario(const std::filesystem::path& folder, const std::string& name) {
  return written(folder / (name + ".yaml"),
                 "base: quick_room\nmax_duration_s: 2\nmap_voxel_m: 0.2\nworld: {room: {textures: false}}\n"
                 "drive: {steps: [{follow: {route: loop, speed_mps: 0.8}}]}\n");
}

inline std::string tiny_suite(const std::filesystem::path& folder, const std::string& more = "") {
  tiny_scenario(folder, "a");
  tiny_scenario(folder, "b");
  return written(folder / "tiny.yaml",
                 "scenarios: [a.yaml, b.yaml]\nmethods: [lvi-sam-no-loop, vs-slam]\nseeds: [1, 2]\n" + more);
}

/// Puts a result there as if the run had been made.
inline void fake_result(const SuitePlan& plan, const PlannedRun& run, const Metrics& metrics) {
  std::filesystem::create_directories(run.folder);
  write_file(run.folder / "scenario.yaml", plan.resolved(run));
  write_file(run.folder / "metrics.json", metrics.json());
  write_file(run.folder / "timing.json",
             fmt::format("{{\"made_by\": \"{}\", \"real_time_factor\": 5, \"wall_s\": 2, \"stages\": "
                         "{{\"slam_scan\": {{\"median_ms\": 2, \"p99_ms\": 9}}}}}}",
                         fingerprint(plan.scenarios[run.scenario])));
}

}  // namespace vsslam

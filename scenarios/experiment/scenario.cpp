#include "scenarios/experiment/scenario.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/errors.h"
#include "scenarios/experiment/library_files.h"

namespace vsslam {

void Scenario::fields(Fields& f) {
  f.base("scenarios", *this);
  f("name", name);
  f("description", description);
  f("world", world);
  f("lighting", lighting);
  f("robot", robot);
  f("rig", rig);
  f("drive", drive);
  f("events", events);
  f("handed", handed);
  f("methods", methods);
  f("slam", slam);
  f("seeds", seeds);
  f("closed_loop", closed_loop);
  f("closed_loop_latency_s", closed_loop_latency_s, between(0, 10));
  f("max_duration_s", max_duration_s, positive());
  f("map_voxel_m", map_voxel_m, positive());
  expectation_fields(f, expect);
  f.check(!methods.empty(), "methods", "at least one method");
  f.check(!seeds.empty(), "seeds", "at least one seed");
  f.check(name.find('/') == std::string::npos && !name.starts_with('.'), "name",
          "a name that can be a folder's");
}

Scenario load_scenario(const std::string& name_or_path, const std::vector<Override>& overrides) {
  const std::filesystem::path path = find_file("scenarios", name_or_path);
  Scenario scenario;
  load_config(path, scenario, library(), overrides);
  if (scenario.name.empty()) scenario.name = path.stem().string();
  resolve_methods(scenario.methods);
  return scenario;
}

std::vector<Method> resolve_methods(const std::vector<std::string>& names) {
  std::vector<Method> methods;
  const auto add = [&](Method method) {
    if (std::find(methods.begin(), methods.end(), method) == methods.end()) methods.push_back(method);
  };
  for (const std::string& name : names) {
    if (name == "all") {
      for (const Method method : all_methods()) add(method);
    } else {
      add(parse_method(name));
    }
  }
  return methods;
}

}  // namespace vsslam

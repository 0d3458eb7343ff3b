#include "scenarios/datasets/systems/target_system.h"

#include <fmt/format.h>

#include <array>
#include <utility>

#include "core/errors.h"
#include "core/suggestion.h"
#include "scenarios/datasets/systems/target_configurations.h"

namespace vsslam {

namespace {

constexpr std::array<std::pair<DatasetFormat, std::string_view>, 7> kFormats = {
    {{DatasetFormat::bag, "bag"},
     {DatasetFormat::mcap, "mcap"},
     {DatasetFormat::euroc, "euroc"},
     {DatasetFormat::kitti, "kitti"},
     {DatasetFormat::pcd, "pcd"},
     {DatasetFormat::ply, "ply"},
     {DatasetFormat::tum, "tum"}}};

[[noreturn]] void fail(const char* what, std::string_view name, const std::vector<std::string>& names) {
  throw InputError(fmt::format("unknown {} \"{}\" ({})", what, name, suggestion(name, names)));
}

}  // namespace

std::string_view format_name(DatasetFormat format) {
  return kFormats[static_cast<size_t>(format)].second;
}

DatasetFormat parse_format(std::string_view name) {
  std::vector<std::string> names;
  for (const auto& [format, known] : kFormats) {
    if (known == name) return format;
    names.emplace_back(known);
  }
  fail("format", name, names);
}

const std::vector<TargetSystem>& target_systems() {
  static const std::vector<TargetSystem> systems = make_target_systems();
  return systems;
}

const TargetSystem& target_system(std::string_view name) {
  std::vector<std::string> names;
  for (const TargetSystem& system : target_systems()) {
    if (system.name == name) return system;
    names.push_back(system.name);
  }
  fail("system", name, names);
}

}  // namespace vsslam

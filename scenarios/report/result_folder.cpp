#include "scenarios/report/result_folder.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "core/errors.h"
#include "core/files.h"
#include "scenarios/report/ply_points.h"
#include "scenarios/results_columns.h"

namespace vsslam {

namespace fs = std::filesystem;

namespace {

std::shared_ptr<const nlohmann::json> read_object(const fs::path& path) {
  try {
    auto json = std::make_shared<nlohmann::json>(nlohmann::json::parse(read_file(path, size_t{64} << 20)));
    if (!json->is_object()) throw InputError(fmt::format("{}: expected a JSON object", path.string()));
    return json;
  } catch (const nlohmann::json::exception& error) {
    throw InputError(fmt::format("{}: {}", path.string(), error.what()));
  }
}

std::string member_text(const ResultFolder& folder, const char* key) {
  const auto member = folder.metrics->find(key);
  if (member == folder.metrics->end() || !(member->is_string() || member->is_number_integer()))
    throw InputError(
        fmt::format("{}: \"{}\": expected a name or a number", (folder.path / "metrics.json").string(), key));
  return member->is_string() ? member->get<std::string>() : member->dump();
}

/// Columns without which the page cannot show the table; later ones may be missing.
std::optional<CsvTable> read_table(const fs::path& path, std::span<const char* const> columns) {
  if (!fs::exists(path)) return std::nullopt;
  CsvTable table = CsvTable::read(path);
  table.require(columns);
  return table;
}

}  // namespace

ResultFolder read_result_folder(const fs::path& path) {
  if (!fs::is_directory(path)) throw InputError(fmt::format("{}: no such result folder", path.string()));
  ResultFolder folder;
  folder.path = path;
  folder.metrics = read_object(path / "metrics.json");
  folder.scenario = member_text(folder, "scenario");
  folder.method = member_text(folder, "method");
  folder.seed = member_text(folder, "seed");
  if (fs::exists(path / "timing.json")) folder.timing = read_object(path / "timing.json");
  folder.truth = read_tum(path / "truth.tum");
  folder.estimate = read_tum(path / "estimate.tum");
  if (fs::exists(path / "odometry.tum")) folder.odometry = read_tum(path / "odometry.tum");
  folder.scans = read_table(path / "scans.csv", kScanColumns);
  folder.loops = read_table(path / "loops.csv", kLoopColumns);
  folder.descriptors = read_table(path / "descriptors.csv", kDescriptorColumns);
  if (fs::exists(path / "map.ply")) folder.points_map = read_ply_points(path / "map.ply");
  return folder;
}

}  // namespace vsslam

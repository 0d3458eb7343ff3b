#include "scenarios/report/stored_result.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "core/errors.h"
#include "core/files.h"
#include "scenarios/report/ply_points.h"
#include "scenarios/results/results_columns.h"

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

std::string member_text(const StoredResult& result, const char* key) {
  const auto member = result.metrics->find(key);
  if (member == result.metrics->end() || !(member->is_string() || member->is_number_integer()))
    throw InputError(
        fmt::format("{}: \"{}\": expected a name or a number", (result.path / "metrics.json").string(), key));
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

StoredResult read_stored_result(const fs::path& path) {
  if (!fs::is_directory(path)) throw InputError(fmt::format("{}: no such result folder", path.string()));
  StoredResult result;
  result.path = path;
  result.metrics = read_object(path / "metrics.json");
  result.scenario = member_text(result, "scenario");
  result.method = member_text(result, "method");
  if (result.metrics->contains("seed")) result.seed = member_text(result, "seed");
  if (fs::exists(path / "timing.json")) result.timing = read_object(path / "timing.json");
  // Only a recording may lack it: a simulated run knows its seed and its truth.
  if (!result.seed.empty() || fs::exists(path / "truth.tum")) result.truth = read_tum(path / "truth.tum");
  result.estimate = read_tum(path / "estimate.tum");
  if (fs::exists(path / "odometry.tum")) result.odometry = read_tum(path / "odometry.tum");
  result.scans = read_table(path / "scans.csv", kScanColumns);
  result.loops = read_table(path / "loops.csv", kLoopColumns);
  result.descriptors = read_table(path / "descriptors.csv", kDescriptorColumns);
  if (fs::exists(path / "camera.png")) result.camera_png = read_file(path / "camera.png");
  if (fs::exists(path / "map.ply")) result.points_map = read_ply_points(path / "map.ply");
  return result;
}

}  // namespace vsslam

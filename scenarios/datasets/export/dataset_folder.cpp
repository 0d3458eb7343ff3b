#include "scenarios/datasets/export/dataset_folder.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "core/errors.h"
#include "core/files.h"

namespace vsslam {

namespace fs = std::filesystem;

namespace {

// The settings of the export; the first while it lasts, the second once it is whole.
constexpr const char* kBegun = ".export-begun";
constexpr const char* kComplete = ".export-complete";

void clear_away(const fs::path& path) {
  std::error_code error;
  fs::remove_all(path, error);
  if (error) throw ResourceError(fmt::format("{}: cannot remove: {}", path.string(), error.message()));
}

// Whether the name ends in ".part" and a number.
bool is_part(const fs::path& path) {
  const std::string end = path.extension().string();
  constexpr std::string_view kPart = ".part";
  return end.size() > kPart.size() && end.starts_with(kPart) &&
         std::all_of(end.begin() + kPart.size(), end.end(), [](char c) { return c >= '0' && c <= '9'; });
}

// Files that a killed export was busy with.
void remove_parts(const fs::path& folder) {
  std::vector<fs::path> parts;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (is_part(entry.path())) parts.push_back(entry.path());
  for (const fs::path& path : parts) clear_away(path);
}

}  // namespace

DatasetFolder::DatasetFolder(fs::path folder, std::string key, ExportRequest::IfExists if_exists)
    : folder_(std::move(folder)), key_(std::move(key)) {
  using IfExists = ExportRequest::IfExists;
  const std::string name = folder_.string();
  std::error_code error;
  if (fs::exists(folder_, error) && !fs::is_directory(folder_, error))
    throw InputError(fmt::format("{}: is a file, expected a folder", name));
  if (!fs::exists(folder_, error) || fs::is_empty(folder_, error)) {
    begin();
    return;
  }
  const bool begun = fs::exists(folder_ / kBegun), complete = fs::exists(folder_ / kComplete);
  if (!begun && !complete)
    throw InputError(fmt::format("{}: has something else than a dataset of this program in it", name));
  if (if_exists == IfExists::overwrite) {
    clear_away(folder_);
    begin();
    return;
  }
  if (if_exists == IfExists::fail)
    throw InputError(
        begun ? fmt::format("{}: an unfinished export (--resume goes on, --overwrite begins anew)", name)
              : fmt::format("{}: exists already (--overwrite makes it anew)", name));
  if (read_file(folder_ / (begun ? kBegun : kComplete)) != key_)
    throw InputError(
        fmt::format("{}: begun with other settings or by another build (--overwrite makes it anew)", name));
  complete_ = complete;
  if (begun) remove_parts(folder_);
}

void DatasetFolder::begin() const {
  write_file(folder_ / kBegun, key_);
}

void DatasetFolder::mark_complete() const {
  std::error_code error;
  fs::rename(folder_ / kBegun, folder_ / kComplete, error);
  if (error)
    throw ResourceError(fmt::format("{}: cannot rename: {}", (folder_ / kBegun).string(), error.message()));
}

}  // namespace vsslam

#include "scenarios/experiment/library_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>

#include "core/errors.h"
#include "core/suggestion.h"

namespace vsslam {

namespace fs = std::filesystem;

namespace {

fs::path library_folder(std::string_view kind) {
  if (kind == "suites") return home_folder() / "scenarios" / "suites";
  if (kind == "sheets") return home_folder() / "scenarios" / "datasets" / "library";
  if (kind == "sheets") return home_folder() / "scenarios" / "datasets" / "library";
  const std::string room = kind == "rigs" ? "sensors" : std::string(kind);
  return home_folder() / room / "library";
}

std::string singular(std::string_view kind) {
  return std::string(kind.substr(0, kind.size() - 1));
}

}  // namespace

fs::path home_folder() {
  const char* home = std::getenv("VSSLAM_HOME");
  return home != nullptr && *home != '\0' ? fs::path(home) : fs::path(VSSLAM_HOME_FOLDER);
}

std::vector<std::string> library_names(std::string_view kind) {
  std::vector<std::string> names;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(library_folder(kind), error))
    if (entry.path().extension() == ".yaml") names.push_back(entry.path().stem().string());
  std::sort(names.begin(), names.end());
  return names;
}

fs::path library_file(std::string_view kind, std::string_view name) {
  const std::vector<std::string> names = library_names(kind);
  if (std::binary_search(names.begin(), names.end(), name))
    return library_folder(kind) / fmt::format("{}.yaml", name);
  if (names.empty())
    throw InputError(
        fmt::format("no {} \"{}\": {} is empty", singular(kind), name, library_folder(kind).string()));
  throw InputError(fmt::format("no {} \"{}\" ({})", singular(kind), name, suggestion(name, names)));
}

fs::path find_file(std::string_view kind, const std::string& name_or_path) {
  const fs::path path = name_or_path;
  const bool is_path = path.has_extension() || name_or_path.find('/') != std::string::npos;
  if (!is_path) return library_file(kind, name_or_path);
  std::error_code error;
  if (!fs::exists(path, error)) throw InputError(fmt::format("{}: no such file", name_or_path));
  return path;
}

Library library() {
  return [](std::string_view kind, std::string_view name) { return library_file(kind, name); };
}

}  // namespace vsslam

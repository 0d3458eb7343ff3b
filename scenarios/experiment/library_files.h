// The library that comes with the program: scenarios, suites, worlds, rigs and sheets of real robots that are known
// by name.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "core/config.h"

namespace vsslam {

/// Folder that holds the rooms: the environment variable VSSLAM_HOME, else the folder the program was built from.
std::filesystem::path home_folder();

/// Names (without .yaml) in the library of a kind, sorted. Kinds: "scenarios", "suites", "worlds", "rigs",
/// "sheets".
std::vector<std::string> library_names(std::string_view kind);

/// File of a library name. Throws InputError with the nearest name.
std::filesystem::path library_file(std::string_view kind, std::string_view name);

/// A library name, or a path (anything with a slash or an extension). Throws InputError.
std::filesystem::path find_file(std::string_view kind, const std::string& name_or_path);

/// For load_config.
Library library();

}  // namespace vsslam

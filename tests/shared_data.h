// Inputs that are kept beside the sources, not with them: in $VSSLAM_SHARED, or in ../shared.
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <string>

namespace vsslam {

inline std::filesystem::path shared_folder() {
  const char* asked = std::getenv("VSSLAM_SHARED");
  return asked != nullptr ? asked : VSSLAM_SHARED_FOLDER;
}

/// A folder of cases/. If it is not there although cases/ is, the test fails.
inline std::filesystem::path shared_case(const std::string& name) {
  const std::filesystem::path folder = shared_folder() / "cases" / name;
  EXPECT_TRUE(std::filesystem::is_directory(folder)) << folder;
  return folder;
}

}  // namespace vsslam

/// For the head of a test.
#define VSSLAM_NEEDS_SHARED_CASES()                                      \
  if (!std::filesystem::is_directory(vsslam::shared_folder() / "cases")) \
  GTEST_SKIP() << "no folder " << vsslam::shared_folder() / "cases"      \
               << " (VSSLAM_SHARED names another)"

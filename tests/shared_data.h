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

/// Raw packets of a real VLP-16 at rest in a room: of $VSSLAM_VLP16_PACKETS, or of data/. Empty: there are none.
inline std::filesystem::path shared_packets() {
  if (const char* asked = std::getenv("VSSLAM_VLP16_PACKETS")) return asked;
  const std::filesystem::path file = shared_folder() / "data" / "vlp16_room_packets.bin";
  const bool expected = std::filesystem::is_directory(file.parent_path());
  EXPECT_EQ(std::filesystem::exists(file), expected) << file;
  return expected ? file : std::filesystem::path();
}

}  // namespace vsslam

/// For the head of a test.
#define VSSLAM_NEEDS_SHARED_CASES()                                      \
  if (!std::filesystem::is_directory(vsslam::shared_folder() / "cases")) \
  GTEST_SKIP() << "no folder " << vsslam::shared_folder() / "cases"      \
               << " (VSSLAM_SHARED names another)"

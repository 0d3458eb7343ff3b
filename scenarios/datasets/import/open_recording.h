// Opens a recording of any format.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>

#include "scenarios/datasets/facts/rig_sheet.h"
#include "scenarios/datasets/import/recording.h"

namespace vsslam {

struct RecordingOptions {
  std::map<std::string, std::string> topics{};  ///< by sensor, or "truth"; "none": not used
  bool images = true;                           ///< false: a camera is passed over
  bool salvage = false;
  bool undistorted = false;  ///< see CloudDecoder
};

/// By content: a bag, an MCAP file, a network capture, a file of packets, a folder as folder_recording.h has them, or a
/// dataset's folder with one of these in it (a bag or an MCAP file first). Throws InputError.
std::unique_ptr<Recording> open_recording(const std::filesystem::path& path, const RigSheet& sheet,
                                          const RecordingOptions& options);

}  // namespace vsslam

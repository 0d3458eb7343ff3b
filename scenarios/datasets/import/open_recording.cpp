#include "scenarios/datasets/import/open_recording.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "core/errors.h"
#include "scenarios/datasets/import/folder_recording.h"
#include "scenarios/datasets/import/message_recording.h"
#include "scenarios/datasets/import/packet_recording.h"

namespace vsslam {

namespace fs = std::filesystem;

namespace {

// Of chunks that overlap in time there are a few, of about 1 MB.
constexpr size_t kChunkMemoryBytes = size_t{64} << 20;

MessageSurvey survey_of(const fs::path& path, const ReadOptions& read, const TopicChoice& choice,
                        const CloudDecoder::Options& clouds, const std::string& file) {
  ReadOptions first = read, headers = read;
  std::erase_if(first.topics, [&](const std::string& topic) {
    return topic != choice.at("lidar") && (!choice.contains("camera") || topic != choice.at("camera"));
  });
  headers.headers_only = true;
  MessageSurvey survey;
  survey.look = look_at_first(*read_messages(path, first), clouds);
  survey.clocks =
      plan_clocks(received_streams(*read_messages(path, headers), choice, survey.look.scan_lasts), file);
  return survey;
}

std::unique_ptr<Recording> open_messages(const fs::path& path, const RigSheet& sheet,
                                         const RecordingOptions& options,
                                         const CloudDecoder::Options& clouds) {
  const std::string file = path.filename().string();
  std::vector<std::string> notes;
  const std::vector<RecordedTopic> topics =
      read_messages(path, {.topics = {}, .salvage = options.salvage})->topics();
  if (std::all_of(topics.begin(), topics.end(), [](const RecordedTopic& t) { return t.messages == 0; }))
    throw InputError(fmt::format("{}: no messages", path.string()));
  std::map<std::string, std::string> asked = options.topics;
  if (!options.images) asked.emplace("camera", "none");
  const TopicChoice choice = choose_topics(topics, sheet.topics, asked, file, notes);
  ReadOptions read{.topics = {}, .salvage = options.salvage};
  read.chunk_memory_bytes = kChunkMemoryBytes;
  for (const auto& [sensor, topic] : choice) read.topics.push_back(topic);
  return std::make_unique<MessageRecording>(read_messages(path, read), file, choice, sheet.calibration,
                                            clouds, notes, topics,
                                            survey_of(path, read, choice, clouds, file));
}

// Of a dataset's folder, what is in it to be read.
fs::path recording_in(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder))
    if (entry.is_regular_file()) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  for (const char* ending : {".bag", ".mcap", ".pcap", ".pcapng"})
    for (const fs::path& file : files)
      if (file.extension() == ending) return file;
  if (is_folder_recording(folder)) return folder;
  throw InputError(
      fmt::format("{}: no recording: expected a .bag, .mcap or .pcap file, velodyne/, pcd/times.csv or mav0/",
                  folder.string()));
}

double packets_s(const fs::path& path) {
  constexpr double kPacketsPerSecond = 754;  // of a VLP-16
  return static_cast<double>(fs::file_size(path)) / (VelodynePacket::kBytes * kPacketsPerSecond);
}

}  // namespace

std::unique_ptr<Recording> open_recording(const fs::path& given, const RigSheet& sheet,
                                          const RecordingOptions& options) {
  if (!fs::exists(given)) throw InputError(fmt::format("{}: no such file or folder", given.string()));
  const CloudDecoder::Options clouds{sheet.calibration.lidar.rings, options.undistorted};
  const fs::path path = fs::is_directory(given) ? recording_in(given) : given;
  const std::string file = path.filename().string();
  const int rings = sheet.calibration.lidar.rings;
  if (fs::is_directory(path))
    return std::make_unique<FolderRecording>(path, sheet.calibration, clouds, options.images);
  if (is_pcap_file(path))
    return std::make_unique<PacketRecording>(read_pcap_file(path, options.salvage), file, rings,
                                             packets_s(path));
  if (is_packet_file(path))
    return std::make_unique<PacketRecording>(read_packet_file(path, options.salvage), file, rings,
                                             packets_s(path));
  return open_messages(path, sheet, options, clouds);
}

}  // namespace vsslam

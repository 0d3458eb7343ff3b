#include "scenarios/datasets/import/folder_recording.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <sstream>

#include "core/errors.h"
#include "core/files.h"
#include "scenarios/datasets/formats/cloud_reader.h"
#include "scenarios/datasets/import/clock_agreement.h"
#include "scenarios/datasets/import/message_survey.h"
#include "scenarios/evaluation/csv.h"

namespace vsslam {

namespace fs = std::filesystem;

namespace {

enum : size_t { kImu = 0, kLidar = 2, kCamera = 3 };  // indices of Sample

// Rows of a table whose header begins with '#' and is not needed; trailing carriage returns are dropped.
std::vector<std::vector<std::string>> rows_of(const fs::path& path, size_t columns) {
  std::istringstream text(read_file(path));
  std::vector<std::vector<std::string>> rows;
  std::string line, field;
  for (int number = 1; std::getline(text, line); ++number) {
    if (!line.empty() && line.back() == '\r') line.pop_back();
    if (line.empty() || line[0] == '#' || line.starts_with("file,")) continue;
    std::vector<std::string> row;
    std::istringstream fields(line);
    while (std::getline(fields, field, ',')) row.push_back(field);
    if (row.size() < columns)
      throw InputError(
          fmt::format("{}:{}: expected {} columns, got {}", path.string(), number, columns, row.size()));
    rows.push_back(std::move(row));
  }
  return rows;
}

Time nanoseconds(const std::string& text, const fs::path& path) {
  int64_t ns = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), ns);
  if (error != std::errc{} || end != text.data() + text.size())
    throw InputError(fmt::format("{}: expected a stamp in ns, got {}", path.string(), text));
  return Time{ns};
}

Vec3 three(const std::vector<std::string>& row, size_t first, const fs::path& path) {
  Vec3 v;
  for (size_t i = 0; i < 3; ++i) {
    const auto value = parse_number(row[first + i]);
    if (!value) throw InputError(fmt::format("{}: expected a number, got {}", path.string(), row[first + i]));
    v[static_cast<Eigen::Index>(i)] = *value;
  }
  return v;
}

std::vector<Time> times_of(const fs::path& path) {
  std::istringstream text(read_file(path));
  std::vector<Time> times;
  for (std::string word; text >> word;) {
    const auto time = parse_seconds(word);
    if (!time) throw InputError(fmt::format("{}: expected seconds, got {}", path.string(), word));
    times.push_back(*time);
  }
  return times;
}

}  // namespace

bool is_folder_recording(const fs::path& folder) {
  return fs::is_directory(folder / "velodyne") || fs::exists(folder / "pcd" / "times.csv") ||
         fs::is_directory(folder / "mav0");
}

FolderRecording::FolderRecording(fs::path folder, const RigCalibration& rig,
                                 const CloudDecoder::Options& clouds, bool images)
    : folder_(std::move(folder)), rig_(rig), options_(clouds), clouds_(clouds) {
  facts_.format = "folder";
  add_scans();
  add_imu();
  if (images) add_images();
  std::stable_sort(entries_.begin(), entries_.end(),
                   [](const Entry& a, const Entry& b) { return a.stamp < b.stamp; });
  if (!entries_.empty())
    facts_.expected_duration_s = seconds_between(entries_.front().stamp, entries_.back().stamp);
  check_clocks();
  look_at_first_scan();
}

// When its files were written says nothing of them: clocks can only be found to have nothing in common.
void FolderRecording::check_clocks() const {
  std::vector<ReceivedStream> streams;
  for (const size_t sensor : {kImu, kLidar, kCamera}) {
    streams.push_back({kSensorNames[sensor], sensor == kLidar ? "scans" : "mav0", {}});
    for (const Entry& entry : entries_)
      if (entry.sensor == sensor) streams.back().messages.push_back({entry.stamp, entry.stamp});
  }
  plan_clocks(std::move(streams), folder_.string());
}

void FolderRecording::look_at_first_scan() {
  const auto first = std::find_if(entries_.begin(), entries_.end(),
                                  [](const Entry& entry) { return entry.sensor == kLidar; });
  try {
    facts_.rings = rings_of_clouds({cloud(*first)}, options_);
  } catch (const InputError&) {
    // Whoever reads the scan will come to it, and say where it is.
  }
  options_.rings = std::max(options_.rings, facts_.rings);
  clouds_ = CloudDecoder(options_);
}

void FolderRecording::list(const std::string& name, const std::string& type, size_t sensor, size_t count) {
  facts_.streams.push_back({name, type, count, kSensorNames[sensor]});
  facts_.has[sensor] = count > 0;
}

void FolderRecording::add_scans() {
  if (fs::exists(folder_ / "pcd" / "times.csv")) {
    add_pcd_scans();
  } else if (fs::is_directory(folder_ / "velodyne")) {
    add_kitti_scans();
  }
  if (!facts_.has[kLidar])
    throw InputError(
        fmt::format("{}: no LiDAR: expected velodyne/000000.bin, ... with times.txt, or pcd/times.csv",
                    folder_.string()));
}

void FolderRecording::add_kitti_scans() {
  const std::vector<Time> times = times_of(folder_ / "times.txt");
  size_t found = 0;
  for (; found < times.size(); ++found) {
    const fs::path path = folder_ / "velodyne" / fmt::format("{:06}.bin", found);
    if (!fs::exists(path)) break;
    entries_.push_back({times[found], kLidar, files_.size()});
    files_.push_back({path, std::nullopt});
  }
  list("velodyne", "KITTI", kLidar, found);
}

void FolderRecording::add_pcd_scans() {
  const fs::path table = folder_ / "pcd" / "times.csv";
  const auto rows = rows_of(table, 2);
  for (const auto& row : rows) {
    const auto end = row.size() > 2 ? std::optional(nanoseconds(row[2], table)) : std::nullopt;
    entries_.push_back({nanoseconds(row[1], table), kLidar, files_.size()});
    files_.push_back({folder_ / "pcd" / row[0], end});
  }
  list("pcd", "PCD", kLidar, rows.size());
}

void FolderRecording::add_imu() {
  const fs::path table = folder_ / "mav0" / "imu0" / "data.csv";
  if (!fs::exists(table)) return;
  for (const auto& row : rows_of(table, 7)) {
    entries_.push_back({nanoseconds(row[0], table), kImu, imu_.size()});
    imu_.push_back({entries_.back().stamp, three(row, 1, table), three(row, 4, table), std::nullopt});
  }
  list("mav0/imu0", "EuRoC", kImu, imu_.size());
}

void FolderRecording::add_images() {
  const fs::path table = folder_ / "mav0" / "cam0" / "data.csv";
  if (!fs::exists(table)) return;
  const auto rows = rows_of(table, 2);
  for (const auto& row : rows) {
    entries_.push_back({nanoseconds(row[0], table), kCamera, files_.size()});
    files_.push_back({folder_ / "mav0" / "cam0" / "data" / row[1], std::nullopt});
  }
  list("mav0/cam0", "EuRoC", kCamera, rows.size());
}

std::optional<RecordedSample> FolderRecording::next() {
  if (next_ == entries_.size()) return std::nullopt;
  const Entry& entry = entries_[next_++];
  if (entry.sensor == kImu) return RecordedSample{imu_[entry.index], entry.stamp};
  return entry.sensor == kLidar ? scan(entry) : image(entry);
}

PointCloudMessage FolderRecording::cloud(const Entry& entry) const {
  const fs::path& path = files_[entry.index].path;
  PointCloudMessage cloud = path.extension() == ".pcd" ? read_pcd_cloud(path) : read_kitti_cloud(path);
  cloud.header.stamp = entry.stamp;
  return cloud;
}

RecordedSample FolderRecording::scan(const Entry& entry) {
  const File& file = files_[entry.index];
  LidarScan scan = clouds_.decode(cloud(entry), file.path.string());
  // Times of points are rounded: the last may be a little after the end.
  if (file.end && *file.end >= scan.end - Duration{1000}) scan.end = *file.end;
  const Time end = scan.end;
  return {std::move(scan), end};
}

RecordedSample FolderRecording::image(const Entry& entry) {
  const File& file = files_[entry.index];
  const std::string bytes = read_file(file.path);
  CameraFrame frame = decode_image_file({reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size()},
                                        entry.stamp, file.path.string(), &depth_);
  check_image_size(frame, rig_.camera, file.path.string());
  return {std::move(frame), entry.stamp};
}

std::vector<std::string> FolderRecording::notes() const {
  std::vector<std::string> notes;
  for (const std::string& note : clouds_.notes()) notes.push_back("lidar: " + note);
  if (const std::string note = note_of(depth_); !note.empty()) notes.push_back(note);
  return notes;
}

}  // namespace vsslam

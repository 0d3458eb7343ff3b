#include "scenarios/run/replay.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "core/errors.h"
#include "scenarios/datasets/import/kitti_truth.h"
#include "scenarios/evaluation/csv.h"
#include "scenarios/evaluation/score.h"
#include "scenarios/evaluation/trajectory_file.h"
#include "scenarios/experiment/fingerprint.h"
#include "scenarios/experiment/library_files.h"

namespace vsslam {

namespace fs = std::filesystem;

namespace {

// A chunk is one scan with what came before it, or so much without one.
constexpr size_t kChunkSamples = 64;
constexpr size_t kQueueChunks = 4;
constexpr double kTruthStep_s = 0.25;  // between poses that a pose between them is taken from

constexpr std::pair<const char*, PriorKind> kPriors[] = {{"vio", PriorKind::vio},
                                                         {"wheel_imu", PriorKind::wheel_imu},
                                                         {"imu", PriorKind::imu},
                                                         {"wheel", PriorKind::wheel},
                                                         {"constant_velocity", PriorKind::constant_velocity}};

const char* name_of(PriorKind prior) {
  for (const auto& [name, kind] : kPriors)
    if (kind == prior) return name;
  return "";
}

bool sets_prior(const std::vector<Override>& overrides) {
  return std::any_of(overrides.begin(), overrides.end(),
                     [](const Override& o) { return o.path == "slam.prior" || o.path == "prior"; });
}

RigSheet load_sheet(const ReplayRequest& request) {
  RigSheet sheet;
  if (!request.rig.empty()) {
    load_config(find_file("sheets", request.rig), sheet, library());
    return sheet;
  }
  const fs::path folder =
      fs::is_directory(request.recording) ? request.recording : request.recording.parent_path();
  if (!fs::exists(folder / "rig.yaml"))
    throw InputError(fmt::format("{}: which robot? Give its sheet with --rig: {}, or the path of one",
                                 request.recording.string(), fmt::join(library_names("sheets"), ", ")));
  load_config(folder / "rig.yaml", sheet, library());
  return sheet;
}

std::string stem_of(const fs::path& path) {
  const fs::path whole = fs::absolute(path).lexically_normal();
  const fs::path last = whole.has_filename() ? whole : whole.parent_path();
  return fs::is_directory(last) ? last.filename().string() : last.stem().string();
}

Measurement measurement_of(Sample&& sample) {
  if (auto* imu = std::get_if<ImuSample>(&sample)) {
    ImuMeasurement measurement;
    measurement.sample = *imu;
    return measurement;
  }
  if (auto* wheels = std::get_if<WheelSample>(&sample)) {
    WheelMeasurement measurement;
    measurement.sample = *wheels;
    return measurement;
  }
  if (auto* camera = std::get_if<CameraFrame>(&sample)) {
    CameraMeasurement measurement;
    measurement.frame = std::move(*camera);
    return measurement;
  }
  LidarMeasurement measurement;
  measurement.scan = std::move(std::get<LidarScan>(sample));
  return measurement;
}

}  // namespace

void ReplayConfig::fields(Fields& f) {
  f("slam", slam);
  f("map_voxel_m", map_voxel_m, positive());
}

PriorKind prior_for(const bool (&has)[kSensors]) {
  const auto [imu, wheels, lidar, camera] = has;
  if (imu && camera) return PriorKind::vio;
  if (imu) return wheels ? PriorKind::wheel_imu : PriorKind::imu;
  return wheels ? PriorKind::wheel : PriorKind::constant_velocity;
}

std::optional<SE3> pose_at(std::span<const StampedPose> trajectory, Time stamp, double most_s) {
  const auto after = std::lower_bound(trajectory.begin(), trajectory.end(), stamp,
                                      [](const StampedPose& pose, Time t) { return pose.stamp < t; });
  if (after == trajectory.end()) return std::nullopt;
  if (after->stamp == stamp) return after->pose;
  if (after == trajectory.begin()) return std::nullopt;
  const StampedPose& before = *(after - 1);
  const double step_s = seconds_between(before.stamp, after->stamp);
  if (step_s > most_s) return std::nullopt;
  return interpolate(before.pose, after->pose, seconds_between(before.stamp, stamp) / step_s);
}

ReplayedRecording::ReplayedRecording(const ReplayRequest& request,
                                     std::function<void(const std::string&)> on_note)
    : path_(request.recording),
      out_(request.out),
      name_(request.name.empty() ? stem_of(request.recording) : request.name),
      on_note_(std::move(on_note)) {
  if (!fs::exists(path_)) throw InputError(fmt::format("{}: no such file or folder", path_.string()));
  sheet_ = load_sheet(request);
  load_config_text("{}", "--set", config_, library(), request.overrides);
  RecordingOptions options{.topics = request.topics,
                           .images = !sets_prior(request.overrides) || config_.slam.prior == PriorKind::vio,
                           .salvage = request.salvage,
                           .undistorted = request.undistorted};
  const bool truth_file = !request.truth.empty() && fs::exists(request.truth);
  if (truth_file) {
    options.topics["truth"] = "none";
  } else if (!request.truth.empty()) {
    options.topics["truth"] = truth_name_ = request.truth;
  }
  recording_ = open_recording(path_, sheet_, options);
  if (truth_file) read_truth(request.truth);
  if (request.truth.empty() && !request.topics.contains("truth")) find_truth_beside();
  samples_ = std::make_unique<SampleOrder>(*recording_);
  choose_prior(sets_prior(request.overrides));
  take_rings();
  setup_ = {config_.slam, sheet_.calibration, config_.map_voxel_m};
  tell_notes();
}

// A sheet with fewer rings than the LiDAR has would make its other points useless.
void ReplayedRecording::take_rings() {
  int& rings = sheet_.calibration.lidar.rings;
  const int found = recording_->facts().rings;
  if (found <= rings) return;
  add_note(fmt::format("lidar: points of {} rings, but the rig's sheet has {} (lidar.rings): {} are taken",
                       found, rings, found));
  rings = found;
}

// Of a dataset whose format has no topic for it.
void ReplayedRecording::find_truth_beside() {
  const fs::path file = path_ / (is_kitti_folder() ? "poses.txt" : "truth.tum");
  const std::vector<RecordedStream>& streams = recording_->facts().streams;
  if (!fs::is_directory(path_) || !fs::exists(file) ||
      std::any_of(streams.begin(), streams.end(),
                  [](const RecordedStream& s) { return s.used_as == "truth"; }))
    return;
  if (is_kitti_folder() && !fs::exists(path_ / "calib.txt")) {
    add_note("truth: poses.txt is not used: without calib.txt it is not known where camera 0 sits");
    return;
  }
  read_truth(file);
}

bool ReplayedRecording::is_kitti_folder() const {
  const std::vector<RecordedStream>& streams = recording_->facts().streams;
  return std::any_of(streams.begin(), streams.end(),
                     [](const RecordedStream& s) { return s.type == "KITTI"; });
}

// A trajectory of the base; but KITTI's poses of a KITTI folder are those of its camera 0.
void ReplayedRecording::read_truth(const fs::path& file) {
  truth_world_base_ = is_kitti_folder() && is_kitti(file)
                          ? read_kitti_truth(file, path_, sheet_.calibration.lidar.T_base_lidar)
                          : read_trajectory(file);
  truth_name_ = file.filename().string();
}

void ReplayedRecording::choose_prior(bool asked_for) {
  if (!asked_for) config_.slam.prior = prior_for(recording_->facts().has);
  std::vector<std::string> sensors;
  for (size_t i = 0; i < kSensors; ++i)
    if (recording_->facts().has[i]) sensors.emplace_back(kSensorNames[i]);
  add_note(fmt::format("prior: {}{} ({})", name_of(config_.slam.prior), asked_for ? ", as asked for" : "",
                       fmt::join(sensors, ", ")));
}

Step ReplayedRecording::claim(Beliefs&) {
  if (reading_ || ended_ || chunks().size() >= kQueueChunks) return {};
  reading_ = true;
  auto chunk = std::make_shared<Chunk>();
  return {.work = [this, chunk] { read_chunk(*chunk); },
          .commit =
              [this, chunk] {
                if (!chunk->measurements.empty()) chunks().push_back(chunk);
                reading_ = false;
                tell_notes();
              }};
}

void ReplayedRecording::read_chunk(Chunk& chunk) {
  const StageTimer timer(&clock_, "read");
  while (chunk.measurements.size() < kChunkSamples) {
    std::optional<RecordedSample> sample = samples_->next();
    if (!sample) {
      ended_ = true;
      break;
    }
    if (!first_end_) first_end_ = sample->end;
    chunk.until = last_end_ = sample->end;
    const bool scan = std::holds_alternative<LidarScan>(sample->sample);
    chunk.measurements.push_back(measurement_of(std::move(sample->sample)));
    if (scan) break;
  }
  note_gaps();
  constexpr size_t kLidar = 2;
  if (ended_ && samples_->counts(kLidar).used == 0)
    throw InputError(fmt::format("{}: not one scan of the LiDAR could be used", path_.string()));
  if (!ended_) return;
  note_drops();
  take_truth();
}

void ReplayedRecording::note_gaps() {
  for (size_t sensor = 0; sensor < kSensors; ++sensor) {
    const SampleCounts& counts = samples_->counts(sensor);
    if (counts.first_gap)
      add_note(fmt::format("{}: gaps in the recording, the first after {} s", kSensorNames[sensor],
                           format_seconds(*counts.first_gap)));
  }
}

void ReplayedRecording::note_drops() {
  for (size_t sensor = 0; sensor < kSensors; ++sensor) {
    const SampleCounts& c = samples_->counts(sensor);
    const auto tell = [&](int64_t dropped, const char* why) {
      if (dropped > 0)
        add_note(fmt::format("{}: {} of {} samples dropped: {}", kSensorNames[sensor], dropped,
                             c.used + c.late + c.duplicates + c.stray + c.empty + c.unreadable, why));
    };
    tell(c.late, "they came too late");
    tell(c.duplicates, "a stamp again, or an earlier one");
    tell(c.stray, "a stamp far ahead of the others");
    tell(c.empty, "scans without points");
    tell(c.unreadable, "not to be read");
  }
}

void ReplayedRecording::add_note(const std::string& text) {
  if (std::find(notes_.begin(), notes_.end(), text) == notes_.end()) notes_.push_back(text);
}

void ReplayedRecording::tell_notes() {
  for (const std::string& note : recording_->notes()) add_note(note);
  for (; told_ < notes_.size(); ++told_)
    if (on_note_) on_note_(notes_[told_]);
}

void ReplayedRecording::judge(const OdometryRun& odometry) {
  camera_png_ = odometry.pictures().png();
}

// The truth on the samples' clock, while the samples last.
void ReplayedRecording::take_truth() {
  if (truth_world_base_.empty()) {
    truth_world_base_ = recording_->truth_world_base();
    for (const RecordedStream& stream : recording_->facts().streams)
      if (stream.used_as == "truth") truth_name_ = stream.name;
  }
  for (StampedPose& pose : truth_world_base_) pose.stamp = pose.stamp - samples_->epoch();
  const auto outside = [&](const StampedPose& pose) {
    return pose.stamp < *first_end_ - Duration{1'000'000'000} || pose.stamp > last_end_;
  };
  std::erase_if(truth_world_base_, outside);
  if (truth_world_base_.empty() && !truth_name_.empty())
    add_note(fmt::format("truth: {} has no pose during the recording: nothing is scored", truth_name_));
}

RunRecord ReplayedRecording::record(const MappingRun& estimation) const {
  const Mapping& mapping = estimation.mapping();
  const auto true_pose = [&](int key) {
    return pose_at(truth_world_base_, mapping.key_scans()[static_cast<size_t>(key)].stamp, kTruthStep_s);
  };
  const bool truth =
      !associate(mapping.trajectory_map_base(), truth_world_base_, ScoreOptions{}.max_time_difference)
           .empty();
  RunRecord record{.name = name_, .setup = setup_, .estimation = estimation};
  record.truth = truth ? Truth::trajectory : Truth::none;
  if (truth) record.truth_world_base = truth_world_base_;
  record.loops = score_loops(mapping.loops(), true_pose);
  record.camera_png = camera_png_;
  record.saved = {{"replay.yaml", save_config(config_)},
                  {"rig.yaml", save_config(sheet_)},
                  {"recording.json", recording_json()}};
  record.stamp_offset = samples_->epoch();
  record.source_health = source_health();
  record.duration_s = first_end_ ? seconds_between(*first_end_, last_end_) : 0;
  return record;
}

fs::path ReplayedRecording::result_folder(Method method) const {
  return out_ / name_ / method_name(method) / "replay";
}

std::string ReplayedRecording::made_by() const {
  return fingerprint();
}

// What the reader notes was set right or assumed, unless it asks.
SourceHealth ReplayedRecording::source_health() const {
  SourceHealth health;
  std::map<std::string, int64_t>* const dropped[kSensors] = {&health.imu_dropped, &health.wheels_dropped,
                                                             &health.lidar_dropped, &health.camera_dropped};
  for (size_t sensor = 0; sensor < kSensors; ++sensor) {
    const SampleCounts& c = samples_->counts(sensor);
    for (const auto& [reason, count] : {std::pair("late", c.late), std::pair("duplicate", c.duplicates),
                                        std::pair("stray", c.stray), std::pair("empty", c.empty)})
      if (count > 0) (*dropped[sensor])[reason] = count;
  }
  for (const std::string& note : recording_->notes()) {
    const bool doubtful = note.find('?') != note.npos || note.starts_with("damaged");
    (doubtful ? health.warnings : health.repairs).push_back(note);
  }
  return health;
}

std::string ReplayedRecording::recording_json() const {
  using Json = nlohmann::ordered_json;
  const RecordingFacts& facts = recording_->facts();
  Json streams = Json::array(), samples = Json::object();
  for (const RecordedStream& s : facts.streams)
    streams.push_back({{"name", s.name},
                       {"type", s.type},
                       {"messages", s.messages},
                       {"used_as", s.used_as.empty() ? Json(nullptr) : Json(s.used_as)}});
  for (size_t sensor = 0; sensor < kSensors; ++sensor) {
    const SampleCounts& c = samples_->counts(sensor);
    samples[kSensorNames[sensor]] = {{"used", c.used},
                                     {"dropped_late", c.late},
                                     {"dropped_duplicate", c.duplicates},
                                     {"dropped_stray", c.stray},
                                     {"dropped_empty", c.empty},
                                     {"dropped_unreadable", c.unreadable},
                                     {"moved_to_clock", c.moved},
                                     {"gaps", c.gaps},
                                     {"longest_gap_s", c.longest_gap_s}};
  }
  const Json json = {{"file", path_.filename().string()},
                     {"format", facts.format},
                     {"epoch_s", samples_->epoch().ns / 1'000'000'000},
                     {"prior", name_of(config_.slam.prior)},
                     {"truth", truth_name_.empty() ? Json(nullptr) : Json(truth_name_)},
                     {"streams", streams},
                     {"samples", samples},
                     {"notes", notes_}};
  return json.dump(2) + "\n";
}

}  // namespace vsslam

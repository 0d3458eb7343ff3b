// A recording through the same stack as a simulated run: what is asked for, and what becomes of it.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "core/config.h"
#include "scenarios/datasets/facts/rig_sheet.h"
#include "scenarios/datasets/import/open_recording.h"
#include "scenarios/datasets/import/sample_order.h"
#include "scenarios/run/measurement_source.h"

namespace vsslam {

/// Settings of a replay: replay.yaml in its result.
struct ReplayConfig {
  SlamConfig slam;
  double map_voxel_m = 0.1;  ///< of map.ply
  void fields(Fields& f);
};

struct ReplayRequest {
  std::filesystem::path recording;
  std::string rig{};                  ///< a sheet's name or path; empty: rig.yaml beside the recording
  std::vector<Override> overrides{};  ///< of ReplayConfig; without slam.prior the sensors decide
  std::string
      truth{};  ///< a trajectory file or a topic; empty: the sheet's topic, or truth.tum in the folder
  std::map<std::string, std::string> topics{};  ///< see RecordingOptions
  bool salvage = false, undistorted = false;
  std::string name{};  ///< of the result; empty: the recording's file name
  std::filesystem::path out = "out/runs";
};

/// The recording as the source of one run. Results: <out>/<name>/<method>/replay/, with what the recording was and what
/// was dropped and guessed in recording.json. Stamps are written as recorded.
class ReplayedRecording final : public MeasurementSource {
 public:
  /// `on_note` is called under the schedule's lock, and here. Throws InputError.
  ReplayedRecording(const ReplayRequest& request, std::function<void(const std::string&)> on_note);

  const std::string& name() const { return name_; }

  void open() override {}
  const EstimatorSetup& setup() const override { return setup_; }
  double expected_duration_s() const override { return recording_->facts().expected_duration_s; }
  Step claim(Beliefs& beliefs) override;
  bool ended() const override { return ended_ && !reading_; }
  void judge(const OdometryRun& odometry) override;
  RunRecord record(const MappingRun& estimation) const override;
  std::filesystem::path result_folder(Method method) const override;
  std::string made_by() const override;
  void add_times(WallClock& clock) const override { clock.add(clock_); }

 private:
  void find_truth_beside();
  bool is_kitti_folder() const;
  void read_truth(const std::filesystem::path& file);
  void take_rings();
  void choose_prior(bool asked_for);
  void read_chunk(Chunk& chunk);
  void take_truth();
  void add_note(const std::string& text);
  void tell_notes();
  void note_gaps();
  void note_drops();
  SourceHealth source_health() const;
  std::string recording_json() const;

  std::filesystem::path path_, out_;
  std::string name_;
  std::function<void(const std::string&)> on_note_;
  RigSheet sheet_;
  ReplayConfig config_;
  EstimatorSetup setup_;
  std::unique_ptr<Recording> recording_;
  std::unique_ptr<SampleOrder> samples_;
  WallClock clock_;
  bool reading_ = false, ended_ = false;
  std::optional<Time> first_end_;
  Time last_end_{0};
  std::vector<StampedPose>
      truth_world_base_;  // from a file: as recorded; after the last sample: on their clock
  std::string truth_name_, camera_png_;
  std::vector<std::string> notes_;
  size_t told_ = 0;
};

/// What the sensors of a recording allow, the best first: vio, wheel_imu, imu, wheel, constant_velocity.
PriorKind prior_for(const bool (&has)[kSensors]);

/// The pose at a stamp between two of a trajectory that are at most `most_s` apart.
std::optional<SE3> pose_at(std::span<const StampedPose> trajectory, Time stamp, double most_s);

}  // namespace vsslam

#include "scenarios/datasets/export/export_run.h"

#include <algorithm>
#include <deque>
#include <filesystem>
#include <functional>
#include <numeric>
#include <optional>
#include <utility>

#include "core/files.h"
#include "core/ordered_parallel.h"
#include "scenarios/datasets/export/scan_columns.h"
#include "scenarios/datasets/formats/image_files.h"
#include "scenarios/datasets/formats/png_file.h"
#include "scenarios/stages/driving.h"
#include "scenarios/stages/pipeline.h"
#include "sensors/rig.h"

namespace vsslam {

namespace {

using Sinks = std::vector<std::unique_ptr<DatasetSink>>;

// They bound the memory: so many stretches of 0.1 s.
constexpr size_t kQueueMotions = 4, kQueueChunks = 4;

/// Everything whose acquisition ended in one stretch of simulated time.
struct SampleChunk {
  Time until{};
  std::vector<DatasetSample> samples{};
};

Time end_of(const ImuMeasurement& m) {
  return m.true_stamp;
}
Time end_of(const WheelMeasurement& m) {
  return m.true_stamp;
}
Time end_of(const LidarMeasurement& m) {
  return m.true_stamp + (m.scan.end - m.scan.stamp);
}
Time end_of(const CameraMeasurement& m) {
  return m.end;
}

/// The sensors' side: samples of one stretch after the other.
class Acquisition {
 public:
  Acquisition(const Scenario& scenario, const World& world, const Sinks& sinks)
      : sinks_(sinks),
        rig_(world, scenario.rig, scenario.events.sensors, scenario.seeds.front(), scenario.lighting) {
    rig_.leave_out({.scan = [this](int64_t index, Time stamp) { return !needed(index, stamp); },
                    .image = [this](Time stamp) { return mean_grey_before(stamp); }});
    if (std::none_of(sinks.begin(), sinks.end(), [](const auto& s) { return s->wants_point_truth(); }))
      rig_.leave_out_point_truth();
  }

  SampleChunk next(const Motion& motion) {
    SampleChunk chunk{.until = motion.until};
    rig_.advance(
        motion.until, motion.trajectory, [&](Time t) { return motion.wheels.at(t); },
        [&](Measurement&& m) { chunk.samples.push_back(sample(std::move(m), motion.trajectory)); });
    return chunk;
  }
  Time needed_from() const { return rig_.needed_from(); }

 private:
  bool needed(int64_t scan, Time stamp) const {
    return std::any_of(sinks_.begin(), sinks_.end(),
                       [&](const auto& s) { return s->needs_scan(scan, stamp); });
  }

  // Of an image that an earlier, interrupted export has written everywhere.
  std::optional<double> mean_grey_before(Time stamp) const {
    std::filesystem::path file;
    for (const auto& sink : sinks_) {
      if (sink->needs_image(stamp)) return std::nullopt;
      if (file.empty()) file = sink->image_file(stamp);
    }
    if (file.empty()) return std::nullopt;
    const std::string bytes = read_file(file);
    const std::vector<uint8_t> grey =
        read_image_file({reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size()}, file.string()).data;
    const uint64_t sum = std::accumulate(grey.begin(), grey.end(), uint64_t{0});
    return static_cast<double>(sum) / static_cast<double>(grey.size());
  }

  DatasetSample sample(Measurement&& measurement, const Trajectory& trajectory) {
    DatasetSample sample{.measurement = std::move(measurement)};
    sample.index = next_index_[sample.measurement.index()]++;
    std::visit(
        [&](const auto& m) {
          sample.end = end_of(m);
          sample.base = trajectory.at(m.true_stamp);
        },
        sample.measurement);
    return sample;
  }

  const Sinks& sinks_;
  Rig rig_;
  int64_t next_index_[std::variant_size_v<Measurement>] = {};
};

void count(const DatasetSample& sample, DatasetCounts& counts) {
  counts.scans += std::holds_alternative<LidarMeasurement>(sample.measurement);
  counts.images += std::holds_alternative<CameraMeasurement>(sample.measurement);
  counts.imu += std::holds_alternative<ImuMeasurement>(sample.measurement);
  counts.wheels += std::holds_alternative<WheelMeasurement>(sample.measurement);
}

class ExportRun final : public Pipeline {
 public:
  ExportRun(ScenarioWorld& place, const Sinks& sinks, ExportOutcome& outcome,
            std::function<void(double expected_s)> on_progress)
      : place_(place),
        sinks_(sinks),
        outcome_(outcome),
        on_progress_(std::move(on_progress)),
        lasers_(laser_table(place.scenario().rig.sensors.lidar.model)),
        wants_png_(std::any_of(sinks.begin(), sinks.end(), [](const auto& s) { return s->wants_png(); })) {}
  ~ExportRun() override {
    for (const WallClock* clock : {&drive_clock_, &sense_clock_, &write_clock_}) outcome_.clock.add(*clock);
  }

  // Later steps first: they free memory.
  Step claim() override {
    if (!driving_) return busy_[kOpen] ? Step{} : begin(kOpen, open());
    if (!busy_[kWrite] && !chunks_.empty()) return begin(kWrite, write());
    if (!busy_[kSense] && !motions_.empty() && chunks_.size() < kQueueChunks) return begin(kSense, sense());
    if (!busy_[kDrive] && !driving_->ended() && motions_.size() < kQueueMotions)
      return begin(kDrive, drive());
    return {};
  }
  // While a step of the driving runs, what it changes is not to be read.
  bool finished() const override {
    return driving_ && std::none_of(std::begin(busy_), std::end(busy_), [](bool b) { return b; }) &&
           driving_->ended() && motions_.empty() && chunks_.empty();
  }

 private:
  enum Stage { kOpen, kDrive, kSense, kWrite, kStages };

  Step begin(Stage stage, Step step) {
    busy_[stage] = true;
    return {.work = std::move(step.work), .commit = [this, stage, commit = std::move(step.commit)] {
              commit();
              busy_[stage] = false;
            }};
  }

  Step open() {
    auto driving = std::make_shared<std::unique_ptr<Driving>>();
    return {.work =
                [this, driving] {
                  *driving = std::make_unique<Driving>(place_.scenario(), place_.world(), &drive_clock_);
                  acquisition_ = std::make_unique<Acquisition>(place_.scenario(), place_.world(), sinks_);
                },
            .commit =
                [this, driving] {
                  driving_ = std::move(*driving);
                  expected_s_ = driving_->expected_duration_s();
                }};
  }

  Step drive() {
    auto motion = std::make_shared<std::shared_ptr<const Motion>>();
    return {.work =
                [this, motion, from = needed_from_] {
                  *motion = std::make_shared<Motion>(driving_->next(std::nullopt, from));
                },
            .commit =
                [this, motion] {
                  motions_.push_back(*motion);
                  expected_s_ = driving_->expected_duration_s();
                  const DriveOutcome drive = driving_->outcome();
                  if (drive == DriveOutcome::stuck || drive == DriveOutcome::collided)
                    outcome_.failure = driving_->outcome_text();
                }};
  }

  Step sense() {
    auto chunk = std::make_shared<SampleChunk>();
    return {.work =
                [this, chunk, motion = motions_.front()] {
                  StageTimer timer(&sense_clock_, "sense");
                  *chunk = acquisition_->next(*motion);
                },
            .commit =
                [this, chunk] {
                  motions_.pop_front();
                  needed_from_ = acquisition_->needed_from();
                  chunks_.push_back(chunk);
                }};
  }

  Step write() {
    return {.work =
                [this, chunk = chunks_.front()] {
                  encode(*chunk);
                  StageTimer timer(&write_clock_, "write");
                  for (const DatasetSample& sample : chunk->samples) {
                    for (const auto& sink : sinks_) sink->write(sample);
                    count(sample, outcome_.counts);
                  }
                },
            .commit =
                [this] {
                  outcome_.counts.duration_s = chunks_.front()->until.seconds();
                  chunks_.pop_front();
                  on_progress_(expected_s_);
                }};
  }

  /// What several sinks want of a sample.
  void encode(SampleChunk& chunk) {
    StageTimer timer(&write_clock_, "encode");
    for (DatasetSample& sample : chunk.samples)
      if (auto* lidar = std::get_if<LidarMeasurement>(&sample.measurement))
        arrange_in_columns(*lidar, lasers_);
    if (!wants_png_) return;
    parallel_pieces(chunk.samples.size(), 1, [&](size_t i, size_t) {
      DatasetSample& sample = chunk.samples[i];
      const auto* camera = std::get_if<CameraMeasurement>(&sample.measurement);
      if (camera == nullptr || !needed(*camera)) return;
      sample.png = encode_png_grey8(camera->frame.width_px, camera->frame.height_px, camera->frame.grey);
    });
  }

  bool needed(const CameraMeasurement& camera) const {
    return std::any_of(sinks_.begin(), sinks_.end(),
                       [&](const auto& s) { return s->needs_image(camera.frame.stamp); });
  }

  ScenarioWorld& place_;
  const Sinks& sinks_;
  ExportOutcome& outcome_;
  std::function<void(double expected_s)> on_progress_;
  const LaserTable& lasers_;
  const bool wants_png_;
  WallClock drive_clock_, sense_clock_, write_clock_;
  std::unique_ptr<Driving> driving_;
  std::unique_ptr<Acquisition> acquisition_;
  std::deque<std::shared_ptr<const Motion>> motions_;  // driven, not yet sensed
  std::deque<std::shared_ptr<SampleChunk>> chunks_;    // sensed, not yet written
  Time needed_from_{0};
  double expected_s_ = 0;
  bool busy_[kStages] = {};
};

}  // namespace

ExportOutcome run_export(ScenarioWorld& place, const Sinks& sinks, int threads, const std::atomic<bool>& stop,
                         Progress& progress) {
  ExportOutcome outcome;
  const int64_t start_ns = outcome.clock.now_ns();
  std::vector<std::unique_ptr<Pipeline>> pipelines;
  pipelines.push_back(std::make_unique<ExportRun>(place, sinks, outcome, [&](double expected_s) {
    progress.update(
        {.done_s = outcome.counts.duration_s, .expected_s = expected_s, .scans = outcome.counts.scans});
  }));
  run_pipelines(std::move(pipelines), threads, stop);
  for (const auto& sink : sinks) sink->finish();
  outcome.wall_s = static_cast<double>(outcome.clock.now_ns() - start_ns) * 1e-9;
  return outcome;
}

}  // namespace vsslam

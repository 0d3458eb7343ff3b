#include "scenarios/datasets/export/sinks/truth_tables.h"

#include <array>

#include "scenarios/evaluation/csv.h"
#include "scenarios/oracles/degeneracy_truth.h"
#include "sensors/ray/raycaster.h"

namespace vsslam {

namespace {

constexpr std::array kImuColumns = {"stamp",        "gyro_bias_x",  "gyro_bias_y",  "gyro_bias_z",
                                    "accel_bias_x", "accel_bias_y", "accel_bias_z", "true_gyro_x",
                                    "true_gyro_y",  "true_gyro_z",  "true_accel_x", "true_accel_y",
                                    "true_accel_z"};
constexpr std::array kWheelColumns = {"stamp", "slip_left_mps", "slip_right_mps"};
constexpr std::array kDegeneracyColumns = {"scan",
                                           "stamp",
                                           "points",
                                           "degenerate_translations",
                                           "degenerate_rotations",
                                           "eigen_t_0",
                                           "eigen_t_1",
                                           "eigen_t_2",
                                           "weak_t_x",
                                           "weak_t_y",
                                           "weak_t_z",
                                           "eigen_r_0",
                                           "eigen_r_1",
                                           "eigen_r_2",
                                           "weak_r_x",
                                           "weak_r_y",
                                           "weak_r_z"};
constexpr std::array kKeyColumns = {"key", "scan", "stamp", "x", "y", "z", "qx", "qy", "qz", "qw"};
constexpr std::array kLoopColumns = {"query", "match", "query_stamp", "match_stamp", "x",       "y",      "z",
                                     "qx",    "qy",    "qz",          "qw",          "overlap", "revisit"};

// Rows without the header of a table that is written as it grows.
std::string rows_of(const CsvWriter& csv) {
  return csv.text().substr(csv.text().find('\n') + 1);
}

std::string header_of(std::span<const char* const> columns) {
  return CsvWriter(columns).text();
}

void put_block(CsvWriter& csv, const InformationBlock& block) {
  csv(block.eigenvalues)(Vec3(block.eigenvectors.col(0)));
}

}  // namespace

BiasSink::BiasSink(const DatasetFacts& facts)
    : imu_(facts.folder / "truth" / "imu.csv"), wheels_(facts.folder / "truth" / "wheels.csv") {
  imu_.write(header_of(kImuColumns));
  wheels_.write(header_of(kWheelColumns));
}

void BiasSink::write(const DatasetSample& sample) {
  if (const auto* imu = std::get_if<ImuMeasurement>(&sample.measurement)) {
    CsvWriter csv(kImuColumns);
    csv(dataset_time(imu->sample.stamp))(imu->gyro_bias_radps)(imu->accel_bias_mps2);
    csv(imu->true_gyro_radps)(imu->true_accel_mps2).end_row();
    imu_.write(rows_of(csv));
  } else if (const auto* wheels = std::get_if<WheelMeasurement>(&sample.measurement)) {
    CsvWriter csv(kWheelColumns);
    csv(dataset_time(wheels->sample.stamp))(wheels->slip_left_mps)(wheels->slip_right_mps).end_row();
    wheels_.write(rows_of(csv));
  }
}

void BiasSink::finish() {
  imu_.commit();
  wheels_.commit();
}

DegeneracySink::DegeneracySink(const DatasetFacts& facts)
    : table_(facts.folder / "truth" / "degeneracy.csv") {
  table_.write(header_of(kDegeneracyColumns));
}

void DegeneracySink::write(const DatasetSample& sample) {
  const auto* lidar = std::get_if<LidarMeasurement>(&sample.measurement);
  if (lidar == nullptr) return;
  const DegeneracyTruth truth = degeneracy_truth(*lidar);
  CsvWriter csv(kDegeneracyColumns);
  csv(sample.index)(dataset_time(lidar->scan.stamp))(truth.points);
  csv(truth.degenerate_translations)(truth.degenerate_rotations);
  put_block(csv, truth.information.translation);
  put_block(csv, truth.information.rotation);
  csv.end_row();
  table_.write(rows_of(csv));
}

LoopSink::LoopSink(const DatasetFacts& facts, const World& world)
    : world_(world),
      keys_table_(facts.folder / "truth" / "key_scans.csv"),
      loops_table_(facts.folder / "truth" / "loops.csv") {}

void LoopSink::write(const DatasetSample& sample) {
  const auto* lidar = std::get_if<LidarMeasurement>(&sample.measurement);
  if (lidar == nullptr) return;
  const Vec3& position_world = sample.base.T_world_base.translation;
  if (last_position_world_) travelled_m_ += (position_world - *last_position_world_).norm();
  last_position_world_ = position_world;
  if (travelled_m_ < key_due_m_) return;
  key_due_m_ = travelled_m_ + kKeyStep_m;
  const int key = static_cast<int>(keys_.size());
  keys_.push_back(key_scan_truth(key, *lidar, sample.base.T_world_base, LoopTruthOptions{}.max_points));
  scan_of_key_.push_back(sample.index);
}

void LoopSink::finish() {
  CsvWriter keys(kKeyColumns);
  for (const KeyScanTruth& key : keys_)
    keys(key.key)(scan_of_key_[static_cast<size_t>(key.key)])(dataset_time(key.stamp))(key.T_world_base)
        .end_row();
  keys_table_.write(keys.text());

  const Raycaster raycaster(world_);
  const LoopTruthOptions options;
  const LoopOracle oracle(world_, raycaster, std::move(keys_), options);
  CsvWriter loops(kLoopColumns);
  for (const KeyScanTruth& query : oracle.keys())
    for (const KeyScanTruth& match : oracle.keys()) {
      if (query.stamp - match.stamp < options.revisit_after) break;
      const SE3 T_match_query = match.T_world_base.inverse() * query.T_world_base;
      const double distance_m = T_match_query.translation.norm();
      if (distance_m > kLoopWithin_m) continue;
      const double overlap = oracle.overlap(query.key, match.key);
      const bool revisit = distance_m <= options.revisit_within_m && overlap >= options.revisit_overlap;
      loops(query.key)(match.key)(dataset_time(query.stamp))(dataset_time(match.stamp))(
          T_match_query)(overlap);
      loops(int{revisit}).end_row();
    }
  loops_table_.write(loops.text());
  keys_table_.commit();
  loops_table_.commit();
}

}  // namespace vsslam

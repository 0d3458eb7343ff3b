// Tables of truth: what the IMU and the wheels get wrong, what the scene leaves open, which places are seen again.
#pragma once

#include <optional>
#include <vector>

#include "core/files.h"
#include "scenarios/datasets/facts/dataset_facts.h"
#include "scenarios/datasets/facts/dataset_sink.h"
#include "scenarios/oracles/loop_truth.h"
#include "worlds/world.h"

namespace vsslam {

/// truth/imu.csv: true rates and biases; truth/wheels.csv: slip.
class BiasSink final : public DatasetSink {
 public:
  explicit BiasSink(const DatasetFacts& facts);
  bool needs_scan(int64_t, Time) const override { return false; }
  bool needs_image(Time) const override { return false; }
  void write(const DatasetSample& sample) override;
  void finish() override;

 private:
  AtomicFile imu_, wheels_;
};

/// truth/degeneracy.csv: per scan the eigenvalues of the information of its noise-free points about its pose.
class DegeneracySink final : public DatasetSink {
 public:
  explicit DegeneracySink(const DatasetFacts& facts);
  bool needs_scan(int64_t, Time) const override { return true; }
  bool needs_image(Time) const override { return false; }
  bool wants_point_truth() const override { return true; }
  void write(const DatasetSample& sample) override;
  void finish() override { table_.commit(); }

 private:
  AtomicFile table_;
};

/// truth/key_scans.csv and truth/loops.csv. Key scans: the first scan, then each that is kKeyStep_m further along the
/// driven way, as scans see it. Loops: pairs of key scans at least 30 s apart, within kLoopWithin_m.
class LoopSink final : public DatasetSink {
 public:
  static constexpr double kKeyStep_m = 1.0, kLoopWithin_m = 10.0;

  LoopSink(const DatasetFacts& facts, const World& world);
  bool needs_scan(int64_t, Time) const override { return true; }
  bool needs_image(Time) const override { return false; }
  void write(const DatasetSample& sample) override;
  void finish() override;

 private:
  const World& world_;
  AtomicFile keys_table_, loops_table_;
  std::vector<KeyScanTruth> keys_;
  std::vector<int64_t> scan_of_key_;
  std::optional<Vec3> last_position_world_;
  double travelled_m_ = 0, key_due_m_ = 0;
};

}  // namespace vsslam

// truth.tum: the base in the world at every LiDAR scan, evo's eight columns.
#pragma once

#include "core/files.h"
#include "scenarios/datasets/facts/dataset_facts.h"
#include "scenarios/datasets/facts/dataset_sink.h"

namespace vsslam {

class TruthTrajectorySink final : public DatasetSink {
 public:
  explicit TruthTrajectorySink(const DatasetFacts& facts) : file_(facts.folder / "truth.tum") {}
  bool needs_scan(int64_t, Time) const override { return false; }
  bool needs_image(Time) const override { return false; }
  void write(const DatasetSample& sample) override;
  void finish() override { file_.commit(); }

 private:
  AtomicFile file_;
};

}  // namespace vsslam

// Each scan as a file of its own: <folder>/%06d.pcd or .ply, and times.csv with their stamps.
#pragma once

#include "core/files.h"
#include "scenarios/datasets/facts/dataset_facts.h"
#include "scenarios/datasets/facts/dataset_sink.h"

namespace vsslam {

class CloudFolderSink final : public DatasetSink {
 public:
  enum class Format { pcd, ply };
  CloudFolderSink(const DatasetFacts& facts, Format format);

  bool needs_scan(int64_t index, Time stamp) const override;
  bool needs_image(Time) const override { return false; }
  void write(const DatasetSample& sample) override;
  void finish() override { times_.commit(); }

 private:
  std::string file_name(int64_t index) const;

  Format format_;
  std::filesystem::path folder_;
  AtomicFile times_;
};

}  // namespace vsslam

// truth/points/%06d.pcd, truth/clean/%06d.pcd, truth/labels/%06d.label: one record per point of a scan, in its order.
#pragma once

#include <functional>
#include <span>
#include <string>

#include "scenarios/datasets/facts/dataset_facts.h"
#include "scenarios/datasets/facts/dataset_sink.h"

namespace vsslam {

class PointTruthSink final : public DatasetSink {
 public:
  using Encoder = std::function<std::string(std::span<const PointTruth>)>;
  PointTruthSink(std::filesystem::path folder, std::string ending, Encoder encode)
      : folder_(std::move(folder)), ending_(std::move(ending)), encode_(std::move(encode)) {}

  bool needs_scan(int64_t index, Time) const override { return !std::filesystem::exists(file(index)); }
  bool needs_image(Time) const override { return false; }
  bool wants_point_truth() const override { return true; }
  void write(const DatasetSample& sample) override;
  void finish() override {}

 private:
  std::filesystem::path file(int64_t index) const;

  std::filesystem::path folder_;
  std::string ending_;
  Encoder encode_;
};

}  // namespace vsslam

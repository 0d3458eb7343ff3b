// truth/depth/<ns>.png and truth/clean_images/<ns>.png: the twin of each image, named by its stamp since 1970.
#pragma once

#include "scenarios/datasets/facts/dataset_facts.h"
#include "scenarios/datasets/facts/dataset_sink.h"

namespace vsslam {

class ImageTruthSink final : public DatasetSink {
 public:
  enum class Kind {
    depth,  ///< 16 bits, mm along the camera's z; 0: nothing within 65.5 m
    clean,  ///< 8 bits
  };
  ImageTruthSink(const DatasetFacts& facts, Kind kind);

  bool needs_scan(int64_t, Time) const override { return false; }
  bool needs_image(Time stamp) const override;
  void write(const DatasetSample& sample) override;
  void finish() override {}

 private:
  std::filesystem::path file(Time stamp) const;
  std::string encode(const CameraMeasurement& camera) const;

  Kind kind_;
  std::filesystem::path folder_;
};

}  // namespace vsslam

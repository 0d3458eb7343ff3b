// A folder as the TUM RGB-D benchmark has it: rgb/<s>.png (grey), rgb.txt, accelerometer.txt, groundtruth.txt (pose of
// the camera in the world at the IMU's stamps; of the base without a camera).
#pragma once

#include <optional>

#include "core/files.h"
#include "scenarios/datasets/facts/dataset_facts.h"
#include "scenarios/datasets/facts/dataset_sink.h"

namespace vsslam {

class TumSink final : public DatasetSink {
 public:
  explicit TumSink(const DatasetFacts& facts);

  bool needs_scan(int64_t, Time) const override { return false; }
  bool needs_image(Time stamp) const override;
  std::filesystem::path image_file(Time stamp) const override;
  bool wants_png() const override { return camera_; }
  void write(const DatasetSample& sample) override;
  void finish() override;

 private:
  std::filesystem::path folder_;
  bool camera_;
  SE3 T_base_tracked_;  ///< camera, or base
  AtomicFile accelerometer_, truth_;
  std::optional<AtomicFile> images_;
};

}  // namespace vsslam

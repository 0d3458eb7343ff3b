// A folder as the EuRoC MAV datasets have it (ASL format):
//   mav0/cam0/{sensor.yaml,data.csv,times.txt,data/<ns>.png}, mav0/imu0/{sensor.yaml,data.csv},
//   mav0/state_groundtruth_estimate0/{sensor.yaml,data.csv}, mav0/body.yaml
// The body is the IMU. Image and IMU stamps are nanoseconds since 1970. The ground truth has the IMU's stamps.
#pragma once

#include <deque>
#include <optional>

#include "core/files.h"
#include "scenarios/datasets/facts/dataset_facts.h"
#include "scenarios/datasets/facts/dataset_sink.h"

namespace vsslam {

/// Only images between two IMU samples are listed: ORB-SLAM3 reads past its IMU table otherwise.
class EurocSink final : public DatasetSink {
 public:
  explicit EurocSink(const DatasetFacts& facts);

  bool needs_scan(int64_t, Time) const override { return false; }
  bool needs_image(Time stamp) const override;
  std::filesystem::path image_file(Time stamp) const override;
  bool wants_png() const override { return camera_; }
  void write(const DatasetSample& sample) override;
  void finish() override;

 private:
  struct WaitingImage {
    Time stamp;
    std::string png;
  };
  void write(const ImuMeasurement& imu, const Kinematics& base);
  void release_images(Time before);
  void write_sensor_files(const DatasetFacts& facts) const;

  std::filesystem::path root_;
  bool camera_;
  SE3 T_base_imu_;
  AtomicFile imu_table_, truth_table_;
  std::optional<AtomicFile> image_table_, times_;
  std::optional<Time> first_imu_;
  std::deque<WaitingImage> waiting_;
};

}  // namespace vsslam

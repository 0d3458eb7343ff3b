// A folder as KITTI's odometry benchmark has one of a sequence: velodyne/%06d.bin, image_0/%06d.png, times.txt (s since
// the first scan), calib.txt, poses.txt (camera 0 in the first camera 0). Without a camera, camera 0 sits in the LiDAR,
// axes as a camera's. Scans are as they were fired, not undistorted.
#pragma once

#include <deque>
#include <optional>

#include "core/files.h"
#include "scenarios/datasets/facts/dataset_facts.h"
#include "scenarios/datasets/facts/dataset_sink.h"

namespace vsslam {

/// Each scan's image is the one nearest to its stamp, when the LiDAR looks forward.
class KittiSink final : public DatasetSink {
 public:
  explicit KittiSink(const DatasetFacts& facts);

  bool needs_scan(int64_t index, Time stamp) const override;
  bool needs_image(Time) const override { return camera_; }
  bool wants_png() const override { return camera_; }
  void write(const DatasetSample& sample) override;
  void finish() override;

 private:
  struct Image {
    Time stamp;
    std::string png;
  };
  std::filesystem::path scan_file(int64_t index) const;
  void write_nearest_image(int64_t index, Time stamp);

  std::filesystem::path folder_;
  bool camera_;
  SE3 T_base_camera_;
  AtomicFile times_, poses_;
  std::optional<Time> first_stamp_;
  SE3 T_first_world_;  ///< into the first camera's frame
  std::deque<Image> images_;
};

}  // namespace vsslam

// Recordings that are folders of files: scans of a KITTI folder or of PCD files, and IMU and images of a EuRoC folder,
// alone or side by side.
//
//   velodyne/%06d.bin, times.txt (s)            x y z reflectance float32; no times and no rings
//   pcd/NAME.pcd, pcd/times.csv (file,stamp_ns,...)   binary PCD: fields as a point cloud message has them
//   mav0/imu0/data.csv                          EuRoC: ns, rad/s, m/s^2
//   mav0/cam0/data.csv, mav0/cam0/data/*        EuRoC: ns, file
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/calibration.h"
#include "scenarios/datasets/import/decoders/cloud_decoder.h"
#include "scenarios/datasets/import/decoders/image_decoder.h"
#include "scenarios/datasets/import/recording.h"

namespace vsslam {

/// Does the folder look like one?
bool is_folder_recording(const std::filesystem::path& folder);

class FolderRecording final : public Recording {
 public:
  /// Tables are read here, scans and images when they are due. Throws InputError: no scans, a broken table, sensors on
  /// clocks that have no time in common.
  FolderRecording(std::filesystem::path folder, const RigCalibration& rig,
                  const CloudDecoder::Options& clouds, bool images);

  const RecordingFacts& facts() const override { return facts_; }
  std::optional<RecordedSample> next() override;
  std::vector<std::string> notes() const override;

 private:
  struct Entry {
    Time stamp;
    size_t sensor;  ///< index of Sample
    size_t index;   ///< into imu_, or files_
  };
  struct File {
    std::filesystem::path path;
    std::optional<Time> end;
  };

  void add_scans();
  void add_kitti_scans();
  void add_pcd_scans();
  void add_imu();
  void add_images();
  void list(const std::string& name, const std::string& type, size_t sensor, size_t count);
  void check_clocks() const;
  void look_at_first_scan();
  PointCloudMessage cloud(const Entry& entry) const;
  RecordedSample scan(const Entry& entry);
  RecordedSample image(const Entry& entry);

  std::filesystem::path folder_;
  RigCalibration rig_;
  CloudDecoder::Options options_;
  CloudDecoder clouds_;
  PixelDepth depth_;
  RecordingFacts facts_;
  std::vector<Entry> entries_;  // by stamp
  std::vector<ImuSample> imu_;
  std::vector<File> files_;
  size_t next_ = 0;
};

}  // namespace vsslam

#include "scenarios/datasets/export/sinks/cloud_folder_sink.h"

#include <fmt/format.h>

#include "scenarios/datasets/formats/cloud_files.h"

namespace vsslam {

CloudFolderSink::CloudFolderSink(const DatasetFacts& facts, Format format)
    : format_(format),
      folder_(facts.folder / (format == Format::pcd ? "pcd" : "ply")),
      times_(folder_ / "times.csv") {
  times_.write("file,stamp_ns,end_ns\n");
}

std::string CloudFolderSink::file_name(int64_t index) const {
  return fmt::format("{:06}.{}", index, format_ == Format::pcd ? "pcd" : "ply");
}

bool CloudFolderSink::needs_scan(int64_t index, Time) const {
  return !std::filesystem::exists(folder_ / file_name(index));
}

void CloudFolderSink::write(const DatasetSample& sample) {
  const auto* lidar = std::get_if<LidarMeasurement>(&sample.measurement);
  if (lidar == nullptr) return;
  const std::string name = file_name(sample.index);
  if (needs_scan(sample.index, lidar->scan.stamp))
    write_file(folder_ / name, format_ == Format::pcd ? pcd_of_scan(lidar->scan) : ply_of_scan(lidar->scan));
  times_.write(
      fmt::format("{},{},{}\n", name, dataset_time(lidar->scan.stamp).ns, dataset_time(lidar->scan.end).ns));
}

}  // namespace vsslam

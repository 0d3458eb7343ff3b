#include "scenarios/datasets/export/sinks/kitti_sink.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>

#include "scenarios/datasets/formats/cloud_files.h"

namespace vsslam {

namespace fs = std::filesystem;

namespace {

// Images that may still be the nearest of a scan: it is written a revolution after its stamp.
constexpr Duration kImagesKept{400'000'000};

std::string row_of(const SE3& T) {
  const Eigen::Matrix4d m = T.matrix4();
  std::string row;
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 4; ++c) row += fmt::format("{}{}", row.empty() ? "" : " ", m(r, c));
  return row;
}

SE3 camera_mount(const DatasetFacts& facts) {
  if (facts.has_camera()) return facts.rig.camera.T_base_camera;
  const Quat q_lidar_camera(0.5, -0.5, 0.5, -0.5);  // z forward, x right
  return facts.rig.lidar.T_base_lidar * SE3(q_lidar_camera, Vec3::Zero());
}

std::string calibration_text(const DatasetFacts& facts) {
  const CameraCalibration& c = facts.rig.camera;
  std::string text;
  for (int camera = 0; camera < 4; ++camera)
    text += fmt::format("P{}: {} 0 {} 0 0 {} {} 0 0 0 1 0\n", camera, c.fx_px, c.cx_px, c.fy_px, c.cy_px);
  return text + fmt::format("Tr: {}\n", row_of(camera_mount(facts).inverse() * facts.rig.lidar.T_base_lidar));
}

}  // namespace

KittiSink::KittiSink(const DatasetFacts& facts)
    : folder_(facts.folder),
      camera_(facts.has_camera()),
      T_base_camera_(camera_mount(facts)),
      times_(folder_ / "times.txt"),
      poses_(folder_ / "poses.txt") {
  write_file(folder_ / "calib.txt", calibration_text(facts));
}

fs::path KittiSink::scan_file(int64_t index) const {
  return folder_ / "velodyne" / fmt::format("{:06}.bin", index);
}

bool KittiSink::needs_scan(int64_t index, Time) const {
  return !fs::exists(scan_file(index));
}

void KittiSink::write(const DatasetSample& sample) {
  if (const auto* camera = std::get_if<CameraMeasurement>(&sample.measurement)) {
    if (camera_) images_.push_back({camera->frame.stamp, sample.png});
    return;
  }
  const auto* lidar = std::get_if<LidarMeasurement>(&sample.measurement);
  if (lidar == nullptr) return;
  const SE3 T_world_camera = sample.base.T_world_base * T_base_camera_;
  if (!first_stamp_) {
    first_stamp_ = lidar->scan.stamp;
    T_first_world_ = T_world_camera.inverse();
  }
  if (const fs::path file = scan_file(sample.index); !fs::exists(file))
    write_file(file, kitti_of_scan(lidar->scan));
  times_.write(fmt::format("{}\n", (lidar->scan.stamp - *first_stamp_).seconds()));
  poses_.write(row_of(T_first_world_ * T_world_camera) + "\n");
  if (camera_) write_nearest_image(sample.index, lidar->scan.stamp);
}

void KittiSink::write_nearest_image(int64_t index, Time stamp) {
  while (!images_.empty() && images_.front().stamp < stamp - kImagesKept) images_.pop_front();
  const auto nearest = std::min_element(images_.begin(), images_.end(), [&](const Image& a, const Image& b) {
    return std::abs((a.stamp - stamp).ns) < std::abs((b.stamp - stamp).ns);
  });
  if (nearest == images_.end()) return;
  const fs::path file = folder_ / "image_0" / fmt::format("{:06}.png", index);
  if (!fs::exists(file)) write_file(file, nearest->png);
}

void KittiSink::finish() {
  times_.commit();
  poses_.commit();
}

}  // namespace vsslam

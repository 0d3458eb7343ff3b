#include "scenarios/datasets/export/sinks/tum_sink.h"

#include <fmt/format.h>

#include <vector>

#include "scenarios/evaluation/csv.h"
#include "scenarios/evaluation/trajectory_file.h"

namespace vsslam {

namespace fs = std::filesystem;

TumSink::TumSink(const DatasetFacts& facts)
    : folder_(facts.folder),
      camera_(facts.has_camera()),
      T_base_tracked_(camera_ ? facts.rig.camera.T_base_camera : SE3()),
      accelerometer_(folder_ / "accelerometer.txt"),
      truth_(folder_ / "groundtruth.txt") {
  accelerometer_.write("# timestamp ax ay az (m/s^2, frame of the IMU)\n");
  truth_.write(fmt::format("# timestamp tx ty tz qx qy qz qw (of the {} in the world)\n",
                           camera_ ? "camera" : "base"));
  if (!camera_) return;
  images_.emplace(folder_ / "rgb.txt");
  images_->write("# timestamp filename (grey images)\n");
}

fs::path TumSink::image_file(Time stamp) const {
  return folder_ / "rgb" / fmt::format("{}.png", format_seconds(dataset_time(stamp)));
}

bool TumSink::needs_image(Time stamp) const {
  return camera_ && !fs::exists(image_file(stamp));
}

void TumSink::write(const DatasetSample& sample) {
  if (const auto* imu = std::get_if<ImuMeasurement>(&sample.measurement)) {
    const Time stamp = dataset_time(imu->sample.stamp);
    const Vec3& a = imu->sample.accel_mps2;
    accelerometer_.write(fmt::format("{} {} {} {}\n", format_seconds(stamp), a.x(), a.y(), a.z()));
    truth_.write(format_tum(std::vector{StampedPose{stamp, sample.base.T_world_base * T_base_tracked_}}));
  } else if (const auto* camera = std::get_if<CameraMeasurement>(&sample.measurement)) {
    const fs::path file = image_file(camera->frame.stamp);
    if (!fs::exists(file)) write_file(file, sample.png);
    images_->write(fmt::format("{} rgb/{}\n", format_seconds(dataset_time(camera->frame.stamp)),
                               file.filename().string()));
  }
}

void TumSink::finish() {
  accelerometer_.commit();
  truth_.commit();
  if (images_) images_->commit();
}

}  // namespace vsslam

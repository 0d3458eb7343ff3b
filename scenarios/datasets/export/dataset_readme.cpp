#include "scenarios/datasets/export/dataset_readme.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace vsslam {

namespace {

std::string row(const std::string& topic, const char* type, int64_t count, double duration_s,
                const std::string& what) {
  const std::string rate = duration_s > 0 && count > 1
                               ? fmt::format("{:.1f}", static_cast<double>(count) / duration_s)
                               : std::string("once");
  return fmt::format("| `{}` | {} | {} | {} | {} |\n", topic, type, count, rate, what);
}

std::string topics(const ExportPlan& plan, const DatasetCounts& n) {
  const MessageNames& names = plan.facts.names;
  const double s = n.duration_s;
  std::string text = "| topic | type | messages | Hz | content |\n|---|---|---|---|---|\n";
  text +=
      row(names.points, "sensor_msgs/PointCloud2", n.scans, s,
          fmt::format(
              "frame `{}`; x y z intensity float32, ring uint16, time float32 (s after the stamp), 22 bytes "
              "a point, firing cycle by firing cycle and by ring within one, each in the frame at its own "
              "time; stamp: first firing",
              names.lidar_frame));
  text += row(
      names.imu, "sensor_msgs/Imu", n.imu, s,
      fmt::format("frame `{}`; rad/s, m/s^2 (+g upwards at rest), orientation of the device, east-north-up",
                  names.imu_frame));
  if (plan.facts.has_camera()) {
    text += row(names.image, "sensor_msgs/Image", n.images, s,
                fmt::format("frame `{}` (x right, y down, z forward); mono8; stamp: middle of the exposure",
                            names.camera_frame));
    text += row(names.camera_info, "sensor_msgs/CameraInfo", n.images, s, "intrinsics");
  }
  text += row(names.joints, "sensor_msgs/JointState", n.wheels, s,
              "left_wheel, right_wheel: accumulated rotation, rad; means of the front and rear wheel");
  text += row(names.odometry, "nav_msgs/Odometry", n.wheels, s,
              fmt::format("`{}` -> `{}`, dead-reckoned from the wheels", names.odom_frame, names.base_frame));
  text += row(
      names.truth, "nav_msgs/Odometry", n.scans, s,
      fmt::format("`{}` -> `{}`: exact truth at every scan's stamp", names.world_frame, names.base_frame));
  text += row(names.static_transforms, "tf2_msgs/TFMessage", 1, s,
              fmt::format("`{}` -> sensors, latched", names.base_frame));
  return text + "\nMessages are recorded at the end of their acquisition.\n";
}

std::string format_text(DatasetFormat format, const ExportPlan& plan, const DatasetCounts& n) {
  const std::string& name = plan.facts.scenario.name;
  switch (format) {
    case DatasetFormat::bag:
      return fmt::format("* `{}.bag`: ROS 1 bag, LZ4\n", name);
    case DatasetFormat::mcap:
      return fmt::format("* `{}.mcap`: MCAP with ROS 2 messages, zstd\n", name);
    case DatasetFormat::euroc:
      return fmt::format(
          "* `mav0/`: as EuRoC has it (ASL format); the body is the IMU. Ground truth at the IMU's stamps, "
          "with velocity "
          "and biases{}\n",
          plan.facts.has_camera() ? ". Images before the first or after the last IMU sample are left out"
                                  : "");
    case DatasetFormat::kitti:
      return fmt::format(
          "* `velodyne/%06d.bin` ({} scans; x y z reflectance 0..1), `times.txt`, `calib.txt`, "
          "`poses.txt`{}: as KITTI's "
          "odometry benchmark. Scans are as fired, not undistorted, and carry no times of points\n",
          n.scans,
          plan.facts.has_camera() ? ", `image_0/%06d.png` (the image nearest to the scan's stamp)" : "");
    case DatasetFormat::pcd:
      return fmt::format("* `pcd/%06d.pcd` ({} scans, binary; x y z intensity ring time), `pcd/times.csv`\n",
                         n.scans);
    case DatasetFormat::ply:
      return fmt::format("* `ply/%06d.ply` ({} scans, binary; x y z intensity ring time), `ply/times.csv`\n",
                         n.scans);
    case DatasetFormat::tum:
      return fmt::format(
          "* {}`accelerometer.txt`, `groundtruth.txt` (of the {} at the IMU's stamps): as TUM RGB-D\n",
          plan.facts.has_camera() ? "`rgb/`, `rgb.txt` (grey images), " : "",
          plan.facts.has_camera() ? "camera" : "base");
  }
  return {};
}

std::string files(const ExportPlan& plan, const DatasetCounts& counts) {
  std::string text;
  for (const DatasetFormat format : plan.formats) text += format_text(format, plan, counts);
  text +=
      "* `truth.tum`: the base in the world at every scan's stamp: t x y z qx qy qz qw\n"
      "* `rig.yaml`: calibration and topics; `scenario.yaml`: the scenario with all settings, runs as it "
      "is\n";
  if (plan.system != nullptr)
    for (const ExtraFile& file : plan.system->configuration(plan.facts))
      text += fmt::format("* `{}`: for {}\n", file.path, plan.system->title);
  return text + truth_description(plan.truth, plan.facts.has_camera());
}

std::string summary(const Scenario& scenario, const DatasetCounts& counts) {
  std::string text = fmt::format("# {}\n\n", scenario.name);
  if (!scenario.description.empty()) text += scenario.description + "\n\n";
  return text + fmt::format(
                    "Simulated: a Scout 2.0, {:.1f} s, seed {}. {} scans, {} images, {} IMU "
                    "samples, {} wheel "
                    "samples. The calibration is the simulator's own and the truth is what happened: both "
                    "are exact.\n\n",
                    counts.duration_s, scenario.seeds.front(), counts.scans, counts.images, counts.imu,
                    counts.wheels);
}

std::string conventions(const MessageNames& names) {
  return fmt::format(
      "`T_a_b` maps coordinates in b to coordinates in a. `{}`: middle of the chassis, x forward, y left, z "
      "up. "
      "`{}` (LiDAR), `{}` (IMU): the same axes when mounted level. `{}`: x right, y down, z forward. m, rad, "
      "s. "
      "Time 0 of the simulation is {} s since 1970.\n",
      names.base_frame, names.lidar_frame, names.imu_frame, names.camera_frame,
      kDatasetEpoch.ns / 1'000'000'000);
}

}  // namespace

std::string dataset_readme(const ExportPlan& plan, const DatasetCounts& counts) {
  const bool messages = plan.has(DatasetFormat::bag) || plan.has(DatasetFormat::mcap);
  std::string text = summary(plan.facts.scenario, counts);
  text += "## Files\n\n" + files(plan, counts);
  if (messages) text += "\n## Topics\n\n" + topics(plan, counts);
  text += "\n## Frames, units, time\n\n" + conventions(plan.facts.names);
  if (plan.system != nullptr)
    text += fmt::format("\n## {}\n\n{}", plan.system->title, plan.system->instructions(plan.facts));
  text += "\n## VS-SLAM Testbed\n\n";
  if (messages) text += "    ./vsslam replay .             # the testbed's own stack on this dataset\n";
  return text +
         "    ./vsslam run scenario.yaml    # the same in the simulator\n"
         "    ./vsslam evaluate estimate.tum truth.tum\n";
}

}  // namespace vsslam

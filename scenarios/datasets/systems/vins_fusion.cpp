// VINS-Fusion (Qin et al., 2019), github.com/HKUST-Aerial-Robotics/VINS-Fusion, ROS 1. Keys and conventions: its
// config/euroc/euroc_mono_imu_config.yaml, config/euroc/cam0_pinhole.yaml.
#include <fmt/format.h>

#include "scenarios/datasets/systems/configuration_text.h"
#include "scenarios/datasets/systems/target_configurations.h"

namespace vsslam {

namespace {

MessageNames names() {
  MessageNames names;
  names.imu = "/imu0";
  names.image = "/cam0/image_raw";
  names.camera_info = "/cam0/camera_info";
  return names;
}

std::string main_file(const DatasetFacts& facts) {
  const ImuCalibration& imu = facts.rig.imu;
  const CameraCalibration& c = facts.rig.camera;
  return fmt::format(
      "%YAML:1.0\n\n# VINS-Fusion's parameters for this dataset: numbers of the simulated rig, settings as "
      "its authors "
      "ship them.\nimu: 1\nnum_of_cam: 1\n\nimu_topic: \"{}\"\nimage0_topic: \"{}\"\noutput_path: "
      "\"/tmp/\"\n\n"
      "cam0_calib: \"cam0_pinhole.yaml\"\nimage_width: {}\nimage_height: {}\n\n"
      "# T_imu_camera: camera coordinates to IMU coordinates, exact.\nestimate_extrinsic: 0\n"
      "body_T_cam0: !!opencv-matrix\n   rows: 4\n   cols: 4\n   dt: d\n   data: [{}]\n\n"
      "multiple_thread: 1\n\nmax_cnt: 150\nmin_dist: 30\nfreq: 10\nF_threshold: 1.0\nshow_track: "
      "1\nflow_back: 1\n\n"
      "max_solver_time: 0.04\nmax_num_iterations: 8\nkeyframe_parallax: 10.0\n\n"
      "# Discrete: deviations of a sample, that is densities times sqrt(rate); m/s^2, rad/s, and the walks' "
      "likewise.\n"
      "acc_n: {}\ngyr_n: {}\nacc_w: {}\ngyr_w: {}\ng_norm: {}\n\n"
      "# The stamps of images are exact (middle of the exposure).\nestimate_td: 0\ntd: 0.0\n\n"
      "load_previous_pose_graph: 0\npose_graph_save_path: \"/tmp/\"\nsave_image: 0\n",
      facts.names.imu, facts.names.image, c.width_px, c.height_px,
      matrix_text(imu.T_base_imu.inverse() * c.T_base_camera, "          "),
      real_text(per_sample(imu.accel_noise_mps2_rthz, imu.rate_hz)),
      real_text(per_sample(imu.gyro_noise_radps_rthz, imu.rate_hz)),
      real_text(per_sample(imu.accel_bias_walk_mps3_rthz, imu.rate_hz)),
      real_text(per_sample(imu.gyro_bias_walk_radps2_rthz, imu.rate_hz)), real_text(imu.gravity_mps2));
}

std::string camera_file(const CameraCalibration& c) {
  return fmt::format(
      "%YAML:1.0\n---\nmodel_type: PINHOLE\ncamera_name: camera\nimage_width: {}\nimage_height: {}\n"
      "distortion_parameters:\n   k1: {}\n   k2: {}\n   p1: {}\n   p2: {}\n"
      "projection_parameters:\n   fx: {}\n   fy: {}\n   cx: {}\n   cy: {}\n",
      c.width_px, c.height_px, real_text(c.k1), real_text(c.k2), real_text(c.p1), real_text(c.p2),
      real_text(c.fx_px), real_text(c.fy_px), real_text(c.cx_px), real_text(c.cy_px));
}

std::vector<ExtraFile> configuration(const DatasetFacts& facts) {
  return {{"vins_fusion/mono_imu_config.yaml", main_file(facts)},
          {"vins_fusion/cam0_pinhole.yaml", camera_file(facts.rig.camera)}};
}

std::string instructions(const DatasetFacts& facts) {
  return fmt::format(
      "    rosrun vins vins_node $PWD/vins_fusion/mono_imu_config.yaml\n"
      "    rosrun loop_fusion loop_fusion_node $PWD/vins_fusion/mono_imu_config.yaml    # optional\n"
      "    rosbag play {}.bag\n\n"
      "It writes `/tmp/vio.csv` (it neither makes folders nor knows `~`). One camera and an IMU need some "
      "excitation before scale is known; a robot that rests and then drives "
      "straight "
      "gives little. The pose is the IMU's; `truth.tum` is the base's, `T_base_imu` in `rig.yaml`.\n",
      facts.scenario.name);
}

}  // namespace

TargetSystem vins_fusion() {
  return {"vins-fusion", "VINS-Fusion", DatasetFormat::bag, true,
          false,         names(),       configuration,      instructions};
}

}  // namespace vsslam

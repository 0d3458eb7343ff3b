// LVI-SAM (Shan et al., ICRA 2021), github.com/TixiaoShan/LVI-SAM, ROS 1. Keys and conventions: its
// config/params_lidar.yaml, config/params_camera.yaml, src/lidar_odometry/utility.h, src/visual_odometry/visual_feature.
#include <fmt/format.h>

#include "scenarios/datasets/systems/configuration_text.h"
#include "scenarios/datasets/systems/loam_settings.h"
#include "scenarios/datasets/systems/target_configurations.h"

namespace vsslam {

namespace {

MessageNames names() {
  MessageNames names;
  names.points = "/points_raw";
  names.imu = "/imu_raw";
  names.lidar_frame = "base_link";
  return names;
}

std::string lidar_file(const DatasetFacts& facts) {
  return fmt::format(
             "# LVI-SAM's LiDAR parameters for this dataset: numbers of the simulated rig, settings as its "
             "authors ship "
             "them.\nPROJECT_NAME: \"lvi_sam\"\n\nlvi_sam:\n\n  pointCloudTopic: \"{}\"\n  imuTopic: "
             "\"{}\"\n\n"
             "  useImuHeadingInitialization: true\n\n  savePCD: false\n  savePCDDirectory: "
             "\"/Downloads/LOAM/\"\n\n",
             facts.names.points, facts.names.imu) +
         loam_sensor_settings(facts, ExtrinsicRpy::lidar_to_imu) + loam_mapping_settings(facts);
}

// Points go from the LiDAR into a frame in the camera that has the axes of a robot: x forward, y left, z up.
std::string lidar_to_camera(const DatasetFacts& facts) {
  const SE3 T_camera_forward(Quat(0.5, -0.5, 0.5, -0.5).conjugate(), Vec3::Zero());
  const SE3 T_base_forward = facts.rig.camera.T_base_camera * T_camera_forward;
  const SE3 T_forward_lidar = T_base_forward.inverse() * facts.rig.lidar.T_base_lidar;
  const Vec3 t = T_forward_lidar.translation, rpy_rad = T_forward_lidar.rpy();
  return fmt::format(
      "# Where the LiDAR is in the camera, with axes x forward, y left, z up: m, rad (roll, pitch, yaw).\n"
      "lidar_to_cam_tx: {}\nlidar_to_cam_ty: {}\nlidar_to_cam_tz: {}\n"
      "lidar_to_cam_rx: {}\nlidar_to_cam_ry: {}\nlidar_to_cam_rz: {}\n\n",
      real_text(t.x()), real_text(t.y()), real_text(t.z()), real_text(rpy_rad.x()), real_text(rpy_rad.y()),
      real_text(rpy_rad.z()));
}

std::string camera_model(const CameraCalibration& c) {
  return fmt::format(
      "model_type: PINHOLE\ncamera_name: camera\nimage_width: {}\nimage_height: {}\n"
      "distortion_parameters:\n   k1: {}\n   k2: {}\n   p1: {}\n   p2: {}\n"
      "projection_parameters:\n   fx: {}\n   fy: {}\n   cx: {}\n   cy: {}\n"
      "fisheye_mask: \"/config/fisheye_mask_720x540.jpg\"  # not used: fisheye is 0\n\n",
      c.width_px, c.height_px, real_text(c.k1), real_text(c.k2), real_text(c.p1), real_text(c.p2),
      real_text(c.fx_px), real_text(c.fy_px), real_text(c.cx_px), real_text(c.cy_px));
}

std::string imu_settings(const DatasetFacts& facts) {
  const ImuCalibration& imu = facts.rig.imu;
  const SE3 T_imu_camera = imu.T_base_imu.inverse() * facts.rig.camera.T_base_camera;
  return fmt::format(
      "# Discrete: deviations of a sample, that is densities times sqrt(rate); m/s^2, rad/s, and the walks' "
      "likewise.\n"
      "acc_n: {}\ngyr_n: {}\nacc_w: {}\ngyr_w: {}\ng_norm: {}\n\n"
      "# T_imu_camera, exact.\nestimate_extrinsic: 0\n"
      "extrinsicRotation: !!opencv-matrix\n   rows: 3\n   cols: 3\n   dt: d\n   data: [{}]\n"
      "extrinsicTranslation: !!opencv-matrix\n   rows: 3\n   cols: 1\n   dt: d\n   data: [{}]\n\n",
      real_text(per_sample(imu.accel_noise_mps2_rthz, imu.rate_hz)),
      real_text(per_sample(imu.gyro_noise_radps_rthz, imu.rate_hz)),
      real_text(per_sample(imu.accel_bias_walk_mps3_rthz, imu.rate_hz)),
      real_text(per_sample(imu.gyro_bias_walk_radps2_rthz, imu.rate_hz)), real_text(imu.gravity_mps2),
      matrix_text(T_imu_camera.matrix3(), "          "), vector_text(T_imu_camera.translation));
}

std::string camera_file(const DatasetFacts& facts) {
  return fmt::format(
             "%YAML:1.0\n\n# LVI-SAM's camera parameters for this dataset: numbers of the simulated rig, "
             "settings as its "
             "authors ship them.\nproject_name: \"lvi_sam\"\n\nimu_topic: \"{}\"\nimage_topic: \"{}\"\n"
             "point_cloud_topic: \"lvi_sam/lidar/deskew/cloud_deskewed\"\n\n"
             "use_lidar: 1\nlidar_skip: 3\nalign_camera_lidar_estimation: 1\n\n",
             facts.names.imu, facts.names.image) +
         lidar_to_camera(facts) + camera_model(facts.rig.camera) + imu_settings(facts) +
         "max_cnt: 150\nmin_dist: 20\nfreq: 20\nF_threshold: 1.0\nshow_track: 1\nequalize: 1\nfisheye: 0\n\n"
         "max_solver_time: 0.035\nmax_num_iterations: 10\nkeyframe_parallax: 10.0\n\n"
         "# The stamps of images are exact (middle of the exposure), the shutter is global.\n"
         "estimate_td: 0\ntd: 0\nrolling_shutter: 0\nrolling_shutter_tr: 0\n\n"
         "loop_closure: 1\nskip_time: 0.0\nskip_dist: 0.0\ndebug_image: 0\nmatch_image_scale: 0.5\n"
         "vocabulary_file: \"/config/brief_k10L6.bin\"\nbrief_pattern_file: \"/config/brief_pattern.yml\"\n";
}

std::vector<ExtraFile> configuration(const DatasetFacts& facts) {
  return {{"lvi_sam/params_lidar.yaml", lidar_file(facts)},
          {"lvi_sam/params_camera.yaml", camera_file(facts)}};
}

std::string instructions(const DatasetFacts& facts) {
  return fmt::format(
      "Put the two files of `lvi_sam/` in the place of those in `config/` of the package `lvi_sam` and "
      "start\n\n"
      "    roslaunch lvi_sam run.launch\n"
      "    rosbag play {}.bag\n\n"
      "Its visual half takes for granted that the IMU is mounted as its authors' is, x back, y left, z down, "
      "and so it is in "
      "this dataset. Its pose is the LiDAR's, `truth.tum` is the base's.\n",
      facts.scenario.name);
}

}  // namespace

TargetSystem lvi_sam() {
  // q_lidar_to_cam in its visual_estimator/initial/initial_alignment.h is a number.
  const Vec3 imu_rpy_deg(0, 180, 0);
  return {"lvi-sam", "LVI-SAM",     DatasetFormat::bag, true,       true,
          names(),   configuration, instructions,       imu_rpy_deg};
}

}  // namespace vsslam

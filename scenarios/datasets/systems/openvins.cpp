// OpenVINS (Geneva et al., ICRA 2020), github.com/rpng/open_vins. Keys and conventions: its config/euroc_mav/*.yaml.
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

std::string imu_chain(const DatasetFacts& facts) {
  const ImuCalibration& imu = facts.rig.imu;
  constexpr const char* kIdentity = "    - [1.0, 0.0, 0.0]\n    - [0.0, 1.0, 0.0]\n    - [0.0, 0.0, 1.0]\n";
  return fmt::format(
      "%YAML:1.0\n\nimu0:\n  T_i_b:\n{}"
      "  # Continuous-time densities.\n"
      "  accelerometer_noise_density: {}  # m/s^2/sqrt(Hz)\n  accelerometer_random_walk: {}    # "
      "m/s^3/sqrt(Hz)\n"
      "  gyroscope_noise_density: {}      # rad/s/sqrt(Hz)\n  gyroscope_random_walk: {}        # "
      "rad/s^2/sqrt(Hz)\n"
      "  rostopic: {}\n  time_offset: 0.0\n  update_rate: {}\n  model: \"kalibr\"\n"
      "  Tw:\n{}  R_IMUtoGYRO:\n{}  Ta:\n{}  R_IMUtoACC:\n{}"
      "  Tg:\n    - [0.0, 0.0, 0.0]\n    - [0.0, 0.0, 0.0]\n    - [0.0, 0.0, 0.0]\n",
      kalibr_rows(SE3(), "    "), real_text(imu.accel_noise_mps2_rthz),
      real_text(imu.accel_bias_walk_mps3_rthz), real_text(imu.gyro_noise_radps_rthz),
      real_text(imu.gyro_bias_walk_radps2_rthz), facts.names.imu, real_text(imu.rate_hz), kIdentity,
      kIdentity, kIdentity, kIdentity);
}

std::string camera_chain(const DatasetFacts& facts) {
  const CameraCalibration& c = facts.rig.camera;
  return fmt::format(
      "%YAML:1.0\n\ncam0:\n"
      "  # Camera coordinates to IMU coordinates.\n  T_imu_cam:\n{}"
      "  cam_overlaps: []\n  camera_model: pinhole\n  distortion_model: radtan\n"
      "  distortion_coeffs: [{}, {}, {}, {}]\n  intrinsics: [{}, {}, {}, {}]\n  resolution: [{}, {}]\n"
      "  rostopic: {}\n  timeshift_cam_imu: 0.0\n",
      kalibr_rows(facts.rig.imu.T_base_imu.inverse() * c.T_base_camera, "    "), real_text(c.k1),
      real_text(c.k2), real_text(c.p1), real_text(c.p2), real_text(c.fx_px), real_text(c.fy_px),
      real_text(c.cx_px), real_text(c.cy_px), c.width_px, c.height_px, facts.names.image);
}

std::string estimator(const DatasetFacts& facts) {
  return fmt::format(
      "%YAML:1.0\n\nverbosity: \"INFO\"\nuse_fej: true\n"
      "integration: \"rk4\"\nuse_imuavg: true\nuse_rk4int: true # how 2.6 and before ask for it\n"
      "use_stereo: false\nmax_cameras: 1\n\n"
      "# The calibration is exact.\n"
      "calib_cam_extrinsics: false\ncalib_cam_intrinsics: false\ncalib_cam_timeoffset: false\n"
      "calib_imu_intrinsics: false\ncalib_imu_g_sensitivity: false\n\n"
      "max_clones: 11\nmax_slam: 50\nmax_slam_in_update: 25\nmax_msckf_in_update: 40\ndt_slam_delay: 1\n\n"
      "gravity_mag: {}\n\nfeat_rep_msckf: \"GLOBAL_3D\"\nfeat_rep_slam: \"ANCHORED_MSCKF_INVERSE_DEPTH\"\n"
      "feat_rep_aruco: \"ANCHORED_MSCKF_INVERSE_DEPTH\"\n\n"
      "# A robot on wheels stands still now and then.\n"
      "try_zupt: true\nzupt_chi2_multipler: 0\nzupt_max_velocity: 0.1\nzupt_noise_multiplier: 10\n"
      "zupt_max_disparity: 0.5\nzupt_only_at_beginning: false\n\n"
      "# It starts at rest and gently: at 0.8 m/s^2, less than a hand or a drone would.\n"
      "init_window_time: 2.0\ninit_imu_thresh: 0.15\ninit_max_disparity: 10.0\ninit_max_features: 75\n"
      "init_dyn_use: false\ninit_dyn_mle_opt_calib: false\ninit_dyn_mle_max_iter: 50\ninit_dyn_mle_max_time: "
      "0.05\n"
      "init_dyn_mle_max_threads: 6\ninit_dyn_num_pose: 6\ninit_dyn_min_deg: 10.0\ninit_dyn_inflation_ori: "
      "10\n"
      "init_dyn_inflation_vel: 100\ninit_dyn_inflation_bg: 10\ninit_dyn_inflation_ba: 100\n"
      "init_dyn_min_rec_cond: 1.0e-12\ninit_dyn_bias_g: [0.0, 0.0, 0.0]\ninit_dyn_bias_a: [0.0, 0.0, 0.0]\n\n"
      "record_timing_information: false\nrecord_timing_filepath: \"/tmp/traj_timing.txt\"\nsave_total_state: "
      "false\n"
      "filepath_est: \"/tmp/ov_estimate.txt\"\nfilepath_std: \"/tmp/ov_estimate_std.txt\"\n"
      "filepath_gt: \"/tmp/ov_groundtruth.txt\"\n\n"
      "use_klt: true\nnum_pts: 200\nfast_threshold: 20\ngrid_x: 5\ngrid_y: 5\nmin_px_dist: 10\nknn_ratio: "
      "0.70\n"
      "track_frequency: {}\ndownsample_cameras: false\nnum_opencv_threads: 4\nhistogram_method: "
      "\"HISTOGRAM\"\n\n"
      "use_aruco: false\nnum_aruco: 1024\ndownsize_aruco: true\n\n"
      "up_msckf_sigma_px: 1\nup_msckf_chi2_multipler: 1\nup_slam_sigma_px: 1\nup_slam_chi2_multipler: 1\n"
      "up_aruco_sigma_px: 1\nup_aruco_chi2_multipler: 1\n\nuse_mask: false\n\n"
      "relative_config_imu: \"kalibr_imu_chain.yaml\"\nrelative_config_imucam: "
      "\"kalibr_imucam_chain.yaml\"\n",
      real_text(facts.rig.imu.gravity_mps2), real_text(facts.rig.camera.rate_hz + 1));
}

std::vector<ExtraFile> configuration(const DatasetFacts& facts) {
  return {{"openvins/estimator_config.yaml", estimator(facts)},
          {"openvins/kalibr_imu_chain.yaml", imu_chain(facts)},
          {"openvins/kalibr_imucam_chain.yaml", camera_chain(facts)}};
}

std::string instructions(const DatasetFacts& facts) {
  return fmt::format(
      "    roslaunch ov_msckf serial.launch config_path:=$PWD/openvins/estimator_config.yaml "
      "bag:=$PWD/{}.bag "
      "bag_start:=0 max_cameras:=1 use_stereo:=false\n\n"
      "or `subscribe.launch` with the same `config_path` and `rosbag play`. The pose is the IMU's; "
      "`truth.tum` is the "
      "base's, `T_base_imu` in `rig.yaml`.\n",
      facts.scenario.name);
}

}  // namespace

TargetSystem openvins() {
  return {"openvins", "OpenVINS", DatasetFormat::bag, true, false, names(), configuration, instructions};
}

}  // namespace vsslam

// ORB-SLAM3 (Campos et al., T-RO 2021), github.com/UZ-SLAMLab/ORB_SLAM3. Keys and conventions: its
// Examples/Monocular-Inertial/EuRoC.yaml and mono_inertial_euroc.cc.
#include <fmt/format.h>

#include "scenarios/datasets/systems/configuration_text.h"
#include "scenarios/datasets/systems/target_configurations.h"

namespace vsslam {

namespace {

std::string camera_settings(const CameraCalibration& c) {
  return fmt::format(
      "Camera.type: \"PinHole\"\nCamera1.fx: {}\nCamera1.fy: {}\nCamera1.cx: {}\nCamera1.cy: {}\n"
      "Camera1.k1: {}\nCamera1.k2: {}\nCamera1.p1: {}\nCamera1.p2: {}\n"
      "Camera.width: {}\nCamera.height: {}\nCamera.fps: {:.0f}\nCamera.RGB: 1\n\n",
      real_text(c.fx_px), real_text(c.fy_px), real_text(c.cx_px), real_text(c.cy_px), real_text(c.k1),
      real_text(c.k2), real_text(c.p1), real_text(c.p2), c.width_px, c.height_px, c.rate_hz);
}

std::string imu_settings(const DatasetFacts& facts) {
  const ImuCalibration& imu = facts.rig.imu;
  return fmt::format(
      "# T_imu_camera: camera coordinates to IMU coordinates.\n"
      "IMU.T_b_c1: !!opencv-matrix\n   rows: 4\n   cols: 4\n   dt: f\n   data: [{}]\n\n"
      "# Continuous-time densities; it makes them discrete itself.\n"
      "IMU.NoiseGyro: {}  # rad/s/sqrt(Hz)\nIMU.NoiseAcc: {}  # m/s^2/sqrt(Hz)\n"
      "IMU.GyroWalk: {}  # rad/s^2/sqrt(Hz)\nIMU.AccWalk: {}  # m/s^3/sqrt(Hz)\nIMU.Frequency: {}\n\n",
      matrix_text(imu.T_base_imu.inverse() * facts.rig.camera.T_base_camera, "          "),
      real_text(imu.gyro_noise_radps_rthz), real_text(imu.accel_noise_mps2_rthz),
      real_text(imu.gyro_bias_walk_radps2_rthz), real_text(imu.accel_bias_walk_mps3_rthz),
      real_text(imu.rate_hz));
}

std::vector<ExtraFile> configuration(const DatasetFacts& facts) {
  const std::string text =
      "%YAML:1.0\n\n# ORB-SLAM3's settings for this dataset: numbers of the simulated rig, the rest as its "
      "authors ship "
      "it.\nFile.version: \"1.0\"\n\n" +
      camera_settings(facts.rig.camera) + imu_settings(facts) +
      "ORBextractor.nFeatures: 1000\nORBextractor.scaleFactor: 1.2\nORBextractor.nLevels: 8\n"
      "ORBextractor.iniThFAST: 20\nORBextractor.minThFAST: 7\n\n"
      "Viewer.KeyFrameSize: 0.05\nViewer.KeyFrameLineWidth: 1.0\nViewer.GraphLineWidth: "
      "0.9\nViewer.PointSize: 2.0\n"
      "Viewer.CameraSize: 0.08\nViewer.CameraLineWidth: 3.0\nViewer.ViewpointX: 0.0\nViewer.ViewpointY: "
      "-0.7\n"
      "Viewer.ViewpointZ: -3.5\nViewer.ViewpointF: 500.0\n";
  return {{"orb_slam3/settings.yaml", text}};
}

std::string instructions(const DatasetFacts& facts) {
  return fmt::format(
      "From the folder of ORB-SLAM3, with this folder as `$DATASET`:\n\n"
      "    ./Examples/Monocular-Inertial/mono_inertial_euroc Vocabulary/ORBvoc.txt "
      "$DATASET/orb_slam3/settings.yaml "
      "$DATASET $DATASET/mav0/cam0/times.txt {}\n\n"
      "`mav0/cam0/times.txt` lists the images, one stamp in ns a line; there is IMU data before the first "
      "and after the "
      "last of them. The pose is the IMU's; `mav0/state_groundtruth_estimate0` is too, `truth.tum` is the "
      "base's. "
      "`./vsslam evaluate` takes its "
      "trajectory with stamps in ns as it is. Monocular-inertial initialisation needs motion that a robot on "
      "a plane hardly makes.\n",
      facts.scenario.name);
}

}  // namespace

TargetSystem orb_slam3() {
  return {"orb-slam3", "ORB-SLAM3", DatasetFormat::euroc, true, false, {}, configuration, instructions};
}

}  // namespace vsslam

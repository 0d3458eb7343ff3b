#include <numbers>

#include "sensors/rig.h"

namespace vsslam {

SE3 MountConfig::T_base_sensor() const {
  return SE3::from_rpy(rpy_deg * (std::numbers::pi / 180), position_m);
}

void MountConfig::fields(Fields& f) {
  f("position_m", position_m, between(-10, 10));
  f("rpy_deg", rpy_deg, between(-360, 360));
}

void RigConfig::Sensors::fields(Fields& f) {
  f("lidar", lidar);
  f("imu", imu);
  f("wheels", wheels);
  f("camera", camera);
}

void RigConfig::Mounts::fields(Fields& f) {
  f("lidar", lidar);
  f("imu", imu);
  f("camera", camera);
}

void RigConfig::fields(Fields& f) {
  f.base("rigs", *this);
  f("sensors", sensors);
  f("mounts", mounts);
}

RigCalibration RigConfig::calibration(double wheel_radius_m, double effective_track_m,
                                      double base_height_m) const {
  RigCalibration calibration;
  LidarCalibration& lidar = calibration.lidar;
  lidar.T_base_lidar = mounts.lidar.T_base_sensor();
  lidar.rings = static_cast<int>(laser_table(sensors.lidar.model).lasers.size());
  lidar.mount_height_m = base_height_m + mounts.lidar.position_m.z();
  lidar.min_range_m = sensors.lidar.min_range_m;
  lidar.max_range_m = sensors.lidar.max_range_m;
  lidar.range_sigma_m = sensors.lidar.range_sigma_m;
  ImuCalibration& imu = calibration.imu;
  imu.T_base_imu = mounts.imu.T_base_sensor();
  imu.rate_hz = sensors.imu.rate_hz;
  imu.gyro_noise_radps_rthz = sensors.imu.gyro_noise_radps_rthz;
  imu.accel_noise_mps2_rthz = sensors.imu.accel_noise_mps2_rthz;
  imu.gyro_bias_walk_radps2_rthz = sensors.imu.gyro_bias_walk_radps2_rthz;
  imu.accel_bias_walk_mps3_rthz = sensors.imu.accel_bias_walk_mps3_rthz;
  calibration.wheels.wheel_radius_m = wheel_radius_m;
  calibration.wheels.effective_track_m = effective_track_m;
  CameraCalibration& camera = calibration.camera;
  const CameraConfig& c = sensors.camera;
  camera.T_base_camera = mounts.camera.T_base_sensor();
  camera.width_px = c.width_px;
  camera.height_px = c.height_px;
  camera.fx_px = c.fx_px;
  camera.fy_px = c.fy_px;
  camera.cx_px = c.cx_px;
  camera.cy_px = c.cy_px;
  camera.k1 = c.k1;
  camera.k2 = c.k2;
  camera.p1 = c.p1;
  camera.p2 = c.p2;
  camera.rate_hz = c.rate_hz;
  return calibration;
}

}  // namespace vsslam

#include "scenarios/datasets/facts/rig_sheet.h"

#include <cmath>
#include <numbers>
#include <optional>

namespace vsslam {

namespace {

struct UnitQuaternion {
  double w = 1, x = 0, y = 0, z = 0;
  void fields(Fields& f) {
    f("w", w, between(-1, 1));
    f("x", x, between(-1, 1));
    f("y", y, between(-1, 1));
    f("z", z, between(-1, 1));
  }
  double squared_norm() const { return w * w + x * x + y * y + z * z; }
};

// Where a sensor sits in the base frame. Saved with a quaternion, which keeps the rotation to the bit; a person may
// write rpy_deg instead.
struct Mount {
  SE3& T_base_sensor;

  void fields(Fields& f) {
    std::optional<UnitQuaternion> quaternion;
    std::optional<Vec3> rpy_deg;
    const Quat& q = T_base_sensor.rotation;
    if (!f.loading()) quaternion = UnitQuaternion{q.w(), q.x(), q.y(), q.z()};
    f("position_m", T_base_sensor.translation, between(-100, 100));
    f("quaternion", quaternion);
    f("rpy_deg", rpy_deg);
    f.check(!(quaternion && rpy_deg), "rpy_deg", "only one of quaternion and rpy_deg");
    f.check(!quaternion || std::abs(quaternion->squared_norm() - 1) < 1e-3, "quaternion", "unit length");
    if (rpy_deg)
      T_base_sensor = SE3::from_rpy(*rpy_deg * (std::numbers::pi / 180), T_base_sensor.translation);
    if (quaternion) set_rotation(*quaternion);
  }

 private:
  void set_rotation(const UnitQuaternion& q) {
    T_base_sensor.rotation = Quat(q.w, q.x, q.y, q.z);
    if (std::abs(q.squared_norm() - 1) > 1e-12) T_base_sensor.rotation.normalize();
  }
};

void mount(Fields& f, const char* key, SE3& T_base_sensor) {
  Mount sheet{T_base_sensor};
  f(key, sheet);
}

struct LidarSheet {
  LidarCalibration& lidar;
  void fields(Fields& f) {
    mount(f, "T_base_lidar", lidar.T_base_lidar);
    f("rings", lidar.rings, between(1, 256));
    f("mount_height_m", lidar.mount_height_m, between(0, 100));
    f("min_range_m", lidar.min_range_m, non_negative());
    f("max_range_m", lidar.max_range_m, positive());
    f("range_sigma_m", lidar.range_sigma_m, non_negative());
    f.check(lidar.max_range_m > lidar.min_range_m, "max_range_m", "more than min_range_m");
  }
};

struct ImuSheet {
  ImuCalibration& imu;
  void fields(Fields& f) {
    mount(f, "T_base_imu", imu.T_base_imu);
    f("rate_hz", imu.rate_hz, positive());
    f("gyro_noise_radps_rthz", imu.gyro_noise_radps_rthz, non_negative());
    f("accel_noise_mps2_rthz", imu.accel_noise_mps2_rthz, non_negative());
    f("gyro_bias_walk_radps2_rthz", imu.gyro_bias_walk_radps2_rthz, non_negative());
    f("accel_bias_walk_mps3_rthz", imu.accel_bias_walk_mps3_rthz, non_negative());
    f("gravity_mps2", imu.gravity_mps2, positive());
  }
};

struct WheelSheet {
  WheelCalibration& wheels;
  void fields(Fields& f) {
    f("wheel_radius_m", wheels.wheel_radius_m, positive());
    f("effective_track_m", wheels.effective_track_m, positive());
  }
};

struct CameraSheet {
  CameraCalibration& camera;
  void fields(Fields& f) {
    mount(f, "T_base_camera", camera.T_base_camera);
    f("width_px", camera.width_px, between(1, 16384));
    f("height_px", camera.height_px, between(1, 16384));
    f("fx_px", camera.fx_px, positive());
    f("fy_px", camera.fy_px, positive());
    f("cx_px", camera.cx_px);
    f("cy_px", camera.cy_px);
    f("k1", camera.k1);
    f("k2", camera.k2);
    f("p1", camera.p1);
    f("p2", camera.p2);
    f("rate_hz", camera.rate_hz, positive());
  }
};

}  // namespace

void RecordingTopics::fields(Fields& f) {
  f("lidar", lidar);
  f("imu", imu);
  f("camera", camera);
  f("wheels", wheels);
  f("truth", truth);
}

void RigSheet::fields(Fields& f) {
  f.base("sheets", *this);
  f("topics", topics);
  LidarSheet lidar_sheet{calibration.lidar};
  ImuSheet imu_sheet{calibration.imu};
  WheelSheet wheel_sheet{calibration.wheels};
  CameraSheet camera_sheet{calibration.camera};
  f("lidar", lidar_sheet);
  f("imu", imu_sheet);
  f("wheels", wheel_sheet);
  f("camera", camera_sheet);
}

}  // namespace vsslam

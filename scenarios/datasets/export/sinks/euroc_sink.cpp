#include "scenarios/datasets/export/sinks/euroc_sink.h"

#include <fmt/format.h>

#include "scenarios/datasets/systems/configuration_text.h"

namespace vsslam {

namespace fs = std::filesystem;

namespace {

std::string matrix_yaml(const SE3& T) {
  return fmt::format("T_BS:\n  cols: 4\n  rows: 4\n  data: [{}]\n", matrix_text(T, "         "));
}

std::string camera_yaml(const RigCalibration& rig) {
  const CameraCalibration& c = rig.camera;
  return "# The body is the IMU: T_BS maps camera coordinates to IMU coordinates.\nsensor_type: camera\n"
         "comment: simulated grey camera, global shutter\n" +
         matrix_yaml(rig.imu.T_base_imu.inverse() * c.T_base_camera) +
         fmt::format(
             "rate_hz: {}\nresolution: [{}, {}]\ncamera_model: pinhole\n"
             "intrinsics: [{}, {}, {}, {}]  # fu, fv, cu, cv (px)\ndistortion_model: radial-tangential\n"
             "distortion_coefficients: [{}, {}, {}, {}]\n",
             real_text(c.rate_hz), c.width_px, c.height_px, real_text(c.fx_px), real_text(c.fy_px),
             real_text(c.cx_px), real_text(c.cy_px), real_text(c.k1), real_text(c.k2), real_text(c.p1),
             real_text(c.p2));
}

std::string imu_yaml(const ImuCalibration& imu) {
  return "sensor_type: imu\ncomment: simulated IMU\n" + matrix_yaml(SE3()) +
         fmt::format(
             "rate_hz: {}\n# Continuous-time densities.\ngyroscope_noise_density: {}  # rad/s/sqrt(Hz)\n"
             "gyroscope_random_walk: {}  # rad/s^2/sqrt(Hz)\naccelerometer_noise_density: {}  # "
             "m/s^2/sqrt(Hz)\n"
             "accelerometer_random_walk: {}  # m/s^3/sqrt(Hz)\n",
             real_text(imu.rate_hz), real_text(imu.gyro_noise_radps_rthz),
             real_text(imu.gyro_bias_walk_radps2_rthz), real_text(imu.accel_noise_mps2_rthz),
             real_text(imu.accel_bias_walk_mps3_rthz));
}

std::string row(const Vec3& v) {
  return fmt::format(",{},{},{}", v.x(), v.y(), v.z());
}

}  // namespace

EurocSink::EurocSink(const DatasetFacts& facts)
    : root_(facts.folder / "mav0"),
      camera_(facts.has_camera()),
      T_base_imu_(facts.rig.imu.T_base_imu),
      imu_table_(root_ / "imu0" / "data.csv"),
      truth_table_(root_ / "state_groundtruth_estimate0" / "data.csv") {
  imu_table_.write(
      "#timestamp [ns],w_RS_S_x [rad s^-1],w_RS_S_y [rad s^-1],w_RS_S_z [rad s^-1],"
      "a_RS_S_x [m s^-2],a_RS_S_y [m s^-2],a_RS_S_z [m s^-2]\n");
  truth_table_.write(
      "#timestamp,p_RS_R_x [m],p_RS_R_y [m],p_RS_R_z [m],q_RS_w [],q_RS_x [],q_RS_y [],q_RS_z [],"
      "v_RS_R_x [m s^-1],v_RS_R_y [m s^-1],v_RS_R_z [m s^-1],"
      "b_w_RS_S_x [rad s^-1],b_w_RS_S_y [rad s^-1],b_w_RS_S_z [rad s^-1],"
      "b_a_RS_S_x [m s^-2],b_a_RS_S_y [m s^-2],b_a_RS_S_z [m s^-2]\n");
  if (camera_) {
    image_table_.emplace(root_ / "cam0" / "data.csv");
    image_table_->write("#timestamp [ns],filename\n");
    times_.emplace(root_ / "cam0" / "times.txt");
    fs::create_directories(root_ / "cam0" / "data");
  }
  write_sensor_files(facts);
}

void EurocSink::write_sensor_files(const DatasetFacts& facts) const {
  write_file(root_ / "body.yaml", "comment: AgileX Scout 2.0, simulated; the body frame is the IMU's\n");
  write_file(root_ / "imu0" / "sensor.yaml", imu_yaml(facts.rig.imu));
  if (camera_) write_file(root_ / "cam0" / "sensor.yaml", camera_yaml(facts.rig));
  write_file(root_ / "state_groundtruth_estimate0" / "sensor.yaml",
             "sensor_type: visual-inertial\ncomment: exact truth of the IMU in the world, its velocity and "
             "biases\n" +
                 matrix_yaml(SE3()));
}

fs::path EurocSink::image_file(Time stamp) const {
  return root_ / "cam0" / "data" / fmt::format("{}.png", dataset_time(stamp).ns);
}

bool EurocSink::needs_image(Time stamp) const {
  return camera_ && !fs::exists(image_file(stamp));
}

void EurocSink::write(const DatasetSample& sample) {
  if (const auto* imu = std::get_if<ImuMeasurement>(&sample.measurement)) {
    write(*imu, sample.base);
    release_images(imu->sample.stamp);
  } else if (const auto* camera = std::get_if<CameraMeasurement>(&sample.measurement)) {
    if (camera_ && first_imu_ && camera->frame.stamp >= *first_imu_)
      waiting_.push_back({camera->frame.stamp, sample.png});
  }
}

// v_RS_R: velocity of the IMU's origin in the world frame.
void EurocSink::write(const ImuMeasurement& imu, const Kinematics& base) {
  if (!first_imu_) first_imu_ = imu.sample.stamp;
  const int64_t ns = dataset_time(imu.sample.stamp).ns;
  imu_table_.write(fmt::format("{}{}{}\n", ns, row(imu.sample.gyro_radps), row(imu.sample.accel_mps2)));
  const SE3 T_world_imu = base.T_world_base * T_base_imu_;
  const Quat q = T_world_imu.rotation;
  const Vec3 v_world =
      base.v_world + base.T_world_base.rotation * base.omega_base.cross(T_base_imu_.translation);
  truth_table_.write(fmt::format("{}{},{},{},{},{}{}{}{}\n", ns, row(T_world_imu.translation), q.w(), q.x(),
                                 q.y(), q.z(), row(v_world), row(imu.gyro_bias_radps),
                                 row(imu.accel_bias_mps2)));
}

void EurocSink::release_images(Time before) {
  for (; !waiting_.empty() && waiting_.front().stamp < before; waiting_.pop_front()) {
    const WaitingImage& image = waiting_.front();
    const fs::path file = image_file(image.stamp);
    image_table_->write(fmt::format("{},{}\n", dataset_time(image.stamp).ns, file.filename().string()));
    times_->write(fmt::format("{}\n", dataset_time(image.stamp).ns));
    if (!fs::exists(file)) write_file(file, image.png);
  }
}

void EurocSink::finish() {
  imu_table_.commit();
  truth_table_.commit();
  if (image_table_) image_table_->commit();
  if (times_) times_->commit();
}

}  // namespace vsslam

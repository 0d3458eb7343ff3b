#include "scenarios/health/health.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

namespace vsslam {

namespace {

using Json = nlohmann::ordered_json;

Json number(const std::optional<double>& value) {
  return value && std::isfinite(*value) ? Json(*value) : Json(nullptr);
}

Json sensor_json(const SensorHealth& sensor) {
  Json dropped = Json::object();
  for (const auto& [reason, count] : sensor.dropped) dropped[reason] = count;
  return {{"used", sensor.used},
          {"dropped", dropped},
          {"rate_hz", number(sensor.rate_hz)},
          {"share_of_time", number(sensor.share_of_time)},
          {"longest_gap_s", number(sensor.longest_gap_s)},
          {"longest_gap_at_s", number(sensor.longest_gap_at_s)}};
}

Json imu_json(const ImuHealth& imu) {
  Json json = sensor_json(imu);
  json["gravity_mps2"] = number(imu.gravity_mps2);
  json["gravity_tilt_deg"] = number(imu.gravity_tilt_deg);
  json["gravity_at_rest"] = imu.gravity_at_rest;
  json["gyro_scale"] = number(imu.gyro_scale);
  json["gyro_correlation"] = number(imu.gyro_correlation);
  for (const auto& scale : imu.gyro_axis_scale) json["gyro_axis_scale"].push_back(number(scale));
  return json;
}

Json wheels_json(const WheelsHealth& wheels) {
  Json json = sensor_json(wheels);
  json["travel_scale"] = number(wheels.travel_scale);
  json["yaw_scale"] = number(wheels.yaw_scale);
  return json;
}

Json lidar_json(const LidarHealth& lidar) {
  Json json = sensor_json(lidar);
  json["points_mean"] = number(lidar.points_mean);
  json["without_points"] = lidar.without_points;
  return json;
}

Json camera_json(const CameraHealth& camera) {
  Json json = sensor_json(camera);
  json["grey_mean"] = number(camera.grey_mean);
  json["dark"] = camera.dark;
  json["frozen"] = camera.frozen;
  return json;
}

Json lost_json(const std::vector<OdometryHealth::LostSpan>& spans, Duration stamp_offset) {
  Json list = Json::array();
  for (const OdometryHealth::LostSpan& span : spans)
    list.push_back({{"begin_s", (span.begin + stamp_offset).seconds()},
                    {"end_s", (span.end + stamp_offset).seconds()},
                    {"scans", span.scans},
                    {"why", span.why}});
  return list;
}

}  // namespace

int64_t SensorHealth::dropped_count() const {
  int64_t sum = 0;
  for (const auto& [reason, count] : dropped) sum += count;
  return sum;
}

double Health::blind_share() const {
  return odometry.scans == 0
             ? 0
             : static_cast<double>(odometry.scans_prior_only) / static_cast<double>(odometry.scans);
}

std::string Health::verdict() const {
  if (!worthless.empty()) return "worthless";
  if (warnings.empty()) return "ok";
  return fmt::format("{} warning{}", warnings.size(), warnings.size() == 1 ? "" : "s");
}

Json imu_noise_json(const std::optional<Eigen::Vector2d>& noise) {
  if (!noise) return nullptr;
  return {{"gyro_radps_rthz", noise->x()}, {"accel_mps2_rthz", noise->y()}};
}

Json health_json(const Health& health, Duration stamp_offset) {
  Json sensors = Json::object();
  if (health.imu.present()) sensors["imu"] = imu_json(health.imu);
  if (health.wheels.present()) sensors["wheels"] = wheels_json(health.wheels);
  if (health.lidar.present()) sensors["lidar"] = lidar_json(health.lidar);
  if (health.camera.present()) sensors["camera"] = camera_json(health.camera);
  return {{"sensors", sensors},
          {"range_sigma_m", health.odometry.range_sigma_m},
          {"voxel_m", health.odometry.voxel_m},
          {"imu_noise", imu_noise_json(health.odometry.imu_noise)},
          {"scans_prior_only", health.odometry.scans_prior_only},
          {"scans_blind", health.odometry.scans_blind},
          {"steps", health.odometry.steps},
          {"steps_unsure", health.odometry.steps_unsure},
          {"worst_step_sigma_m", health.odometry.worst_step_sigma_m},
          {"scans_unconverged", health.odometry.scans_unconverged},
          {"prior_refused", health.odometry.prior_refused},
          {"wheels_slipped", health.odometry.wheels_slipped},
          {"imu_repaired", health.odometry.imu_repaired},
          {"lost_spans", lost_json(health.odometry.lost, stamp_offset)},
          {"repairs", health.repairs},
          {"warnings", health.warnings},
          {"worthless", health.worthless.empty() ? Json(nullptr) : Json(health.worthless)}};
}

std::string health_text(const Health& health) {
  std::string text;
  for (const std::string& repair : health.odometry.repairs) text += fmt::format("repaired: {}\n", repair);
  for (const std::string& warning : health.warnings) text += fmt::format("warning: {}\n", warning);
  if (!health.worthless.empty()) text += fmt::format("WORTHLESS: {}\n", health.worthless);
  return text;
}

}  // namespace vsslam

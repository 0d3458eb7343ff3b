#include "scenarios/experiment/handed.h"

namespace vsslam {

void HandedConfig::fields(Fields& f) {
  f("from_s", from_s, non_negative());
  f("every_nth_scan", every_nth_scan, at_least(1));
  f("scans", scans);
}

Time stamp_of(const Measurement& measurement) {
  if (const auto* imu = std::get_if<ImuMeasurement>(&measurement)) return imu->sample.stamp;
  if (const auto* wheels = std::get_if<WheelMeasurement>(&measurement)) return wheels->sample.stamp;
  if (const auto* camera = std::get_if<CameraMeasurement>(&measurement)) return camera->frame.stamp;
  return std::get<LidarMeasurement>(measurement).scan.stamp;
}

}  // namespace vsslam

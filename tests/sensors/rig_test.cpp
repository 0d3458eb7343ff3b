#include "sensors/rig.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "tests/sensors/shapes.h"

namespace vsslam {
namespace {

WheelState rolling(Time stamp) {
  WheelState state;
  state.left_rad = 3 * stamp.seconds();
  state.right_rad = 3.5 * stamp.seconds();
  return state;
}

/// Everything that a measurement says, for comparing with ==.
std::string describe(const Measurement& measurement) {
  std::string bytes(1, static_cast<char>('0' + measurement.index()));
  const auto put = [&](const auto& value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof(value));
  };
  if (const auto* imu = std::get_if<ImuMeasurement>(&measurement)) {
    put(imu->sample.stamp.ns);
    for (int i = 0; i < 3; ++i) put(imu->sample.gyro_radps[i]), put(imu->sample.accel_mps2[i]);
    for (int i = 0; i < 3; ++i) put(imu->gyro_bias_radps[i]), put(imu->accel_bias_mps2[i]);
    for (int i = 0; i < 4; ++i) put(imu->sample.q_earth_imu->coeffs()[i]);
  } else if (const auto* wheels = std::get_if<WheelMeasurement>(&measurement)) {
    put(wheels->sample.stamp.ns), put(wheels->sample.left_rad), put(wheels->sample.right_rad);
  } else if (const auto* lidar = std::get_if<LidarMeasurement>(&measurement)) {
    put(lidar->scan.stamp.ns), put(lidar->scan.end.ns);
    for (const LidarPoint& p : lidar->scan.points)
      put(p.x), put(p.y), put(p.z), put(p.intensity), put(p.ring), put(p.time_s);
    for (const PointTruth& t : lidar->truth)
      put(t.position_lidar), put(t.range_m), put(t.object), put(t.triangle);
  }
  return bytes;
}

std::string run(int64_t step_ns, double duration_s, uint64_t seed = 3) {
  const World world = shapes::room_world({-6, -5, -1}, {7, 6, 2});
  const Trajectory trajectory = shapes::along(shapes::lively, duration_s);
  Rig rig(world, RigConfig{}, SensorEvents{}, seed);
  std::string all;
  const Time end = Time::from_seconds(duration_s);
  for (Time t{0}; t < end; t = t + Duration{step_ns})
    rig.advance(std::min(end, t + Duration{step_ns}), trajectory, rolling,
                [&](Measurement&& m) { all += describe(m); });
  return all;
}

TEST(Rig, ChunksDoNotShow) {
  const std::string whole = run(1'000'000'000, 1.0);
  EXPECT_GT(whole.size(), 1000000u);
  EXPECT_TRUE(whole == run(7'000'000, 1.0));
  EXPECT_FALSE(whole == run(7'000'000, 1.0, 4));
}

}  // namespace
}  // namespace vsslam

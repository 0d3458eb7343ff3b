#include "sim/scout.h"

namespace vsslam {

void ScoutConfig::fields(Fields& f) {
  f("wheelbase_m", wheelbase_m, between(0.1, 5));
  f("track_m", track_m, between(0.1, 5));
  f("wheel_radius_m", wheel_radius_m, between(0.02, 1));
  f("axle_below_base_m", axle_below_base_m, between(0, 1));
  f("chassis_size_m", chassis_size_m, between(0.05, 5));
  f("hull_length_m", hull_length_m, between(0.1, 6));
  f("hull_width_m", hull_width_m, between(0.1, 6));
  f("chassis_mass_kg", chassis_mass_kg, between(1, 1000));
  f("wheel_mass_kg", wheel_mass_kg, between(0.5, 200));
  f("payload_kg", payload_kg, between(0, 50));
  f("chassis_inertia_kgm2", chassis_inertia_kgm2, between(0.01, 1000));
  f("wheel_width_m", wheel_width_m, between(0.01, 1));
  f("friction", friction, between(0.01, 2));
  f("tyre_stiffness_npm", tyre_stiffness_npm, between(1e4, 1e6));
  f("tyre_damping_nspm", tyre_damping_nspm, between(100, 1e5));
  f("wheel_torque_limit_nm", wheel_torque_limit_nm, between(0.1, 1000));
  f("max_speed_mps", max_speed_mps, between(0.05, 5));
  f("max_yaw_rate_radps", max_yaw_rate_radps, between(0.05, 3));
  f("max_accel_mps2", max_accel_mps2, between(0.05, 10));
  f("accel_mps2", accel_mps2, between(0.02, 10));
  f("yaw_accel_radps2", yaw_accel_radps2, between(0.05, 20));
  f("vibration_accel_mps2", vibration_accel_mps2, between(0, 10));
  f("vibration_rate_radps", vibration_rate_radps, between(0, 1));
  f("vibration_seed", vibration_seed);
  f.check(accel_mps2 <= max_accel_mps2, "accel_mps2", "at most max_accel_mps2");
}

double total_mass_kg(const ScoutConfig& config) {
  return config.chassis_mass_kg + config.payload_kg + 4 * config.wheel_mass_kg;
}

double base_height_m(const ScoutConfig& config) {
  const double compression_m = 0.25 * total_mass_kg(config) * kGravity_mps2 / config.tyre_stiffness_npm;
  return config.axle_below_base_m + config.wheel_radius_m - compression_m;
}

// Four equal contacts at (+-L/2, +-W/2), wheels at surface speed -+v: contact i slips at (-+(v - w W/2), +-w
// L/2). Coulomb friction opposes the slip, and its moment about the centre vanishes when w (L/2)^2 = (v - w
// W/2) W/2, so w = 2 v W / (L^2 + W^2); a differential drive of track B has w = 2 v / B.
double effective_track_m(const ScoutConfig& config) {
  return config.track_m + config.wheelbase_m * config.wheelbase_m / config.track_m;
}

}  // namespace vsslam

// The robot: AgileX Scout 2.0, skid-steered, four driven wheels, no suspension.
#pragma once

#include "core/config.h"

namespace vsslam {

constexpr double kGravity_mps2 = 9.80665;

/// The `robot` section of a scenario. Frame `base`: centre of the chassis, x forward, y left, z up.
struct ScoutConfig {
  // Geometry, from the public URDF.
  double wheelbase_m = 0.498;
  double track_m = 0.58306;
  double wheel_radius_m = 0.16459;
  double axle_below_base_m = 0.0702;
  Vec3 chassis_size_m{0.925, 0.38, 0.21};
  double hull_length_m = 0.93;  ///< outline with wheels: this is what collides with the world
  double hull_width_m = 0.70;
  // Masses. Inertias are of the bodies about their own centres.
  double chassis_mass_kg = 50.0;
  double wheel_mass_kg = 8.0;
  double payload_kg = 0.0;  ///< on the chassis' centre, at most 50 kg
  Vec3 chassis_inertia_kgm2{2.29, 5.10, 3.43};
  double wheel_width_m = 0.11653;
  // Contact and drive.
  double friction = 0.7;  ///< Coulomb coefficient of each wheel on the floor
  /// Of each tyre, vertically (judgement). Four stiff legs would not share the load in a defined way.
  double tyre_stiffness_npm = 2e5, tyre_damping_nspm = 3000;
  double wheel_torque_limit_nm = 40.0;  ///< of each wheel's motor, after the gear
  double max_speed_mps = 1.5;
  double max_yaw_rate_radps = 0.785;
  double max_accel_mps2 = 3.0;
  // How the driver drives.
  double accel_mps2 = 0.8;  ///< along the path
  double yaw_accel_radps2 = 1.5;

  // Vibration on purpose (tyre lugs, floor texture): of the base frame, RMS at 1 m/s, growing with the speed squared.
  double vibration_accel_mps2 = 0;  ///< vertical
  double vibration_rate_radps = 0;  ///< roll and pitch, each
  uint64_t vibration_seed = 1;

  void fields(Fields& f);
};

double total_mass_kg(const ScoutConfig& config);

/// Height of the base frame's origin above a plane floor at rest, tyres compressed by the weight.
double base_height_m(const ScoutConfig& config);

/// Track of the differential drive that turns as the skid-steered robot does, as a calibration would tell:
/// yaw rate = (right - left) wheel surface speed / effective track.
double effective_track_m(const ScoutConfig& config);

}  // namespace vsslam

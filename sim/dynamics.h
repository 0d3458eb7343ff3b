// Rigid-body dynamics of the Scout in the world: Bullet in double precision, one thread, 1 kHz.
//
// Bodies: the chassis, and four wheels on motorised hinges. Each wheel touches the floor as a sphere on the
// tangent plane of the analytic floor under it: one contact point with Coulomb friction, so the robot skids
// as it turns, and no triangle edge shakes it. With the world's meshes it is the robot's outline (a box over
// chassis and wheels) that collides; what is lower than kStepOver_m is driven over.
#pragma once

#include <array>
#include <memory>

#include "sim/scout.h"
#include "worlds/world.h"

namespace vsslam {

/// Wheels in this order: left is y > 0.
enum Wheel { kFrontLeft, kFrontRight, kRearLeft, kRearRight };

/// Of the left and of the right side.
struct Sides {
  double left = 0, right = 0;
  bool operator==(const Sides&) const = default;
};

struct RobotState {
  SE3 T_world_base;
  Vec3 v_world = Vec3::Zero();        ///< of base, m/s
  Vec3 omega_world = Vec3::Zero();    ///< rad/s
  std::array<double, 4> wheel_rad{};  ///< accumulated, positive forwards
  std::array<double, 4> wheel_radps{};
  std::array<double, 4> slip_mps{};  ///< wheel surface speed minus ground speed, along base x
};

class Dynamics {
 public:
  static constexpr int64_t kStep_ns = 1'000'000;
  static constexpr double kStepOver_m = 0.03;

  /// The robot stands at x, y on the floor; its fall of a fraction of a millimetre is left to the caller to
  /// await.
  Dynamics(const World& world, const ScoutConfig& scout, double x_m, double y_m, double yaw_rad);
  ~Dynamics();

  /// One step of 1 ms. The motors drive the wheels to these speeds with their limited torque; friction is
  /// scaled.
  void step(const Sides& wheel_radps, const Sides& friction_scale);
  const RobotState& state() const;
  /// An object of the world that touched the robot's outline in the last step, or -1.
  int touched_object() const;
  /// Moves a colliding object, or takes it away. The placement may turn and shift it, not scale it anew.
  void set_object_pose(int object, const Eigen::Affine3d& T_world_object, bool present);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace vsslam

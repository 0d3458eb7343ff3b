#include "sensors/lidar/firing_poses.h"

namespace vsslam {

FiringPoses FiringPoses::fit(const Trajectory& trajectory, const SE3& T_base_lidar, Time begin, Time end) {
  const Time mid{begin.ns + (end.ns - begin.ns) / 2};
  const SE3 first = trajectory.pose(begin) * T_base_lidar;
  const SE3 middle = trajectory.pose(mid) * T_base_lidar;
  const SE3 last = trajectory.pose(end) * T_base_lidar;
  // phi(s) = s a + s^2 b turns the middle orientation into the one at s; Exp to second order in s.
  const Vec3 phi_first = so3_log(middle.rotation.conjugate() * first.rotation);
  const Vec3 phi_last = so3_log(middle.rotation.conjugate() * last.rotation);
  const Mat3 a = hat((phi_last - phi_first) / 2), b = hat((phi_last + phi_first) / 2);

  FiringPoses poses;
  const Mat3 R = middle.matrix3();
  poses.R_world_lidar = {R, R * a, R * (b + 0.5 * a * a)};
  poses.p_world_lidar = {middle.translation, (last.translation - first.translation) / 2,
                         (last.translation + first.translation) / 2 - middle.translation};
  poses.mid_ns = static_cast<double>((mid - begin).ns);
  poses.half_ns = static_cast<double>((end - begin).ns) / 2;
  return poses;
}

FiringPoses FiringPoses::fixed(const SE3& T_world_lidar) {
  FiringPoses poses;
  poses.R_world_lidar = {T_world_lidar.matrix3(), Mat3::Zero(), Mat3::Zero()};
  poses.p_world_lidar = {T_world_lidar.translation, Vec3::Zero(), Vec3::Zero()};
  return poses;
}

}  // namespace vsslam

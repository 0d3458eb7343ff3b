#include "slam/vio/vio_predict.h"

namespace vsslam {

VioState predict(const VioState& state, const ImuPreintegration& motion, double gravity_mps2) {
  const double dt = motion.dt_s();
  const Vec3 g_vio(0, 0, -gravity_mps2);
  const Quat& q = state.T_vio_imu.rotation;
  VioState next = state;
  next.stamp = state.stamp + Duration::from_seconds(dt);
  next.T_vio_imu = SE3(q * motion.delta_R(), state.T_vio_imu.translation + state.v_vio_mps * dt +
                                                 0.5 * dt * dt * g_vio + q * motion.delta_p());
  next.v_vio_mps = state.v_vio_mps + dt * g_vio + q * motion.delta_v();
  return next;
}

std::vector<VioState> predict_along(const VioState& state, const ImuSpan& span, const ImuCalibration& imu) {
  std::vector<VioState> states{state};
  ImuPreintegration motion(imu, state.bias);
  for (size_t i = 1; i < span.size(); ++i) {
    const ImuSample &a = span[i - 1], &b = span[i];
    if (b.stamp <= a.stamp) continue;
    motion.add(seconds_between(a.stamp, b.stamp), a.gyro_radps, a.accel_mps2, b.gyro_radps, b.accel_mps2);
    states.push_back(predict(state, motion, imu.gravity_mps2));
    states.back().stamp = b.stamp;
  }
  return states;
}

}  // namespace vsslam

#include "slam/vio/vio_start.h"

#include <algorithm>
#include <cmath>

#include "slam/vio/motion_alignment.h"

namespace vsslam {

namespace {

constexpr double kGaugeSigma_m = 1e-3, kGaugeSigma_rad = 1e-3;  // position and yaw are ours to choose

}  // namespace

std::optional<VioWindow> start_aided(const VioAid& aid, const VisualFrame& frame, const ImuTrack& imu,
                                     const VioModel& model) {
  WindowFrame first;
  first.state = {aid.stamp, aid.T_odom_imu, aid.v_odom_mps, aid.bias};
  if (aid.stamp < frame.stamp) {
    const auto span = cut_span(imu, aid.stamp, frame.stamp, kMaxImuGap_s);
    if (!span) return std::nullopt;
    first.state = predict(first.state, preintegrate(*span, model.imu, aid.bias), model.imu.gravity_mps2);
  }
  first.state.stamp = frame.stamp;
  first.key = true;
  const VioStartConfig& start = model.config.start;
  VioWindow window;
  window.prior =
      prior_of_state(0, first.state,
                     {start.aid_tilt_sigma_rad, kGaugeSigma_rad, kGaugeSigma_m, start.aid_velocity_sigma_mps,
                      start.gyro_bias_sigma_radps, start.accel_bias_sigma_mps2});
  window.append(std::move(first), frame);
  return window;
}

VioWindow start_at_rest(const VisualFrame& reference, const VisualFrame& frame, const RestMeans& means,
                        const VioModel& model) {
  constexpr double kTiltSigma_rad = 0.05, kVelocitySigma_mps = 0.01;  // the rest factor knows better
  WindowFrame first, second;
  first.state.stamp = reference.stamp;
  first.state.T_vio_imu.rotation = Quat::FromTwoVectors(means.accel_mps2, Vec3::UnitZ());
  first.state.bias.gyro_radps = means.gyro_radps;
  first.key = second.key = true;
  second.id = 1;
  second.state = first.state;
  second.state.stamp = frame.stamp;
  second.rest = means;
  const VioStartConfig& start = model.config.start;
  VioState expected = first.state;
  expected.bias = {};
  VioWindow window;
  window.prior = prior_of_state(0, expected,
                                {kTiltSigma_rad, kGaugeSigma_rad, kGaugeSigma_m, kVelocitySigma_mps,
                                 start.gyro_bias_sigma_radps, start.accel_bias_sigma_mps2});
  window.append(std::move(first), reference);
  window.append(std::move(second), frame);
  return window;
}

bool MotionStart::collect(const VisualFrame& frame, const ImuTrack& imu) {
  WindowFrame next;
  next.state.stamp = frame.stamp;
  if (!window_.frames.empty()) {
    auto span = cut_span(imu, window_.newest().state.stamp, frame.stamp, kMaxImuGap_s);
    if (!span) {
      reset();
      return false;
    }
    if (!window_.newest().key) {
      WindowFrame& last = window_.newest();
      last.span.insert(last.span.end(), span->begin() + 1, span->end());
      *span = std::move(last.span);
      leave_newest(window_, model_);
    }
    const WindowFrame& before = window_.newest();
    next.id = before.id + 1;
    next.motion = preintegrate(*span, model_.imu, {});
    next.span = std::move(*span);
    next.state.T_vio_imu.rotation = before.state.T_vio_imu.rotation * next.motion->delta_R();
  }
  window_.append(std::move(next), frame);
  const NewestView view = view_newest(window_, model_.T_imu_camera);
  const VioConfig& config = model_.config;
  if (window_.frames.size() > 1 && view.tracks < config.limits.min_tracks) {
    reset();
    return false;
  }
  window_.newest().key = window_.frames.size() == 1 || view.parallax_px > config.key_parallax_px;
  if (window_.frames.size() > static_cast<size_t>(config.window) + 1) {
    window_.forget_sightings(window_.frames.front().id, model_.T_imu_camera);
    window_.frames.pop_front();
  }
  return true;
}

std::optional<VioWindow> MotionStart::add(const VisualFrame& frame, const ImuTrack& imu) {
  if (!collect(frame, imu) || window_.frames.size() < 5) return std::nullopt;
  const double looks_back_s = seconds_between(window_.frames.front().state.stamp, frame.stamp);
  if (looks_back_s < model_.config.start.motion_s) return std::nullopt;
  std::optional<VioWindow> aligned = align_motion(window_, model_);
  if (!aligned) return std::nullopt;
  // The alignment knows nothing of biases: now all together.
  const VioStartConfig& start = model_.config.start;
  constexpr double kTiltSigma_rad = 0.2, kVelocitySigma_mps = 5;  // hardly known
  const WindowFrame& first = aligned->frames.front();
  aligned->prior = prior_of_state(first.id, first.state,
                                  {kTiltSigma_rad, kGaugeSigma_rad, kGaugeSigma_m, kVelocitySigma_mps,
                                   start.gyro_bias_sigma_radps, start.accel_bias_sigma_mps2});
  constexpr int kIterations = 30;
  for (int round = 0; round < 2; ++round) {  // the second without what did not fit
    triangulate(*aligned, model_.T_imu_camera, model_.config);
    if (!solve(*aligned, model_, kIterations).usable) return std::nullopt;
    remove_outliers(*aligned, model_.T_imu_camera, model_.config.outlier_px);
  }
  const size_t kept = usable_features(*aligned, model_.config.max_features).size();
  if (kept < 2 * static_cast<size_t>(model_.config.limits.min_tracks)) return std::nullopt;
  const Mat3 velocity = newest_covariance(*aligned, model_).block<3, 3>(6, 6);
  const double speed_sigma = std::sqrt(velocity.trace());
  const double speed = aligned->newest().state.v_vio_mps.norm();
  if (!(speed_sigma < start.motion_velocity_sigma * std::max(speed, 0.2))) return std::nullopt;
  reset();
  return aligned;
}

}  // namespace vsslam

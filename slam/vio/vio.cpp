#include "slam/vio/vio.h"

#include <algorithm>

#include "slam/vio/vio_problem.h"
#include "slam/vio/vio_start.h"

namespace vsslam {

namespace {

// What a tracker may hand over when it fails: only finite features, once each, in order.
VisualFrame cleaned(VisualFrame frame, double time_offset_s) {
  frame.stamp = frame.stamp + Duration::from_seconds(time_offset_s);
  auto& features = frame.features;
  std::erase_if(features, [](const VisualFeature& f) { return !f.ray_camera.allFinite(); });
  std::stable_sort(features.begin(), features.end(),
                   [](const VisualFeature& a, const VisualFeature& b) { return a.id < b.id; });
  features.erase(std::unique(features.begin(), features.end(),
                             [](const VisualFeature& a, const VisualFeature& b) { return a.id == b.id; }),
                 features.end());
  for (VisualFeature& f : features)
    if (!(f.depth_m > 0) || !std::isfinite(f.depth_m)) f.depth_m = 0;
  return frame;
}

constexpr double kLongestMemory_s = 5;  // of IMU samples, when no frames come

}  // namespace

struct VisualInertialOdometry::Impl {
  VioModel model;
  StageClock* clock;
  ImuTrack imu;
  RestDetector rest;
  MotionStart motion_start;
  std::optional<VioAid> aid;
  VioWindow window;
  bool tracking = false;
  int restarts = 0;
  std::optional<Time> last_frame;  // by the IMU's clock
  Time last_seen;                  // the last frame that was not blind

  Impl(const VioConfig& config, const RigCalibration& rig, const ImuTrackLimits& limits,
       StageClock* stage_clock)
      : model(make_model(config, rig)),
        clock(stage_clock),
        imu(limits),
        rest(config.rest),
        motion_start(model) {}

  void add(const ImuSample& sample);
  bool wants(Time stamp) const;
  std::optional<VioState> add(const VisualFrame& raw);
  std::optional<VioWindow> start(const VisualFrame& frame, const std::optional<RestMeans>& means);
  bool track(const VisualFrame& frame, const std::optional<RestMeans>& means);
  void make_room(WindowFrame& next, ImuSpan span);
  void decide_key(const NewestView& view);
  void preintegrate_again();
  bool healthy(const VioState& expected) const;
  bool slow(Time stamp) const;
  void fail();
  std::optional<VioState> propagated(Time stamp) const;
  std::vector<StampedPose> dense_path(Time begin, Time end) const;
};

void VisualInertialOdometry::Impl::add(const ImuSample& sample) {
  imu.add(sample);
  const double blind_s = seconds_between(last_seen, sample.stamp);
  if (tracking && blind_s > model.config.limits.blind_s + 1 / model.config.max_rate_hz) fail();
  if (!imu.samples().empty())
    imu.forget_before(imu.samples().back().stamp - Duration::from_seconds(kLongestMemory_s));
}

// `stamp` by the camera's clock.
bool VisualInertialOdometry::Impl::wants(Time stamp) const {
  const Time now = stamp + Duration::from_seconds(model.config.time_offset_s);
  return !last_frame || seconds_between(*last_frame, now) >= 0.9 / model.config.max_rate_hz;
}

// One frame.
std::optional<VioState> VisualInertialOdometry::Impl::add(const VisualFrame& raw) {
  const StageTimer timer(clock, "vio");
  const VisualFrame frame = cleaned(raw, model.config.time_offset_s);
  if (last_frame && frame.stamp <= *last_frame) return std::nullopt;
  if (!wants(raw.stamp)) return tracking ? propagated(frame.stamp) : std::nullopt;
  if (!imu.at(frame.stamp)) return std::nullopt;
  last_frame = frame.stamp;
  std::optional<RestMeans> means = rest.update(frame, imu);
  if (means && tracking && !slow(frame.stamp)) means.reset();
  if (tracking && !track(frame, means)) fail();
  if (!tracking) {
    if (auto started = start(frame, means)) {
      window = std::move(*started);
      tracking = true;
      last_seen = frame.stamp;
      motion_start.reset();
    }
  }
  if (!tracking) return std::nullopt;
  return window.newest().state;
}

bool VisualInertialOdometry::Impl::slow(Time stamp) const {
  const std::optional<VioState> state = propagated(stamp);
  return state && state->v_vio_mps.norm() < model.config.rest.speed_mps;
}

std::optional<VioWindow> VisualInertialOdometry::Impl::start(const VisualFrame& frame,
                                                             const std::optional<RestMeans>& means) {
  if (frame.features.size() < static_cast<size_t>(model.config.limits.min_tracks)) return std::nullopt;
  if (aid && std::abs(seconds_between(aid->stamp, frame.stamp)) < model.config.start.max_aid_age_s &&
      aid->stamp <= frame.stamp)
    if (auto started = start_aided(*aid, frame, imu, model)) return started;
  if (means && rest.reference().stamp < frame.stamp) {
    VioWindow started = start_at_rest(rest.reference(), frame, *means, model);
    if (solve(started, model, model.config.max_iterations).usable) return started;
  }
  return motion_start.add(frame, imu);
}

bool VisualInertialOdometry::Impl::track(const VisualFrame& frame, const std::optional<RestMeans>& means) {
  // 1 the IMU since the last frame
  std::optional<ImuSpan> span = cut_span(imu, window.newest().state.stamp, frame.stamp, kMaxImuGap_s);
  if (!span) return false;
  // 2 a frame leaves: the newest if it was no key frame, else the oldest of a full window
  WindowFrame next;
  next.rest = means;
  make_room(next, std::move(*span));
  // 3 where the IMU expects the new frame
  const VioState& before = window.newest().state;
  next.id = window.newest().id + 1;
  if (next.rest) {
    next.state = before;
    next.state.v_vio_mps.setZero();
  } else {
    next.motion = preintegrate(next.span, model.imu, before.bias);
    next.state = predict(before, *next.motion, model.imu.gravity_mps2);
  }
  next.state.stamp = frame.stamp;
  const VioState expected = next.state;
  window.append(std::move(next), frame);
  const NewestView view = view_newest(window, model.T_imu_camera);
  decide_key(view);
  // 4 depths of new features, then all states and depths together
  triangulate(window, model.T_imu_camera, model.config);
  preintegrate_again();
  {
    const StageTimer timer(clock, "vio_solve");
    if (!solve(window, model, model.config.max_iterations).usable) return false;
  }
  // 5 what does not fit leaves
  const int removed = remove_outliers(window, model.T_imu_camera, model.config.outlier_px);
  const int fitting = view.tracks - removed;
  if (means || (fitting >= model.config.limits.min_tracks && fitting > removed)) last_seen = frame.stamp;
  return healthy(expected);
}

// `span` leads from the newest frame of the window to `next`.
void VisualInertialOdometry::Impl::make_room(WindowFrame& next, ImuSpan span) {
  WindowFrame& last = window.newest();
  // Its IMU ended with the samples at hand; by now those after them tell where they were wrong.
  if (!last.span.empty())
    if (auto again = cut_span(imu, last.span.front().stamp, last.span.back().stamp, kMaxImuGap_s))
      last.span = std::move(*again);
  // Rest is an interval of its own: the frames in which it begins and ends stay.
  if (last.rest.has_value() != next.rest.has_value()) last.key = true;
  const StageTimer timer(clock, "vio_marginalize");
  if (!last.key && window.frames.size() > 1) {
    next.span = std::move(last.span);
    leave_newest(window, model);
  } else if (window.frames.size() > static_cast<size_t>(model.config.window)) {
    if (!last.rest) last.motion = preintegrate(last.span, model.imu, last.motion->bias());
    leave_oldest(window, model);
  }
  if (next.rest) {
    next.span.clear();
  } else {
    next.span.insert(next.span.end(), span.begin() + (next.span.empty() ? 0 : 1), span.end());
  }
}

void VisualInertialOdometry::Impl::decide_key(const NewestView& view) {
  const VioConfig& config = model.config;
  WindowFrame& newest = window.newest();
  const WindowFrame& last = window.frames[window.frames.size() - 2];
  const bool sees = std::count_if(window.features.begin(), window.features.end(), [&](const auto& feature) {
                      return feature.second.seen.back().frame == newest.id;
                    }) >= config.limits.min_tracks;
  const bool far = seconds_between(last.state.stamp, newest.state.stamp) > config.key_interval_s;
  newest.key =
      !newest.rest &&
      (far || (sees && (view.tracks < config.key_tracks || view.parallax_px > config.key_parallax_px)));
}

// Where the bias has moved so far that the first-order correction is not good enough.
void VisualInertialOdometry::Impl::preintegrate_again() {
  constexpr double kGyro_radps = 1e-3, kAccel_mps2 = 1e-2;
  for (size_t j = 1; j < window.frames.size(); ++j) {
    WindowFrame& frame = window.frames[j];
    if (!frame.motion) continue;
    const ImuBias &now = window.frames[j - 1].state.bias, &then = frame.motion->bias();
    const bool moved = (now.gyro_radps - then.gyro_radps).norm() > kGyro_radps ||
                       (now.accel_mps2 - then.accel_mps2).norm() > kAccel_mps2;
    const bool completed = j + 2 == window.frames.size();  // its last sample is better known now
    if (moved || completed) frame.motion = preintegrate(frame.span, model.imu, now);
  }
}

bool VisualInertialOdometry::Impl::healthy(const VioState& expected) const {
  const VioLimits& limits = model.config.limits;
  const VioState& state = window.newest().state;
  const SE3 jump = expected.T_vio_imu.inverse() * state.T_vio_imu;
  const bool finite =
      jump.translation.allFinite() && state.v_vio_mps.allFinite() && state.bias.gyro_radps.allFinite();
  return finite && state.bias.gyro_radps.norm() < limits.gyro_bias_radps &&
         state.bias.accel_mps2.norm() < limits.accel_bias_mps2 && state.v_vio_mps.norm() < limits.speed_mps &&
         jump.translation.norm() < limits.jump_m && jump.angle() < limits.jump_rad &&
         seconds_between(last_seen, state.stamp) < limits.blind_s;
}

void VisualInertialOdometry::Impl::fail() {
  tracking = false;
  ++restarts;
  window = {};
  motion_start.reset();
}

std::optional<VioState> VisualInertialOdometry::Impl::propagated(Time stamp) const {
  const VioState& newest = window.newest().state;
  const auto span = cut_span(imu, newest.stamp, stamp, kMaxImuGap_s);
  if (!span) return std::nullopt;
  VioState state = predict_along(newest, *span, model.imu).back();
  state.stamp = stamp;
  return state;
}

// From the last frame at or before `begin` until at least `end`: states of the window, between them the IMU bent so
// that it meets them, after them the IMU.
std::vector<StampedPose> VisualInertialOdometry::Impl::dense_path(Time begin, Time end) const {
  std::vector<StampedPose> path;
  for (size_t k = 0; k < window.frames.size(); ++k) {
    const VioState& from = window.frames[k].state;
    const bool last = k + 1 == window.frames.size();
    if (!last && window.frames[k + 1].state.stamp <= begin) continue;
    path.push_back({from.stamp, from.T_vio_imu});
    if (last || from.stamp >= end || window.frames[k + 1].rest) continue;
    const WindowFrame& next = window.frames[k + 1];
    const auto states = predict_along(from, next.span, model.imu);
    const Vec6 bend = (states.back().T_vio_imu.inverse() * next.state.T_vio_imu).log();
    for (size_t i = 1; i + 1 < states.size(); ++i) {
      const double u =
          seconds_between(from.stamp, states[i].stamp) / seconds_between(from.stamp, next.state.stamp);
      path.push_back({states[i].stamp, states[i].T_vio_imu * SE3::exp(u * bend)});
    }
  }
  if (path.empty() || path.front().stamp > begin) return {};
  if (end <= path.back().stamp) return path;
  const auto span = cut_span(imu, window.newest().state.stamp, end, kMaxImuGap_s);
  if (!span) return {};
  const auto states = predict_along(window.newest().state, *span, model.imu);
  for (size_t i = 1; i < states.size(); ++i) path.push_back({states[i].stamp, states[i].T_vio_imu});
  return path;
}

namespace {

SE3 pose_at(const std::vector<StampedPose>& path, Time stamp) {
  if (path.size() < 2 || stamp <= path.front().stamp) return path.front().pose;
  const auto b = std::lower_bound(path.begin() + 1, path.end() - 1, stamp,
                                  [](const StampedPose& p, Time t) { return p.stamp < t; });
  const auto a = b - 1;
  return interpolate(a->pose, b->pose,
                     seconds_between(a->stamp, stamp) / seconds_between(a->stamp, b->stamp));
}

}  // namespace

VisualInertialOdometry::VisualInertialOdometry(const VioConfig& config, const RigCalibration& rig,
                                               const ImuTrackLimits& limits, StageClock* clock)
    : impl_(std::make_unique<Impl>(config, rig, limits, clock)) {}
VisualInertialOdometry::~VisualInertialOdometry() = default;

void VisualInertialOdometry::add(const ImuSample& sample) {
  impl_->add(sample);
}
bool VisualInertialOdometry::wants(Time stamp) const {
  return impl_->wants(stamp);
}
void VisualInertialOdometry::add(const VioAid& aid) {
  impl_->aid = aid;
}
std::optional<VioState> VisualInertialOdometry::add(const VisualFrame& frame) {
  return impl_->add(frame);
}
VioStatus VisualInertialOdometry::status() const {
  return impl_->tracking ? VioStatus::tracking : VioStatus::starting;
}
int VisualInertialOdometry::restarts() const {
  return impl_->restarts;
}
const VioState& VisualInertialOdometry::state() const {
  return impl_->window.newest().state;
}
Eigen::Matrix<double, 15, 15> VisualInertialOdometry::covariance() const {
  return newest_covariance(impl_->window, impl_->model);
}

std::vector<StampedPose> VisualInertialOdometry::path_vio_imu(Time begin, Time end) const {
  if (!impl_->tracking || end < begin) return {};
  const std::vector<StampedPose> dense = impl_->dense_path(begin, end);
  if (dense.empty()) return {};
  std::vector<StampedPose> path{{begin, pose_at(dense, begin)}};
  for (const StampedPose& knot : dense)
    if (knot.stamp > begin && knot.stamp < end) path.push_back(knot);
  if (end > begin) path.push_back({end, pose_at(dense, end)});
  return path;
}

}  // namespace vsslam

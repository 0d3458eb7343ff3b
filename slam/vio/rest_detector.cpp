#include "slam/vio/rest_detector.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace vsslam {

namespace {

constexpr double kLongestMean_s = 10;  // in the meantime a bias walks by about what the mean is good for
constexpr size_t kMinCommon = 10;

struct ImuMean {
  Vec3 gyro_sum = Vec3::Zero(), accel_sum = Vec3::Zero();
  double gyro_square = 0, accel_square = 0;
  int count = 0;

  void add(const ImuSample& s) {
    gyro_sum += s.gyro_radps;
    accel_sum += s.accel_mps2;
    gyro_square += s.gyro_radps.squaredNorm();
    accel_square += s.accel_mps2.squaredNorm();
    ++count;
  }
  Vec3 gyro() const { return gyro_sum / count; }
  Vec3 accel() const { return accel_sum / count; }
  double gyro_spread() const { return std::sqrt(std::max(0.0, gyro_square / count - gyro().squaredNorm())); }
  double accel_spread() const {
    return std::sqrt(std::max(0.0, accel_square / count - accel().squaredNorm()));
  }
};

}  // namespace

std::optional<double> median_flow_px(const VisualFrame& a, const VisualFrame& b) {
  std::vector<double> flow_px;
  auto i = a.features.begin();
  for (const VisualFeature& feature : b.features) {
    while (i != a.features.end() && i->id < feature.id) ++i;
    if (i == a.features.end()) break;
    if (i->id == feature.id) flow_px.push_back(460 * (i->ray_camera - feature.ray_camera).norm());
  }
  if (flow_px.size() < kMinCommon) return std::nullopt;
  const auto middle = flow_px.begin() + static_cast<std::ptrdiff_t>(flow_px.size() / 2);
  std::nth_element(flow_px.begin(), middle, flow_px.end());
  return *middle;
}

// Quiet as a whole, and without a trend: the mean of each quarter of the window agrees with that of the rest so far,
// or with the whole. A robot that sets off or rolls out gently shows there first.
RestDetector::Quiet RestDetector::quiet(Time now, const ImuTrack& imu) const {
  const Time begin = now - Duration::from_seconds(config_.window_s);
  ImuMean whole;
  std::array<ImuMean, 4> quarters;
  for (auto s = imu.samples().rbegin(); s != imu.samples().rend() && s->stamp > begin; ++s) {
    const double share = seconds_between(s->stamp, now) / config_.window_s;
    whole.add(*s);
    quarters[static_cast<size_t>(std::clamp(4 * share, 0.0, 3.0))].add(*s);
  }
  Quiet result;
  if (whole.count < 8) return result;
  result.means = {whole.gyro(), whole.accel(), config_.window_s};
  const RestMeans& usual = reference_ ? means_ : result.means;
  result.is = whole.gyro_spread() < config_.gyro_radps && whole.accel_spread() < config_.accel_mps2 &&
              result.means.gyro_radps.norm() < config_.gyro_radps;
  for (const ImuMean& quarter : quarters)
    result.is = result.is && quarter.count > 0 &&
                (quarter.gyro() - usual.gyro_radps).norm() < config_.gyro_change_radps &&
                (quarter.accel() - usual.accel_mps2).norm() < config_.accel_change_mps2;
  return result;
}

bool RestDetector::still(const VisualFrame& frame) const {
  if (reference_) return median_flow_px(*reference_, frame).value_or(0) < config_.flow_px;
  if (seconds_between(recent_.front().stamp, frame.stamp) < 0.8 * config_.window_s) return false;
  return median_flow_px(recent_.front(), frame).value_or(config_.flow_px) < config_.flow_px;
}

void RestDetector::average(const ImuTrack& imu, Time until) {
  for (const ImuSample& s : imu.samples()) {
    if (s.stamp <= averaged_until_ || s.stamp > until) continue;
    const double dt = std::min(seconds_between(averaged_until_, s.stamp), config_.window_s);
    means_.duration_s = std::min(means_.duration_s + dt, kLongestMean_s);
    const double share = dt / means_.duration_s;
    means_.gyro_radps += share * (s.gyro_radps - means_.gyro_radps);
    means_.accel_mps2 += share * (s.accel_mps2 - means_.accel_mps2);
    averaged_until_ = s.stamp;
  }
}

std::optional<RestMeans> RestDetector::update(const VisualFrame& frame, const ImuTrack& imu) {
  recent_.push_back(frame);
  const auto old_enough = [&](const VisualFrame& f) {
    return seconds_between(f.stamp, frame.stamp) >= config_.window_s;
  };
  while (recent_.size() > 2 && old_enough(recent_[1])) recent_.pop_front();
  const Quiet now = quiet(frame.stamp, imu);
  if (!now.is || !still(frame)) {
    reference_.reset();
    return std::nullopt;
  }
  if (!reference_) {
    reference_ = recent_.front();
    means_ = now.means;
    averaged_until_ = frame.stamp;
  } else {
    if (!median_flow_px(*reference_, frame) && frame.features.size() >= kMinCommon) reference_ = frame;
    average(imu, frame.stamp);
  }
  return means_;
}

}  // namespace vsslam

#include "slam/inertial/imu_units.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <utility>

namespace vsslam {

namespace {

constexpr double kDegree = std::numbers::pi / 180;

}  // namespace

ImuSample ImuUnits::repaired(ImuSample sample) {
  if (sample.gyro_radps.allFinite() && sample.accel_mps2.allFinite()) {
    weigh(sample);
    watch_rates(sample.gyro_radps.norm());
  }
  if (in_g_) sample.accel_mps2 *= imu_.gravity_mps2;
  if (in_degrees_) sample.gyro_radps *= kDegree;
  constexpr size_t kKept = 4000;  // several scans at any rate
  if (!rates_judged_ && sample.gyro_radps.allFinite() && (recent_.empty() || sample.stamp > recent_.back().stamp))
    recent_.push_back(sample);
  if (recent_.size() > kKept) recent_.pop_front();
  return sample;
}

// The first sample decides; by the time there are fifty it is known whether it was one of its kind.
void ImuUnits::weigh(const ImuSample& sample) {
  constexpr int kEnough = 50;
  constexpr double kLeast_g = 0.5, kMost_g = 2.0;
  if (weighed_ == kEnough) return;
  const double force = sample.accel_mps2.norm();
  if (weighed_ == 0 && force > kLeast_g && force < kMost_g) in_g_ = true;
  force_sum_mps2_ += force;
  if (++weighed_ < kEnough) return;
  const double mean = force_sum_mps2_ / kEnough;
  if (in_g_ && mean > kLeast_g && mean < kMost_g) {
    repairs_said_.push_back(
        fmt::format("imu: the specific force is {:.2f} on average: given in g, taken times {:.5f} m/s^2", mean,
                    imu_.gravity_mps2));
  } else {
    in_g_ = false;
  }
}

// Faster than gyroscopes in use can measure (450 degrees/s), for longer than a spike: no rate in rad/s.
void ImuUnits::watch_rates(double rate) {
  constexpr double kFastest_radps = 8;
  constexpr int kSpike = 5;
  if (in_degrees_) return;
  too_fast_ = rate > kFastest_radps ? too_fast_ + 1 : 0;
  if (too_fast_ < kSpike) return;
  take_as_degrees();
  repairs_said_.push_back(
      fmt::format("imu: the gyroscope gives {:.1f}, more than any measures in rad/s: taken as degrees/s", rate));
}

void ImuUnits::take_as_degrees() {
  in_degrees_ = rates_judged_ = newly_in_degrees_ = true;
  for (ImuSample& sample : recent_) sample.gyro_radps *= kDegree;
}

bool ImuUnits::newly_in_degrees() {
  return std::exchange(newly_in_degrees_, false);
}

// Mean rates of neighbouring samples over the time between them, from `from` to `to`.
std::optional<Vec3> ImuUnits::turned(Time from, Time to) const {
  Vec3 sum = Vec3::Zero();
  double covered_s = 0;
  for (size_t i = 1; i < recent_.size(); ++i) {
    const Time begin = std::max(recent_[i - 1].stamp, from), end = std::min(recent_[i].stamp, to);
    if (begin >= end) continue;
    const double dt_s = seconds_between(begin, end);
    sum += 0.5 * dt_s * (recent_[i - 1].gyro_radps + recent_[i].gyro_radps);
    covered_s += dt_s;
  }
  if (covered_s < 0.8 * seconds_between(from, to)) return std::nullopt;
  return sum;
}

void ImuUnits::compare(Time from, Time to, const SE3& T_base_from_to) {
  if (rates_judged_) return;
  const std::optional<Vec3> gyro = turned(from, to);
  while (!recent_.empty() && recent_.front().stamp < from) recent_.pop_front();
  if (!gyro) return;
  const Vec3 lidar = imu_.T_base_imu.rotation.conjugate() * so3_log(T_base_from_to.rotation);
  dot_ += gyro->dot(lidar);
  lidar2_ += lidar.squaredNorm();
  gyro2_ += gyro->squaredNorm();
  judge_rates();
}

std::optional<double> ImuUnits::gyro_scale() const {
  // Ten scans that turn by a degree each: far above the noise of a registration.
  constexpr double kEnough_rad2 = 10 * kDegree * kDegree;
  if (lidar2_ < kEnough_rad2) return std::nullopt;
  return dot_ / lidar2_;
}

void ImuUnits::judge_rates() {
  constexpr double kAlike = 0.9, kFifth = 0.2;
  const std::optional<double> scale = gyro_scale();
  if (!scale) return;
  rates_judged_ = true;
  const double alike = dot_ / std::sqrt(lidar2_ * gyro2_);  // cosine between the two
  if (alike > kAlike && std::abs(*scale * kDegree - 1) < kFifth) {
    take_as_degrees();
    repairs_said_.push_back(fmt::format(
        "imu: the gyroscope turns {:.1f} times as fast as the LiDAR: given in degrees, taken as such", *scale));
  }
}

}  // namespace vsslam

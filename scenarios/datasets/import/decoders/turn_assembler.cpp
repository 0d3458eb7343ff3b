#include "scenarios/datasets/import/decoders/turn_assembler.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace vsslam {

namespace {

constexpr double kTurn = 2 * std::numbers::pi;
constexpr double kWiderThanAnyPart = 0.9 * kTurn, kNearlyATurn = 0.9 * kTurn;
constexpr Duration kLongestBetweenParts{250'000'000};

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Of the narrower one, the share that lies in the other.
double overlap(const Sector& a, const Sector& b) {
  const double narrower_rad = std::min(a.width_rad, b.width_rad);
  if (narrower_rad <= 0) return 0;
  const double apart_rad = std::abs(std::remainder(a.middle_rad() - b.middle_rad(), kTurn));
  const double common_rad = (a.width_rad + b.width_rad) / 2 - apart_rad;
  return std::clamp(common_rad / narrower_rad, 0.0, 1.0);
}

}  // namespace

std::optional<Sector> sector_of(const std::vector<LidarPoint>& points) {
  if (points.empty()) return std::nullopt;
  std::vector<double> azimuths_rad;
  for (const LidarPoint& p : points)
    azimuths_rad.push_back(std::atan2(static_cast<double>(p.y), static_cast<double>(p.x)));
  std::sort(azimuths_rad.begin(), azimuths_rad.end());
  size_t after_gap = 0;
  double gap_rad = azimuths_rad.front() + kTurn - azimuths_rad.back();
  for (size_t i = 1; i < azimuths_rad.size(); ++i)
    if (const double wide_rad = azimuths_rad[i] - azimuths_rad[i - 1]; wide_rad > gap_rad)
      gap_rad = wide_rad, after_gap = i;
  return Sector{azimuths_rad[after_gap], kTurn - gap_rad};
}

std::optional<TurnParts> parts_of_turns(std::span<const LidarScan> clouds) {
  std::vector<double> overlaps, widths_rad, every_s, steps_rad;
  std::optional<Sector> last;
  Time last_stamp;
  for (const LidarScan& cloud : clouds) {
    const std::optional<Sector> sector = sector_of(cloud.points);
    if (sector && last) {
      overlaps.push_back(overlap(*last, *sector));
      widths_rad.push_back(std::max(last->width_rad, sector->width_rad));
      steps_rad.push_back(std::abs(std::remainder(sector->middle_rad() - last->middle_rad(), kTurn)));
      every_s.push_back(seconds_between(last_stamp, cloud.stamp));
    }
    if (sector) last = sector, last_stamp = cloud.stamp;
  }
  constexpr double kHardlyOver = 0.3;
  if (overlaps.size() < 3 || median(overlaps) > kHardlyOver || median(widths_rad) > kWiderThanAnyPart)
    return std::nullopt;
  const double step_rad = median(steps_rad), part_s = median(every_s);
  if (step_rad <= 0 || part_s <= 0) return std::nullopt;
  return TurnParts{part_s, part_s * kTurn / step_rad};
}

std::optional<LidarScan> TurnAssembler::add(LidarScan part) {
  const std::optional<Sector> sector = sector_of(part.points);
  if (!sector) return std::nullopt;
  const double middle_rad = sector->middle_rad();
  if (!turn_) {
    begin(std::move(part), middle_rad);
    return std::nullopt;
  }
  if (part.stamp < turn_->stamp || part.stamp - turn_->end > kLongestBetweenParts) {
    std::optional<LidarScan> whole = rest();
    begin(std::move(part), middle_rad);
    return whole;
  }
  // Half a turn is half a turn either way.
  double step_rad = std::remainder(middle_rad - middle_rad_, kTurn);
  if (std::abs(step_rad) > 0.8 * std::numbers::pi)
    step_rad = std::copysign(std::abs(step_rad), swept_rad_ == 0 ? 1 : swept_rad_);
  if (std::abs(swept_rad_ + step_rad) >= kTurn - 0.25 * std::abs(step_rad)) {
    std::optional<LidarScan> whole = finish();
    begin(std::move(part), middle_rad);
    return whole;
  }
  swept_rad_ += step_rad;
  step_rad_ = step_rad;
  middle_rad_ = middle_rad;
  append(part);
  return std::nullopt;
}

std::optional<LidarScan> TurnAssembler::rest() {
  if (!turn_) return std::nullopt;
  if (std::abs(swept_rad_) + std::abs(step_rad_) >= kNearlyATurn) return finish();
  ++broken_;
  turn_.reset();
  return std::nullopt;
}

void TurnAssembler::begin(LidarScan part, double middle_rad) {
  turn_ = std::move(part);
  middle_rad_ = middle_rad;
  swept_rad_ = step_rad_ = 0;
}

void TurnAssembler::append(const LidarScan& part) {
  const auto since_s = static_cast<float>(seconds_between(turn_->stamp, part.stamp));
  for (LidarPoint p : part.points) {
    p.time_s += since_s;
    turn_->points.push_back(p);
  }
  turn_->end = std::max(turn_->end, part.end);
  turn_->rings_known = turn_->rings_known && part.rings_known;
  turn_->times_known = turn_->times_known && part.times_known;
}

std::optional<LidarScan> TurnAssembler::finish() {
  std::stable_sort(turn_->points.begin(), turn_->points.end(),
                   [](const LidarPoint& a, const LidarPoint& b) { return a.time_s < b.time_s; });
  return std::exchange(turn_, std::nullopt);
}

}  // namespace vsslam

#include "scenarios/health/sample_clock.h"

#include <algorithm>
#include <cmath>

namespace vsslam {

namespace {

constexpr double kClassWidth = 0.01;  // of the logarithm: finer than any rate is known
constexpr double kShortest_s = 1e-6,
                 kLongest_s = 1e4;  // what lies beyond counts as these: about 2300 classes at most

int class_of(double interval_s) {
  return static_cast<int>(
      std::floor(std::log(std::clamp(interval_s, kShortest_s, kLongest_s)) / kClassWidth));
}

}  // namespace

void SampleClock::add(Time stamp) {
  ++count_;
  if (!first_) first_ = stamp;
  if (last_) {
    const double interval_s = seconds_between(*last_, stamp);
    Intervals& like = classes_[class_of(interval_s)];
    ++like.count;
    like.sum_s += interval_s;
    if (!longest_ || interval_s > longest_->length_s) longest_ = Gap{*last_, interval_s};
  }
  last_ = stamp;
}

std::optional<double> SampleClock::usual_interval_s() const {
  int64_t before = 0;
  for (const auto& [unused, like] : classes_) {
    before += like.count;
    if (2 * before >= count_ - 1) return like.sum_s / static_cast<double>(like.count);
  }
  return std::nullopt;
}

std::optional<SampleClock::Gap> SampleClock::longest_gap(Time end) const {
  if (!last_) return std::nullopt;
  const Gap tail{*last_, seconds_between(*last_, end)};
  return longest_ && longest_->length_s >= tail.length_s ? *longest_ : tail;
}

}  // namespace vsslam

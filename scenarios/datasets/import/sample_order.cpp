#include "scenarios/datasets/import/sample_order.h"

#include <algorithm>
#include <utility>

namespace vsslam {

namespace {

constexpr int64_t kSecond = 1'000'000'000;

int64_t whole_second_before(Time t) {
  const int64_t rest = t.ns % kSecond;
  return t.ns - (rest < 0 ? rest + kSecond : rest);
}

size_t bytes_of(const Sample& sample) {
  size_t bytes = sizeof(RecordedSample);
  if (const auto* scan = std::get_if<LidarScan>(&sample)) bytes += scan->points.size() * sizeof(LidarPoint);
  if (const auto* frame = std::get_if<CameraFrame>(&sample)) bytes += frame->grey.size();
  return bytes;
}

}  // namespace

std::optional<int64_t> SampleOrder::Intervals::usual_ns() const {
  if (recent_ns.size() < 4) return std::nullopt;
  std::vector<int64_t> sorted = recent_ns;
  std::nth_element(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2),
                   sorted.end());
  return sorted[sorted.size() / 2];
}

void SampleOrder::Intervals::add(int64_t ns) {
  constexpr size_t kKept = 15;
  if (recent_ns.size() < kKept) {
    recent_ns.push_back(ns);
  } else {
    recent_ns[next++ % kKept] = ns;
  }
}

bool SampleOrder::enough() const {
  if (waiting_.empty()) return false;
  return bytes_ > most_bytes_ || *newest_ - std::get<Time>(waiting_.begin()->first) >= window_;
}

// One more than the window: what is older than its newest cannot be overtaken any more.
void SampleOrder::fill() {
  constexpr Duration kLeap{10'000'000'000};
  while (!ended_ && !enough()) {
    std::optional<RecordedSample> sample = recording_.next();
    for (size_t sensor = 0; sensor < kSensors; ++sensor)
      counts_[sensor].unreadable = recording_.unreadable(sensor);
    if (!sample) {
      ended_ = true;
      if (ahead_) ++counts_[ahead_->sample.index()].stray;
      return;
    }
    const bool leaps = newest_ && sample->end - *newest_ > kLeap;
    if (leaps && !ahead_) {
      ahead_ = std::move(sample);
      continue;
    }
    if (ahead_ && leaps) take(*std::exchange(ahead_, std::nullopt));
    if (ahead_) ++counts_[std::exchange(ahead_, std::nullopt)->sample.index()].stray;
    take(std::move(*sample));
  }
}

void SampleOrder::take(RecordedSample sample) {
  const size_t sensor = sample.sample.index();
  if (released_ && sample.end < *released_) {
    ++counts_[sensor].late;
    return;
  }
  newest_ = newest_ ? std::max(*newest_, sample.end) : sample.end;
  const Key key{sample.end, sensor, arrived_++};
  bytes_ += bytes_of(sample.sample);
  waiting_.emplace(key, std::move(sample));
}

std::optional<RecordedSample> SampleOrder::next() {
  while (true) {
    fill();
    if (waiting_.empty()) return std::nullopt;
    if (!epoch_) {
      Time earliest = stamp_of(waiting_.begin()->second.sample);
      for (const auto& [key, sample] : waiting_) earliest = std::min(earliest, stamp_of(sample.sample));
      epoch_ = Duration{whole_second_before(earliest)};
    }
    RecordedSample sample = std::move(waiting_.extract(waiting_.begin()).mapped());
    bytes_ -= bytes_of(sample.sample);
    released_ = sample.end;
    if (accept(sample)) return counted_from_epoch(std::move(sample));
  }
}

bool SampleOrder::accept(const RecordedSample& sample) {
  const size_t sensor = sample.sample.index();
  const Time stamp = stamp_of(sample.sample);
  SampleCounts& counts = counts_[sensor];
  if (intervals_[sensor].last && stamp <= *intervals_[sensor].last) {
    ++counts.duplicates;
    return false;
  }
  if (const auto* scan = std::get_if<LidarScan>(&sample.sample); scan != nullptr && scan->points.empty()) {
    ++counts.empty;
    return false;
  }
  watch(sensor, stamp);
  ++counts.used;
  counts.moved += sample.moved;
  return true;
}

void SampleOrder::watch(size_t sensor, Time stamp) {
  Intervals& intervals = intervals_[sensor];
  if (intervals.last) {
    const int64_t since_ns = (stamp - *intervals.last).ns;
    const auto usual_ns = intervals.usual_ns();
    if (usual_ns && since_ns > 3 * *usual_ns) {
      SampleCounts& counts = counts_[sensor];
      ++counts.gaps;
      counts.longest_gap_s = std::max(counts.longest_gap_s, Duration{since_ns}.seconds());
      if (!counts.first_gap) counts.first_gap = *intervals.last;
    } else {
      intervals.add(since_ns);
    }
  }
  intervals.last = stamp;
}

RecordedSample SampleOrder::counted_from_epoch(RecordedSample sample) const {
  sample.end = sample.end - *epoch_;
  std::visit([this](auto& s) { s.stamp = s.stamp - *epoch_; }, sample.sample);
  if (auto* scan = std::get_if<LidarScan>(&sample.sample)) scan->end = scan->end - *epoch_;
  return sample;
}

}  // namespace vsslam

// How regularly the samples of one sensor come.
#pragma once

#include <cstdint>
#include <map>
#include <optional>

#include "core/time.h"

namespace vsslam {

/// Of stamps in their order. The memory does not grow with their number: intervals are counted in classes one percent
/// wide.
class SampleClock {
 public:
  void add(Time stamp);

  int64_t count() const { return count_; }
  std::optional<Time> first() const { return first_; }
  std::optional<Time> last() const { return last_; }
  /// The median interval; absent before the second sample.
  std::optional<double> usual_interval_s() const;
  /// An interval without a sample.
  struct Gap {
    Time begin;
    double length_s = 0;
  };
  /// The longest of all intervals, that from the last sample to `end` included.
  std::optional<Gap> longest_gap(Time end) const;

 private:
  struct Intervals {
    int64_t count = 0;
    double sum_s = 0;
  };
  int64_t count_ = 0;
  std::optional<Time> first_, last_;
  std::map<int, Intervals> classes_;  // by the logarithm of the interval
  std::optional<Gap> longest_;
};

}  // namespace vsslam

// The one place that reads the machine's clock and counters. What it measures goes to the screen and to
// timing.json, never into a result.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "core/stage_clock.h"

namespace vsslam {

/// Collects stage times; one per thread of work, merged afterwards.
class WallClock final : public StageClock {
 public:
  int64_t now_ns() override;
  void record(const char* stage, int64_t elapsed_ns) override { elapsed_ns_[stage].push_back(elapsed_ns); }
  /// Adds the times of another clock.
  void add(const WallClock& other);

  struct StageTimes {
    std::string stage;
    size_t count = 0;
    double median_ms = 0, p99_ms = 0, total_s = 0;
  };
  /// Sorted by name. Percentiles by nearest rank.
  std::vector<StageTimes> summary() const;

 private:
  std::map<std::string, std::vector<int64_t>> elapsed_ns_;
};

/// Largest resident memory of this process so far.
double peak_rss_mib();
/// Cores that this process may use.
int available_cores();

}  // namespace vsslam

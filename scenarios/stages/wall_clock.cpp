#include "scenarios/stages/wall_clock.h"

#include <sched.h>
#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>

namespace vsslam {

int64_t WallClock::now_ns() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
             std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

void WallClock::add(const WallClock& other) {
  for (const auto& [stage, times] : other.elapsed_ns_) {
    std::vector<int64_t>& mine = elapsed_ns_[stage];
    mine.insert(mine.end(), times.begin(), times.end());
  }
}

std::vector<WallClock::StageTimes> WallClock::summary() const {
  std::vector<StageTimes> stages;
  for (const auto& [stage, times] : elapsed_ns_) {
    std::vector<int64_t> sorted = times;
    std::sort(sorted.begin(), sorted.end());
    const auto percentile_ms = [&](double share) {
      const auto rank = static_cast<size_t>(std::ceil(share * static_cast<double>(sorted.size())));
      return static_cast<double>(sorted[std::max<size_t>(rank, 1) - 1]) * 1e-6;
    };
    const auto total_ns = std::accumulate(sorted.begin(), sorted.end(), int64_t{0});
    stages.push_back({stage, sorted.size(), percentile_ms(0.5), percentile_ms(0.99),
                      static_cast<double>(total_ns) * 1e-9});
  }
  return stages;
}

double peak_rss_mib() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

int available_cores() {
  cpu_set_t set;
  CPU_ZERO(&set);
  if (sched_getaffinity(0, sizeof set, &set) != 0) return 1;
  return std::max(1, CPU_COUNT(&set));
}

}  // namespace vsslam

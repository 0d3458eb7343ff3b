// Advances several pipelines on a fixed number of threads. What runs when depends on the machine; what each
// step sees does not: a pipeline hands out a step only when its inputs are complete.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <vector>

namespace vsslam {

/// One step: `work` runs on some thread beside other steps, then `commit` alone, under the schedule's lock.
struct Step {
  std::function<void()> work;
  std::function<void()> commit;
  explicit operator bool() const { return static_cast<bool>(work); }
};

class Pipeline {
 public:
  virtual ~Pipeline() = default;
  /// A step that may start now, or an empty one. Called under the schedule's lock.
  virtual Step claim() = 0;
  /// Nothing is left to do and nothing is running.
  virtual bool finished() const = 0;
};

/// Runs all pipelines to their end, at most `threads` of them open at a time, earlier ones first. A finished
/// pipeline is destroyed. One thread: everything runs in the caller's. The first exception of a step ends the
/// run and is rethrown; Interrupted is thrown once `stop` is set. Running steps are always waited for.
void run_pipelines(std::vector<std::unique_ptr<Pipeline>> pipelines, int threads,
                   const std::atomic<bool>& stop);

}  // namespace vsslam

// Wall-clock timing of stages. Nothing below main reads a clock: it is handed in, and may be absent.
#pragma once

#include <cstdint>

namespace vsslam {

/// A monotonic clock and a sink for stage times. Implementations need not be shared between threads.
class StageClock {
 public:
  virtual ~StageClock() = default;
  virtual int64_t now_ns() = 0;
  virtual void record(const char* stage, int64_t elapsed_ns) = 0;
};

/// Times the enclosing scope; does nothing without a clock.
class StageTimer {
 public:
  StageTimer(StageClock* clock, const char* stage)
      : clock_(clock), stage_(stage), start_ns_(clock ? clock->now_ns() : 0) {}
  ~StageTimer() {
    if (clock_) clock_->record(stage_, clock_->now_ns() - start_ns_);
  }
  StageTimer(const StageTimer&) = delete;
  StageTimer& operator=(const StageTimer&) = delete;

 private:
  StageClock* clock_;
  const char* stage_;
  int64_t start_ns_;
};

}  // namespace vsslam

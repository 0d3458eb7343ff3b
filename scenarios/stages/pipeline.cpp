#include "scenarios/stages/pipeline.h"

#include <algorithm>
#include <condition_variable>
#include <cstdlib>
#include <exception>
#include <mutex>
#include <thread>

#include "core/errors.h"

namespace vsslam {

namespace {

class Schedule {
 public:
  Schedule(std::vector<std::unique_ptr<Pipeline>> pipelines, int threads, const std::atomic<bool>& stop)
      : pipelines_(std::move(pipelines)), threads_(std::max(1, threads)), stop_(stop) {}

  void run() {
    std::vector<std::thread> others;
    for (int i = 1; i < threads_; ++i) others.emplace_back([this] { work(); });
    work();
    for (std::thread& other : others) other.join();
    if (error_) std::rethrow_exception(error_);
    if (stop_) throw Interrupted("interrupted");
  }

 private:
  void work() {
    std::unique_lock lock(mutex_);
    while (!error_ && !stop_ && !pipelines_.empty()) {
      Step step = claim();
      if (!step) {
        if (running_ == 0) std::abort();  // a pipeline that is not finished must always have a step
        changed_.wait(lock);
        continue;
      }
      ++running_;
      lock.unlock();
      std::exception_ptr error;
      try {
        step.work();
      } catch (...) {
        error = std::current_exception();
      }
      lock.lock();
      finish(step, error);
    }
    changed_.notify_all();
  }

  Step claim() {
    const size_t open = std::min(pipelines_.size(), static_cast<size_t>(threads_));
    for (size_t i = 0; i < open; ++i)
      if (Step step = pipelines_[i]->claim()) return step;
    return {};
  }

  void finish(const Step& step, const std::exception_ptr& error) {
    --running_;
    if (error) {
      if (!error_) error_ = error;
    } else if (step.commit) {
      step.commit();
    }
    std::erase_if(pipelines_, [](const auto& pipeline) { return pipeline->finished(); });
    changed_.notify_all();
  }

  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<std::unique_ptr<Pipeline>> pipelines_;
  const int threads_;
  const std::atomic<bool>& stop_;
  int running_ = 0;
  std::exception_ptr error_;
};

}  // namespace

void run_pipelines(std::vector<std::unique_ptr<Pipeline>> pipelines, int threads,
                   const std::atomic<bool>& stop) {
  Schedule(std::move(pipelines), threads, stop).run();
}

}  // namespace vsslam

#include "scenarios/stages/pipeline.h"

#include <gtest/gtest.h>

#include <set>

#include "core/errors.h"

namespace vsslam {
namespace {

// Makes numbers and adds them up, modulo 2^64: a producer and a consumer with a bounded queue.
class Sum final : public Pipeline {
 public:
  Sum(int count, std::vector<uint64_t>& sums, size_t slot, int fail_at = -1,
      std::atomic<bool>* stop = nullptr)
      : count_(count), sums_(sums), slot_(slot), fail_at_(fail_at), stop_(stop) {}

  Step claim() override {
    if (!adding_ && queued_ > 0) {
      adding_ = true;
      return {.work = [this] { sums_[slot_] = sums_[slot_] * 3 + static_cast<uint64_t>(added_); },
              .commit = [this] { --queued_, ++added_, adding_ = false; }};
    }
    if (!making_ && made_ < count_ && queued_ < 4) {
      making_ = true;
      return {.work =
                  [this] {
                    if (made_ == fail_at_) throw InputError("no more");
                    if (stop_ != nullptr && made_ == 5) *stop_ = true;
                  },
              .commit = [this] { ++made_, ++queued_, making_ = false; }};
    }
    return {};
  }
  bool finished() const override { return added_ == count_; }

 private:
  int count_;
  std::vector<uint64_t>& sums_;
  size_t slot_;
  int fail_at_;
  std::atomic<bool>* stop_;
  int made_ = 0, queued_ = 0, added_ = 0;
  bool making_ = false, adding_ = false;
};

std::vector<uint64_t> sums_with(int threads) {
  std::vector<uint64_t> sums(5);
  std::vector<std::unique_ptr<Pipeline>> pipelines;
  for (size_t i = 0; i < sums.size(); ++i) pipelines.push_back(std::make_unique<Sum>(30, sums, i));
  run_pipelines(std::move(pipelines), threads, std::atomic<bool>(false));
  return sums;
}

TEST(Pipelines, GiveTheSameForAnyNumberOfThreads) {
  const std::vector<uint64_t> one = sums_with(1);
  EXPECT_NE(one[0], 0u);
  EXPECT_EQ(std::set<uint64_t>(one.begin(), one.end()).size(), 1u);
  EXPECT_EQ(sums_with(2), one);
  EXPECT_EQ(sums_with(7), one);
}

TEST(Pipelines, NothingToDoEndsAtOnce) {
  run_pipelines({}, 3, std::atomic<bool>(false));
}

TEST(Pipelines, AnExceptionEndsTheRun) {
  for (const int threads : {1, 3}) {
    std::vector<uint64_t> sums(2);
    std::vector<std::unique_ptr<Pipeline>> pipelines;
    pipelines.push_back(std::make_unique<Sum>(1000, sums, 0));
    pipelines.push_back(std::make_unique<Sum>(1000, sums, 1, 7));
    EXPECT_THROW(run_pipelines(std::move(pipelines), threads, std::atomic<bool>(false)), InputError);
  }
}

TEST(Pipelines, AStopIsAnInterruption) {
  for (const int threads : {1, 3}) {
    std::atomic<bool> stop = false;
    std::vector<uint64_t> sums(1);
    std::vector<std::unique_ptr<Pipeline>> pipelines;
    pipelines.push_back(std::make_unique<Sum>(1000000000, sums, 0, -1, &stop));
    EXPECT_THROW(run_pipelines(std::move(pipelines), threads, stop), Interrupted);
  }
}

}  // namespace
}  // namespace vsslam

#include "core/ordered_parallel.h"

#include <gtest/gtest.h>

#include <stdexcept>
#include <string>
#include <vector>

namespace vsslam {
namespace {

TEST(OrderedParallel, SameSlotsForAnyThreadCount) {
  std::vector<std::vector<double>> results;
  for (int threads : {1, 2, 5}) {
    set_thread_count(threads);
    std::vector<double> slots(1003);
    parallel_pieces(slots.size(), 10, [&](size_t begin, size_t end) {
      EXPECT_LE(end - begin, 10u);
      for (size_t i = begin; i < end; ++i) slots[i] = 1.0 / static_cast<double>(i + 1);
    });
    results.push_back(slots);
  }
  EXPECT_EQ(results[0], results[1]);
  EXPECT_EQ(results[0], results[2]);
}

TEST(OrderedParallel, RethrowsTheLowestPiece) {
  for (int threads : {1, 2}) {
    set_thread_count(threads);
    try {
      parallel_pieces(100, 1, [](size_t i, size_t) {
        if (i >= 40) throw std::runtime_error(std::to_string(i));
      });
      FAIL();
    } catch (const std::runtime_error& e) {
      EXPECT_STREQ(e.what(), "40");
    }
  }
}

TEST(OrderedParallel, NothingToDo) {
  parallel_pieces(0, 10, [](size_t, size_t) { FAIL(); });
}

}  // namespace
}  // namespace vsslam

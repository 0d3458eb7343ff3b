// Parallel loops whose results do not depend on the number of threads: each iteration writes its own slot,
// sums are added afterwards in index order.
#pragma once

#include <cstddef>
#include <functional>

namespace vsslam {

/// Sets how many threads parallel loops of this process use (>= 1). Call once, from main.
void set_thread_count(int threads);
int thread_count();

/// Calls body(begin, end) over disjoint pieces of [0, size) of at most `grain` indices each. The pieces are
/// the same for any number of threads. body must write only slots of its own indices. Exceptions: the one
/// of the lowest piece is rethrown.
void parallel_pieces(size_t size, size_t grain, const std::function<void(size_t, size_t)>& body);

}  // namespace vsslam

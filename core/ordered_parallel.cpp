#include "core/ordered_parallel.h"

#include <tbb/global_control.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <exception>
#include <memory>
#include <thread>
#include <vector>

#if defined(VSSLAM_TSAN)
#include <sanitizer/tsan_interface.h>
#endif

namespace vsslam {

namespace {

std::unique_ptr<tbb::global_control>& limit() {
  static std::unique_ptr<tbb::global_control> control;
  return control;
}

// The thread sanitizer cannot see the fork and join of TBB.
void announce([[maybe_unused]] void* address) {
#if defined(VSSLAM_TSAN)
  __tsan_release(address);
#endif
}
void observe([[maybe_unused]] void* address) {
#if defined(VSSLAM_TSAN)
  __tsan_acquire(address);
#endif
}

}  // namespace

void set_thread_count(int threads) {
  limit() = std::make_unique<tbb::global_control>(tbb::global_control::max_allowed_parallelism,
                                                  static_cast<size_t>(std::max(1, threads)));
}

int thread_count() {
  return static_cast<int>(tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism));
}

void parallel_pieces(size_t size, size_t grain, const std::function<void(size_t, size_t)>& body) {
  grain = std::max<size_t>(1, grain);
  const size_t pieces = (size + grain - 1) / grain;
  if (pieces <= 1 || thread_count() == 1) {
    for (size_t i = 0; i < pieces; ++i) body(i * grain, std::min(size, (i + 1) * grain));
    return;
  }
  std::vector<std::exception_ptr> errors(pieces);
  announce(&errors);
  tbb::parallel_for(
      size_t{0}, pieces,
      [&](size_t i) {
        observe(&errors);
        try {
          body(i * grain, std::min(size, (i + 1) * grain));
        } catch (...) {
          errors[i] = std::current_exception();
        }
        announce(&errors);
      },
      tbb::simple_partitioner{});
  observe(&errors);
  for (const std::exception_ptr& error : errors)
    if (error) std::rethrow_exception(error);
}

}  // namespace vsslam

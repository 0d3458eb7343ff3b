// Puts the samples of a recording in order, and keeps out what the estimator must not see.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "scenarios/datasets/import/recording.h"

namespace vsslam {

/// What became of one sensor's samples.
struct SampleCounts {
  int64_t used = 0;
  int64_t late = 0;        ///< dropped: a later one had gone its way
  int64_t duplicates = 0;  ///< dropped: the same stamp again, or an earlier one
  int64_t stray = 0;       ///< dropped: a stamp that ran ahead of the others, and the next one did not follow
  int64_t empty = 0;       ///< dropped: scans without points
  int64_t unreadable = 0;  ///< dropped: broken messages
  int64_t moved = 0;       ///< used, with a stamp moved to the clock of the others
  int64_t gaps = 0;        ///< intervals of more than three usual ones
  double longest_gap_s = 0;
  std::optional<Time> first_gap;  ///< the stamp before it, as recorded
};

/// Samples in order of the end of their acquisition (ties: IMU, wheels, LiDAR, camera), as far as a window of time can
/// put them in order: that of the recording, unless another is given. Stamps are counted from a whole second, that of the earliest sample in the first window. Holds no
/// more than the window's samples, and no more of them than some memory: then the first goes its way early.
class SampleOrder {
 public:
  explicit SampleOrder(Recording& recording, std::optional<Duration> window = std::nullopt,
                       size_t most_bytes = size_t{512} << 20)
      : recording_(recording), window_(window.value_or(recording.window())), most_bytes_(most_bytes) {}

  std::optional<RecordedSample> next();
  /// Add it to a stamp to get the recorded one. Known after the first sample.
  Duration epoch() const { return epoch_.value_or(Duration{}); }
  const SampleCounts& counts(size_t sensor) const { return counts_[sensor]; }

 private:
  struct Intervals {
    std::optional<Time> last;
    std::vector<int64_t> recent_ns;
    size_t next = 0;
    std::optional<int64_t> usual_ns() const;
    void add(int64_t ns);
  };
  using Key = std::tuple<Time, size_t, int64_t>;  // end, sensor, number of arrival

  void fill();
  bool enough() const;
  void take(RecordedSample sample);
  bool accept(const RecordedSample& sample);
  void watch(size_t sensor, Time stamp);
  RecordedSample counted_from_epoch(RecordedSample sample) const;

  Recording& recording_;
  Duration window_;
  size_t most_bytes_, bytes_ = 0;  // that may wait, that wait
  std::map<Key, RecordedSample> waiting_;
  std::optional<Time> newest_, released_;
  std::optional<RecordedSample>
      ahead_;  // far ahead of the newest; the next sample tells whether that is true
  std::optional<Duration> epoch_;
  int64_t arrived_ = 0;
  bool ended_ = false;
  std::array<SampleCounts, kSensors> counts_{};
  std::array<Intervals, kSensors> intervals_{};
};

}  // namespace vsslam

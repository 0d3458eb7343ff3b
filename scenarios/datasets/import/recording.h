// A recording as samples: whatever its format, it comes through here to the estimator.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/samples.h"

namespace vsslam {

/// Alternatives in the order in which samples that end together are handed out.
using Sample = std::variant<ImuSample, WheelSample, LidarScan, CameraFrame>;
inline constexpr size_t kSensors = std::variant_size_v<Sample>;
inline constexpr const char* kSensorNames[kSensors] = {"imu", "wheels", "lidar", "camera"};

inline Time stamp_of(const Sample& sample) {
  return std::visit([](const auto& s) { return s.stamp; }, sample);
}

struct RecordedSample {
  Sample sample;
  Time end;            ///< of its acquisition, on the clock of the stamps
  bool moved = false;  ///< its stamp was moved to the clock of the others
};

/// A topic or a file that a recording has.
struct RecordedStream {
  std::string name, type;
  uint64_t messages = 0;
  std::string used_as;  ///< a sensor's name, "truth", or empty: passed over
};

/// What is known of a recording before it is read.
struct RecordingFacts {
  std::string format;                   ///< for a person: "bag or MCAP", "KITTI folder", ...
  std::vector<RecordedStream> streams;  ///< sorted by name
  double expected_duration_s = 0;
  bool has[kSensors] = {};  ///< by index of Sample
  int rings = 0;            ///< that the first scans' points tell of; 0: they tell nothing
};

/// Not thread-safe.
class Recording {
 public:
  virtual ~Recording() = default;
  virtual const RecordingFacts& facts() const = 0;
  /// In order of recording, which is about that of `end`; nullopt: the end. Stamps as recorded, but for those that
  /// were moved. Throws InputError that names the topic or file and the message.
  virtual std::optional<RecordedSample> next() = 0;
  /// Samples that are put in order of `end` within it: none comes later, as far as is known beforehand.
  virtual Duration window() const { return {1'000'000'000}; }
  /// So many of a sensor's messages could not be read so far, and were left out.
  virtual int64_t unreadable([[maybe_unused]] size_t sensor) const { return 0; }
  /// T_world_base as far as it was read.
  virtual const std::vector<StampedPose>& truth_world_base() const { return no_truth_; }
  /// What was guessed or found odd so far, one line each.
  virtual std::vector<std::string> notes() const { return {}; }

 private:
  std::vector<StampedPose> no_truth_;
};

}  // namespace vsslam

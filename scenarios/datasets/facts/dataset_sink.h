// The way into a dataset: every format is a sink of simulated measurements with their truth.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "sensors/measurement/samples.h"
#include "sim/trajectory.h"

namespace vsslam {

/// Datasets' time 0 since 1970: consumers take a stamp of 0 as unset.
inline constexpr Duration kDatasetEpoch{1'700'000'000'000'000'000};
/// Time of a dataset from time of the simulation.
inline Time dataset_time(Time simulated) {
  return simulated + kDatasetEpoch;
}

/// One measurement, on simulated time.
struct DatasetSample {
  Measurement measurement;  ///< without points or pixels if no sink needs them
  Time end{};               ///< of the acquisition, true time
  Kinematics base{};        ///< truth of the base at the measurement's true stamp
  int64_t index = 0;        ///< among the measurements of its kind
  std::string png{};        ///< of an image, if a sink wants it
};

/// Not thread-safe but for the const functions, which are called while write runs.
class DatasetSink {
 public:
  virtual ~DatasetSink() = default;
  /// Is the content of this scan, or image, still to be written here? `stamp`: the sensor's, simulated time.
  virtual bool needs_scan(int64_t index, Time stamp) const = 0;
  virtual bool needs_image(Time stamp) const = 0;
  /// PNG file of the image as the camera delivers it, which exists if it is not needed; empty: none is written here.
  virtual std::filesystem::path image_file(Time) const { return {}; }
  virtual bool wants_point_truth() const { return false; }
  virtual bool wants_png() const { return false; }
  /// In order of `end`. Throws ResourceError.
  virtual void write(const DatasetSample& sample) = 0;
  /// After the last sample. Tables and containers appear under their names here.
  virtual void finish() = 0;
};

}  // namespace vsslam

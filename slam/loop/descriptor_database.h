// The stored Scan Contexts, any subset of the key scans in order, and the search for the most similar one.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "core/time.h"
#include "slam/loop/scan_context.h"

namespace vsslam {

/// One descriptor of a query: of the scan itself, or of the scan seen from a virtual position.
struct QueryDescriptor {
  ScanContext context;
  int virtual_id = 0;  ///< 0: the scan itself
  /// Virtual position of the sensor in the lidar frame.
  Eigen::Vector2d offset_m = Eigen::Vector2d::Zero();
};

struct DescriptorMatch {
  size_t entry = 0;       ///< in DescriptorDatabase::entries()
  size_t descriptor = 0;  ///< in the query
  ShiftedDistance best;
  std::optional<double> runner_up_distance;  ///< to the best of the other entries that were compared
};

class DescriptorDatabase {
 public:
  struct Entry {
    int key = -1;  ///< key scan id
    Time stamp;
    ScanContext context;
  };

  /// Queries of more than `exhaustive_pairs` descriptor pairs compare the nearest ring keys only.
  explicit DescriptorDatabase(int exhaustive_pairs);

  /// Entries come in ascending order of key and stamp.
  void add(int key, Time stamp, const ScanContext& context);
  const std::vector<Entry>& entries() const { return entries_; }
  /// How many entries are of key scans up to `last_key` made no later than `last_stamp`.
  size_t count_until(int last_key, Time last_stamp) const;

  /// Which entries a search may find.
  using Filter = std::function<bool(const Entry&)>;

  /// The nearest to any of the descriptors among those of the first `eligible` entries that `may_match` (null:
  /// all). Equal distances: the lower entry, then the lower descriptor.
  std::optional<DescriptorMatch> find(std::span<const QueryDescriptor> query, size_t eligible,
                                      const Filter& may_match = nullptr) const;

 private:
  std::vector<size_t> candidates(std::span<const QueryDescriptor> query, size_t eligible,
                                 const Filter& may_match) const;
  void add_nearest_ring_keys(const ScanContext& context, std::span<const size_t> among,
                             std::vector<size_t>& out) const;

  using RingKey = decltype(ScanContext::ring_key);

  int exhaustive_pairs_;
  std::vector<Entry> entries_;
  std::vector<RingKey> ring_keys_;  // of the entries, side by side for the search
};

}  // namespace vsslam

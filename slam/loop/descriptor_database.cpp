#include "slam/loop/descriptor_database.h"

#include <algorithm>
#include <utility>

namespace vsslam {

namespace {
constexpr size_t kNearestRingKeys = 10;
}  // namespace

DescriptorDatabase::DescriptorDatabase(int exhaustive_pairs) : exhaustive_pairs_(exhaustive_pairs) {}

void DescriptorDatabase::add(int key, Time stamp, const ScanContext& context) {
  entries_.push_back({key, stamp, context});
  ring_keys_.push_back(context.ring_key);
}

size_t DescriptorDatabase::count_until(int last_key, Time last_stamp) const {
  const auto end = std::partition_point(entries_.begin(), entries_.end(), [&](const Entry& entry) {
    return entry.key <= last_key && entry.stamp <= last_stamp;
  });
  return static_cast<size_t>(end - entries_.begin());
}

// Of those among.
void DescriptorDatabase::add_nearest_ring_keys(const ScanContext& context, std::span<const size_t> among,
                                               std::vector<size_t>& out) const {
  std::vector<std::pair<float, size_t>> nearest;
  nearest.reserve(among.size());
  for (const size_t entry : among)
    nearest.emplace_back((ring_keys_[entry] - context.ring_key).squaredNorm(), entry);
  const size_t count = std::min(kNearestRingKeys, nearest.size());
  std::partial_sort(nearest.begin(), nearest.begin() + static_cast<std::ptrdiff_t>(count), nearest.end());
  for (size_t i = 0; i < count; ++i) out.push_back(nearest[i].second);
}

std::vector<size_t> DescriptorDatabase::candidates(std::span<const QueryDescriptor> query, size_t eligible,
                                                   const Filter& may_match) const {
  std::vector<size_t> all;
  for (size_t entry = 0; entry < eligible; ++entry)
    if (!may_match || may_match(entries_[entry])) all.push_back(entry);
  if (query.size() * all.size() <= static_cast<size_t>(exhaustive_pairs_)) return all;
  std::vector<size_t> nearest;
  for (const QueryDescriptor& descriptor : query) add_nearest_ring_keys(descriptor.context, all, nearest);
  std::sort(nearest.begin(), nearest.end());
  nearest.erase(std::unique(nearest.begin(), nearest.end()), nearest.end());
  return nearest;
}

std::optional<DescriptorMatch> DescriptorDatabase::find(std::span<const QueryDescriptor> query,
                                                        size_t eligible, const Filter& may_match) const {
  std::optional<DescriptorMatch> found;
  std::optional<double> runner_up;
  for (size_t entry : candidates(query, std::min(eligible, entries_.size()), may_match)) {
    DescriptorMatch match{entry, 0, scan_context_distance(query[0].context, entries_[entry].context), {}};
    for (size_t d = 1; d < query.size(); ++d) {
      const ShiftedDistance other = scan_context_distance(query[d].context, entries_[entry].context);
      if (other.distance < match.best.distance) match = {entry, d, other, {}};
    }
    const bool nearer = !found || match.best.distance < found->best.distance;
    const std::optional<double> second = nearer ? (found ? std::optional(found->best.distance) : std::nullopt)
                                                : std::optional(match.best.distance);
    if (second && (!runner_up || *second < *runner_up)) runner_up = second;
    if (nearer) found = match;
  }
  if (found) found->runner_up_distance = runner_up;
  return found;
}

}  // namespace vsslam

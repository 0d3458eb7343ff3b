#include "slam/loop/descriptor_database.h"

#include <algorithm>
#include <nanoflann.hpp>
#include <numeric>
#include <utility>

namespace vsslam {

namespace {
constexpr size_t kNearestRingKeys = 10;
constexpr int kLeafSize = 16;
}  // namespace

/// nanoflann's tree over the first `size` ring keys.
class DescriptorDatabase::RingKeyTree {
 public:
  RingKeyTree(const std::vector<RingKey>& ring_keys, size_t size)
      : points_{ring_keys, size},
        index_(kRings, points_, nanoflann::KDTreeSingleIndexAdaptorParams(kLeafSize)) {}

  size_t size() const { return points_.size; }

  std::vector<std::pair<float, size_t>> nearest(const ScanContext& context, size_t count) const {
    std::vector<size_t> indices(count);
    std::vector<float> squared(count);
    const size_t found = index_.knnSearch(context.ring_key.data(), count, indices.data(), squared.data());
    std::vector<std::pair<float, size_t>> out;
    for (size_t i = 0; i < found; ++i) out.emplace_back(squared[i], indices[i]);
    return out;
  }

 private:
  struct Points {
    const std::vector<RingKey>& ring_keys;
    size_t size;
    size_t kdtree_get_point_count() const { return size; }
    float kdtree_get_pt(size_t i, size_t dimension) const {
      return ring_keys[i][static_cast<Eigen::Index>(dimension)];
    }
    template <class Box>
    bool kdtree_get_bbox(Box&) const {
      return false;
    }
  };
  Points points_;
  nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Adaptor<float, Points>, Points, kRings, size_t> index_;
};

DescriptorDatabase::DescriptorDatabase(int exhaustive_pairs) : exhaustive_pairs_(exhaustive_pairs) {}
DescriptorDatabase::~DescriptorDatabase() = default;

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

void DescriptorDatabase::nearest_ring_keys(const ScanContext& context, size_t eligible,
                                           std::vector<size_t>& out) const {
  std::vector<std::pair<float, size_t>> nearest;
  const size_t in_tree = tree_ ? tree_->size() : 0;
  if (tree_) nearest = tree_->nearest(context, std::min(kNearestRingKeys, in_tree));
  for (size_t i = in_tree; i < eligible; ++i)
    nearest.emplace_back((ring_keys_[i] - context.ring_key).squaredNorm(), i);
  const size_t count = std::min(kNearestRingKeys, nearest.size());
  std::partial_sort(nearest.begin(), nearest.begin() + static_cast<std::ptrdiff_t>(count), nearest.end());
  for (size_t i = 0; i < count; ++i) out.push_back(nearest[i].second);
}

std::vector<size_t> DescriptorDatabase::candidates(std::span<const QueryDescriptor> query, size_t eligible,
                                                   const Filter& may_match) {
  const auto excluded = [&](size_t entry) { return may_match && !may_match(entries_[entry]); };
  std::vector<size_t> out(eligible);
  std::iota(out.begin(), out.end(), size_t{0});
  std::erase_if(out, excluded);
  if (query.size() * out.size() <= static_cast<size_t>(exhaustive_pairs_)) return out;
  out.clear();
  // The tree is rebuilt when an eighth of the entries is outside it, or when it holds entries that are not
  // eligible.
  if (!tree_ || tree_->size() > eligible || eligible - tree_->size() > eligible / 8)
    tree_ = std::make_unique<RingKeyTree>(ring_keys_, eligible);
  for (const QueryDescriptor& descriptor : query) nearest_ring_keys(descriptor.context, eligible, out);
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  std::erase_if(out, excluded);
  return out;
}

std::optional<DescriptorMatch> DescriptorDatabase::find(std::span<const QueryDescriptor> query,
                                                        size_t eligible, const Filter& may_match) {
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

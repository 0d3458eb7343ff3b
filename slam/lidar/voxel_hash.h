// Voxels without std::unordered_map: open addressing, entries numbered in order of their first insertion, so
// that whoever walks over them always does so in the same order.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstdint>
#include <vector>

namespace vsslam {

/// Packs voxel coordinates and a small tag (0..15) into one key. Coordinates wrap at +-2^19 voxels.
inline uint64_t voxel_key(const Eigen::Vector3f& point, float inverse_voxel, unsigned tag = 0) {
  const auto cell = [&](float v) {
    return static_cast<uint64_t>(static_cast<int64_t>(std::floor(v * inverse_voxel))) & 0xFFFFFu;
  };
  return cell(point.x()) | cell(point.y()) << 20 | cell(point.z()) << 40 |
         static_cast<uint64_t>(tag & 15u) << 60;
}

/// Numbers distinct keys 0, 1, 2, ... in order of insertion.
class KeyIndex {
 public:
  explicit KeyIndex(size_t expected = 64) { reset(expected); }
  void reset(size_t expected) {
    size_t capacity = 64;
    while (capacity < 2 * expected) capacity *= 2;
    slots_.assign(capacity, {0, -1});
    size_ = 0;
  }
  /// Number of the key, which is size() - 1 if it is new.
  int insert(uint64_t key) {
    if (2 * (size_ + 1) > slots_.size()) grow();
    Slot& slot = slots_[find_slot(key)];
    if (slot.number < 0) slot = {key, static_cast<int>(size_++)};
    return slot.number;
  }
  /// -1 if absent.
  int find(uint64_t key) const { return slots_[find_slot(key)].number; }
  size_t size() const { return size_; }

 private:
  struct Slot {
    uint64_t key;
    int number;
  };
  size_t find_slot(uint64_t key) const {
    uint64_t h = key * 0x9E3779B97F4A7C15ull;
    h ^= h >> 32;
    size_t at = h & (slots_.size() - 1);
    while (slots_[at].number >= 0 && slots_[at].key != key) at = (at + 1) & (slots_.size() - 1);
    return at;
  }
  void grow() {
    std::vector<Slot> old(2 * slots_.size(), Slot{0, -1});
    old.swap(slots_);
    for (const Slot& slot : old)
      if (slot.number >= 0) slots_[find_slot(slot.key)] = slot;
  }
  std::vector<Slot> slots_;
  size_t size_ = 0;
};

}  // namespace vsslam

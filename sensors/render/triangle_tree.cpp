#include "sensors/render/triangle_tree.h"

#include <algorithm>
#include <array>
#include <limits>
#include <span>

namespace vsslam {

namespace {

constexpr size_t kWidth = 8;
constexpr size_t kBins = 16;
constexpr float kFar_m = 1e30f;  // finite, since a beam's plane may multiply it by zero

struct Box {
  Vec3f low = Vec3f::Constant(kFar_m), high = Vec3f::Constant(-kFar_m);
  void add(const Vec3f& p) { low = low.cwiseMin(p), high = high.cwiseMax(p); }
  void add(const Box& b) { low = low.cwiseMin(b.low), high = high.cwiseMax(b.high); }
  float half_area() const {
    const Vec3f s = (high - low).cwiseMax(0.0f);
    return s.x() * s.y() + s.y() * s.z() + s.z() * s.x();
  }
};

struct Item {
  Box box;
  uint32_t triangle;
  Vec3f middle() const { return 0.5f * (box.low + box.high); }
};

/// Items and the box around them.
struct Group {
  std::span<Item> items;
  Box box;
  explicit Group(std::span<Item> all) : items(all) {
    for (const Item& item : items) box.add(item.box);
  }
};

struct Bin {
  Box box;
  size_t count = 0;
};

/// Where the items are cut: bins of their middles along an axis, the first `bins` to one side.
struct Cut {
  int axis = 0;
  float low = 0, per_bin = 0;
  size_t bins = 0;
  size_t bin(const Item& item) const {
    return std::min(kBins - 1, static_cast<size_t>(std::max(0.0f, (item.middle()[axis] - low) * per_bin)));
  }
};

/// The number of bins to one side for which the sum of area times count is least.
size_t cheapest(const std::array<Bin, kBins>& bins) {
  std::array<float, kBins> right_cost{};
  Bin right;
  for (size_t i = kBins - 1; i > 0; --i) {
    right.box.add(bins[i].box), right.count += bins[i].count;
    right_cost[i] = right.box.half_area() * static_cast<float>(right.count);
  }
  Bin left;
  size_t best = kBins / 2;
  float least = std::numeric_limits<float>::max();
  for (size_t i = 1; i < kBins; ++i) {
    left.box.add(bins[i - 1].box), left.count += bins[i - 1].count;
    const float cost = left.box.half_area() * static_cast<float>(left.count) + right_cost[i];
    if (left.count > 0 && cost < least) least = cost, best = i;
  }
  return best;
}

/// Reorders the items and returns how many lie to one side; neither side is empty.
size_t split(std::span<Item> items) {
  Box middles;
  for (const Item& item : items) middles.add(item.middle());
  Cut cut;
  const float extent_m = (middles.high - middles.low).maxCoeff(&cut.axis);
  if (!(extent_m > 0)) return items.size() / 2;
  cut.low = middles.low[cut.axis];
  cut.per_bin = static_cast<float>(kBins) / extent_m;
  std::array<Bin, kBins> bins{};
  for (const Item& item : items) {
    Bin& bin = bins[cut.bin(item)];
    bin.box.add(item.box), ++bin.count;
  }
  cut.bins = cheapest(bins);
  const auto middle = std::stable_partition(items.begin(), items.end(),
                                            [&](const Item& item) { return cut.bin(item) < cut.bins; });
  const auto left = static_cast<size_t>(middle - items.begin());
  return left == 0 || left == items.size() ? items.size() / 2 : left;
}

/// Cuts the largest group that does not fit a leaf, until there are eight or all fit.
std::vector<Group> children_of(std::span<Item> items) {
  std::vector<Group> groups{Group(items)};
  while (groups.size() < kWidth) {
    size_t largest = kWidth;
    for (size_t i = 0; i < groups.size(); ++i)
      if (groups[i].items.size() > kWidth &&
          (largest == kWidth || groups[i].box.half_area() > groups[largest].box.half_area()))
        largest = i;
    if (largest == kWidth) break;
    const std::span<Item> whole = groups[largest].items;
    const size_t left = split(whole);
    groups[largest] = Group(whole.first(left));
    groups.emplace_back(whole.subspan(left));
  }
  return groups;
}

class Builder {
 public:
  Builder(const PlacedTriangles& triangles, TriangleTree& tree) : triangles_(triangles), tree_(tree) {}

  int32_t node(std::span<Item> items) {
    const size_t index = tree_.nodes.size();
    tree_.nodes.emplace_back();
    const std::vector<Group> groups = children_of(items);
    for (size_t i = 0; i < kWidth; ++i) {
      const Box box = i < groups.size() ? groups[i].box : Box{};
      int32_t child = 0;
      if (i < groups.size())
        child = groups[i].items.size() > kWidth ? node(groups[i].items) : leaf(groups[i].items);
      TreeNode& to = tree_.nodes[index];
      to.child[i] = child;
      for (int axis = 0; axis < 3; ++axis)
        to.bounds[0][axis][i] = box.low[axis], to.bounds[1][axis][i] = box.high[axis];
    }
    return static_cast<int32_t>(index);
  }

 private:
  int32_t leaf(std::span<const Item> items) {
    TreeLeaf leaf{};
    for (size_t i = 0; i < items.size(); ++i) {
      leaf.triangle[i] = items[i].triangle;
      const PlacedTriangle& t = triangles_.all[items[i].triangle];
      for (size_t corner = 0; corner < 3; ++corner)
        for (int axis = 0; axis < 3; ++axis) leaf.corners[corner][axis][i] = t.corners_world[corner][axis];
    }
    tree_.leaves.push_back(leaf);
    return ~static_cast<int32_t>(tree_.leaves.size() - 1);
  }

  const PlacedTriangles& triangles_;
  TriangleTree& tree_;
};

// A little larger than the triangle, by more than what rounding can do to a test against a plane.
Box box_of(const PlacedTriangle& t) {
  Box box;
  for (const Vec3f& corner : t.corners_world) box.add(corner);
  const float margin_m =
      1e-5f + 1e-6f * std::max(box.low.cwiseAbs().maxCoeff(), box.high.cwiseAbs().maxCoeff());
  box.low.array() -= margin_m;
  box.high.array() += margin_m;
  return box;
}

}  // namespace

TriangleTree::TriangleTree(const PlacedTriangles& triangles) {
  std::vector<Item> items;
  items.reserve(triangles.all.size());
  for (size_t i = 0; i < triangles.all.size(); ++i)
    if (triangles.all[i].area_m2 > 0) items.push_back({box_of(triangles.all[i]), static_cast<uint32_t>(i)});
  Builder(triangles, *this).node(items);
  nodes.shrink_to_fit();
  leaves.shrink_to_fit();
}

void TriangleTree::rename(const std::vector<uint32_t>& names) {
  for (TreeLeaf& leaf : leaves)
    for (uint32_t& triangle : leaf.triangle)
      if (triangle < names.size()) triangle = names[triangle];
}

}  // namespace vsslam

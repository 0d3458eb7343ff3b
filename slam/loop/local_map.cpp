#include "slam/loop/local_map.h"

#include <algorithm>

#include "slam/lidar/voxel_hash.h"

namespace vsslam {

namespace {

constexpr size_t kKeptMaps = 4;

void append_transformed(const Cloud& cloud_b, const SE3& T_a_b, Cloud& out_a) {
  const Eigen::Matrix3f r = T_a_b.matrix3().cast<float>();
  const Eigen::Vector3f t = T_a_b.translation.cast<float>();
  for (const Eigen::Vector3f& p : cloud_b) out_a.push_back(r * p + t);
}

bool same_pose(const SE3& a, const SE3& b) {
  return a.translation == b.translation && a.rotation.coeffs() == b.rotation.coeffs();
}

}  // namespace

Cloud features_in_base(const KeyScan& key, const SE3& T_base_lidar) {
  Cloud cloud_base;
  cloud_base.reserve(key.features_lidar->size());
  append_transformed(*key.features_lidar, T_base_lidar, cloud_base);
  return cloud_base;
}

Cloud voxel_means(const Cloud& cloud, double voxel_m) {
  const auto inverse_voxel = static_cast<float>(1.0 / voxel_m);
  KeyIndex voxels(cloud.size() / 4);
  Cloud means;
  std::vector<int> counts;
  for (const Eigen::Vector3f& p : cloud) {
    const auto at = static_cast<size_t>(voxels.insert(voxel_key(p, inverse_voxel)));
    if (at == means.size()) {
      means.emplace_back(Eigen::Vector3f::Zero());
      counts.push_back(0);
    }
    means[at] += p;
    ++counts[at];
  }
  for (size_t i = 0; i < means.size(); ++i) means[i] /= static_cast<float>(counts[i]);
  return means;
}

KeyRange keys_around(int center, int half_width, int key_count) {
  return {std::max(0, center - half_width), std::min(key_count - 1, center + half_width)};
}

std::shared_ptr<const IcpTarget> LocalMaps::around(int center, int query, const std::vector<KeyScan>& keys) {
  const KeyRange range = keys_around(center, config_.half_width_scans, query);
  for (const Kept& kept : kept_)
    if (kept.center == center && kept.range == range && stands(kept, keys)) return kept.target;
  std::erase_if(kept_, [&](const Kept& kept) { return kept.center == center; });
  if (kept_.size() == kKeptMaps) kept_.pop_front();
  return kept_.emplace_back(build(center, range, keys)).target;
}

bool LocalMaps::stands(const Kept& kept, const std::vector<KeyScan>& keys) const {
  for (int id = kept.range.first; id <= kept.range.last; ++id)
    if (!same_pose(kept.T_map_base[static_cast<size_t>(id - kept.range.first)],
                   keys[static_cast<size_t>(id)].T_map_base))
      return false;
  return true;
}

LocalMaps::Kept LocalMaps::build(int center, const KeyRange& range, const std::vector<KeyScan>& keys) const {
  Kept kept{center, range, {}, nullptr};
  const SE3 T_center_map = keys[static_cast<size_t>(center)].T_map_base.inverse();
  Cloud cloud_center;
  for (int id = range.first; id <= range.last; ++id) {
    const KeyScan& key = keys[static_cast<size_t>(id)];
    kept.T_map_base.push_back(key.T_map_base);
    append_transformed(*key.features_lidar, T_center_map * key.T_map_base * T_base_lidar_, cloud_center);
  }
  kept.target = std::make_shared<const IcpTarget>(voxel_means(cloud_center, config_.voxel_m));
  return kept;
}

}  // namespace vsslam

#include "sensors/light/light_map.h"

#include <algorithm>
#include <cmath>

#include "core/ordered_parallel.h"
#include "sensors/light/light_map_bounces.h"
#include "sensors/light/light_map_direct.h"

namespace vsslam {

namespace {

/// One chart's light while it is put together. Per node: direct light of all groups, then indirect.
class ChartLight {
 public:
  ChartLight(const LightMapCharts::Grid& grid, size_t groups)
      : width_(static_cast<int>(grid.width)),
        height_(static_cast<int>(grid.height)),
        groups_(groups),
        values_(2 * groups * grid.width * grid.height),
        known_(size_t{grid.width} * grid.height),
        sum_(2 * groups) {}

  /// Values that are not known are kept, but may be replaced.
  void set(size_t node, const float* direct, const float* indirect, bool known) {
    std::copy(direct, direct + groups_, &values_[2 * groups_ * node]);
    std::copy(indirect, indirect + groups_, &values_[2 * groups_ * node + groups_]);
    known_[node] = known;
  }
  /// Gives what is not known the mean of its known neighbours, ring by ring.
  void fill() {
    constexpr int kRings = 12;
    for (int ring = 0; ring < kRings; ++ring) {
      std::vector<size_t> filled;
      for (size_t node = 0; node < known_.size(); ++node)
        if (!known_[node] && mean(values_, node, 0, &values_[2 * groups_ * node])) filled.push_back(node);
      for (const size_t node : filled) known_[node] = 1;
      if (filled.empty()) return;
    }
  }
  /// Light from other surfaces is smooth, the noise of its sampling is not: a binomial filter.
  void smooth_indirect() {
    const std::vector<float> before = values_;
    for (size_t node = 0; node < known_.size(); ++node)
      if (known_[node]) mean(before, node, groups_, &values_[2 * groups_ * node + groups_]);
  }
  float illuminance(size_t node, size_t group) const {
    const float* values = &values_[2 * groups_ * node];
    return values[group] + values[groups_ + group];
  }
  size_t nodes() const { return known_.size(); }

 private:
  /// Mean of the known nodes among the nine about this one, channels from `first` on; false if there are none.
  bool mean(const std::vector<float>& from, size_t node, size_t first, float* to) {
    const int x = static_cast<int>(node) % width_, y = static_cast<int>(node) / width_;
    const size_t channels = 2 * groups_ - first;
    float weights = 0;
    std::fill(sum_.begin(), sum_.end(), 0.0f);
    for (int j = std::max(0, y - 1); j <= std::min(height_ - 1, y + 1); ++j)
      for (int i = std::max(0, x - 1); i <= std::min(width_ - 1, x + 1); ++i) {
        const auto other = static_cast<size_t>(j * width_ + i);
        if (!known_[other]) continue;
        const float weight = (i == x ? 2.0f : 1.0f) * (j == y ? 2.0f : 1.0f);
        weights += weight;
        for (size_t c = 0; c < channels; ++c) sum_[c] += weight * from[2 * groups_ * other + first + c];
      }
    if (weights == 0) return false;
    for (size_t c = 0; c < channels; ++c) to[c] = sum_[c] / weights;
    return true;
  }

  int width_, height_;
  size_t groups_;
  std::vector<float> values_;
  std::vector<uint8_t> known_;
  std::vector<float> sum_;
};

std::vector<float> direct_light(const LitScene& scene) {
  constexpr size_t kSitesPerPiece = 256;
  std::vector<float> illuminance(scene.charts.sites.size() * scene.lights.groups.size());
  parallel_pieces(scene.charts.sites.size(), kSitesPerPiece,
                  [&](size_t begin, size_t end) { add_direct_light(scene, begin, end, illuminance); });
  return illuminance;
}

}  // namespace

LightMap bake_light_map(const LitScene& scene) {
  const LightMapCharts& charts = scene.charts;
  const size_t groups = scene.lights.groups.size();
  LightMap map{groups, std::vector<float>(charts.nodes * groups)};
  if (groups == 0) return map;
  const std::vector<float> direct = direct_light(scene);
  const IndirectLight indirect = bounce_light(scene, direct);

  // Passes widen the filter as their root: a site with a quarter of the rays borrows from four times the area.
  const size_t smoothing_passes = std::max<size_t>(1, 64 / std::max<size_t>(1, indirect.rays));
  std::vector<size_t> first_site;  // of each chart
  for (size_t c = 0, site = 0; c < charts.grids.size(); ++c) {
    while (site < charts.sites.size() && charts.sites[site].node < charts.grids[c].offset) ++site;
    first_site.push_back(site);
  }
  first_site.push_back(charts.sites.size());
  parallel_pieces(charts.grids.size(), 16, [&](size_t begin, size_t end) {
    for (size_t c = begin; c < end; ++c) {
      const LightMapCharts::Grid& grid = charts.grids[c];
      ChartLight light(grid, groups);
      for (size_t s = first_site[c]; s < first_site[c + 1]; ++s)
        light.set(charts.sites[s].node - grid.offset, &direct[s * groups], &indirect.illuminance[s * groups],
                  !indirect.buried[s]);
      light.fill();
      for (size_t pass = 0; pass < smoothing_passes; ++pass) light.smooth_indirect();
      for (size_t node = 0; node < light.nodes(); ++node)
        for (size_t g = 0; g < groups; ++g)
          map.illuminance[(grid.offset + node) * groups + g] = light.illuminance(node, g);
    }
  });
  return map;
}

std::vector<float> LightMap::combined(const std::vector<float>& levels) const {
  const size_t nodes = groups == 0 ? 0 : illuminance.size() / groups;
  std::vector<float> sum(nodes);
  for (size_t node = 0; node < nodes; ++node)
    for (size_t g = 0; g < groups; ++g) sum[node] += levels[g] * illuminance[node * groups + g];
  return sum;
}

}  // namespace vsslam

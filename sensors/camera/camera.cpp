#include "sensors/camera/camera.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <numeric>

#include "core/ordered_parallel.h"
#include "sensors/camera/camera_blur.h"
#include "sensors/camera/camera_flow.h"

namespace vsslam {

namespace {

// Of the look around that tells how much light there is, and how fast the image flows.
constexpr int kCoarseWidth = 32, kCoarseHeight = 24;

std::vector<float> cos_axis(const ViewRays& rays) {
  std::vector<float> cosines;
  for (const Vec3f& ray : rays.direction_camera) cosines.push_back(ray.z());
  return cosines;
}

// A permutation of 0 .. samples - 1, spread against its own index: (k + 1) g mod (samples + 1) - 1 with the factor g that
// correlates least.
std::vector<int> spread_order(int samples) {
  std::vector<int> best;
  int least = std::numeric_limits<int>::max();
  for (int g = 2; g <= samples; ++g) {
    if (std::gcd(g, samples + 1) > 1) continue;
    std::vector<int> order;
    int covariance = 0;
    for (int k = 0; k < samples; ++k) {
      order.push_back((k + 1) * g % (samples + 1) - 1);
      covariance += (2 * k - (samples - 1)) * (2 * order.back() - (samples - 1));
    }
    if (std::abs(covariance) >= least) continue;
    least = std::abs(covariance);
    best = order;
  }
  return best;
}

// Over the pixel's square, its centre of gravity in the middle.
std::vector<ViewRays> sample_rays(const CameraOptics& optics, int samples) {
  std::vector<ViewRays> rays;
  const std::vector<int> order = spread_order(samples);
  for (size_t k = 0; k < order.size(); ++k)
    rays.push_back(
        optics.rays({(order[k] + 0.5) / samples - 0.5, (static_cast<double>(k) + 0.5) / samples - 0.5}));
  return rays;
}

}  // namespace

Camera::Camera(const CameraConfig& config, const SensorEvents& events, uint64_t seed)
    : config_(config),
      dropouts_(events.camera_dropouts),
      covered_(events.camera_covered),
      optics_(config),
      centre_rays_(optics_.rays()),
      coarse_rays_(optics_.coarse_rays(kCoarseWidth, kCoarseHeight)),
      sample_rays_(sample_rays(optics_, config.samples_per_pixel)),
      sensor_(config, cos_axis(centre_rays_), seed),
      control_(config) {}

Time Camera::stamp_of(int64_t index) const {
  return Time::from_seconds(config_.phase_s) +
         Duration{std::llround(static_cast<double>(index) * (1e9 / config_.rate_hz))};
}

Time Camera::begin(int k) const {
  return stamp(k) - Duration{control_.ahead(k).time.ns / 2};
}

Time Camera::end(int k) const {
  return stamp(k) + Duration{control_.ahead(k).time.ns / 2};
}

void Camera::power_on(Time first) {
  first_ = first;
  next_ = static_cast<int64_t>(std::floor((first.seconds() - config_.phase_s) * config_.rate_hz)) - 1;
  while (begin() < first) ++next_;
}

Time Camera::needed_from() const {
  return config_.truth.flow ? std::max(first_, stamp_of(next_ - 1)) : begin();
}

std::vector<CameraMeasurement> Camera::take(int count, const Trajectory& trajectory, const SE3& T_base_camera,
                                            const ViewSource& source) {
  std::vector<Shot> shots;
  for (int k = 0; k < count; ++k)
    if (!any_lasts(dropouts_, stamp(k)))
      shots.push_back({next_ + k, stamp(k), control_.ahead(k), trajectory, T_base_camera, source});
  std::vector<CameraMeasurement> images(shots.size());
  std::vector<double> mean_grey(shots.size());
  workshops_.resize(std::max(workshops_.size(), shots.size()));
  parallel_pieces(shots.size(), 1,
                  [&](size_t i, size_t) { mean_grey[i] = take_one(shots[i], workshops_[i], images[i]); });
  for (size_t i = 0; i < static_cast<size_t>(count); ++i, ++next_) {
    const auto taken =
        std::find_if(shots.begin(), shots.end(), [&](const Shot& s) { return s.index == next_; });
    if (taken == shots.end())
      control_.missed();
    else
      control_.saw(mean_grey[static_cast<size_t>(taken - shots.begin())]);
  }
  return images;
}

SE3 Camera::Shot::T_world_camera(double share) const {
  return T_world_camera(stamp +
                        Duration{std::llround((share - 0.5) * static_cast<double>(exposure.time.ns))});
}

double Camera::transmission(Time stamp) const {
  double share = 1;
  for (const CoveredLens& cover : covered_)
    if (cover.contains(stamp)) share *= cover.transmission;
  return share;
}

double Camera::take_one(const Shot& shot, Workshop& workshop, CameraMeasurement& out) const {
  out.true_stamp = out.frame.stamp = shot.stamp;
  out.end = shot.stamp + Duration{shot.exposure.time.ns / 2};
  out.T_world_camera = shot.T_world_camera(shot.stamp);
  out.exposure_s = shot.exposure.time.seconds();
  out.gain = shot.exposure.gain;
  out.frame.width_px = config_.width_px;
  out.frame.height_px = config_.height_px;
  if (taken_before_)
    if (const std::optional<double> mean_grey = taken_before_(shot.stamp)) return *mean_grey;

  out.frame.grey.resize(centre_rays_.direction_camera.size());
  gather_light(shot, workshop);
  const double mean_grey =
      sensor_.expose(workshop.luminance, shot.exposure, static_cast<uint64_t>(shot.index), out.frame.grey);
  if (config_.truth.any()) add_truth(shot, workshop, out);
  return mean_grey;
}

// From one share of the exposure to another: where what the first pose sees is in the second.
SE3 Camera::Shot::T_later_earlier(double later, double earlier) const {
  return T_world_camera(later).inverse() * T_world_camera(earlier);
}

// How far most of the image flows during the exposure.
double Camera::coarse_flow_px(const Shot& shot, Workshop& workshop) const {
  if (!config_.motion_blur) return 0;
  shot.source(shot.T_world_camera(0.0), coarse_rays_, workshop.coarse);
  return length_of_most(flow(optics_, coarse_rays_, workshop.coarse.depth_m, shot.T_later_earlier(1.0, 0.0)));
}

// As many views as keep the flow between them below its limit.
int Camera::blur_views(double flow_px) const {
  const double views = std::ceil(flow_px / config_.blur_view_spacing_px);
  return static_cast<int>(std::clamp(views, 1.0, static_cast<double>(config_.max_blur_views)));
}

void Camera::gather_light(const Shot& shot, Workshop& workshop) const {
  std::vector<float>& light = workshop.luminance;
  workshop.view_is_middle = false;
  if (const double share = transmission(shot.stamp); share < 1) {
    shot.source(shot.T_world_camera(0.5), coarse_rays_, workshop.coarse);
    const std::vector<float>& outside = workshop.coarse.luminance;
    const double mean =
        std::accumulate(outside.begin(), outside.end(), 0.0) / static_cast<double>(outside.size());
    light.assign(centre_rays_.direction_camera.size(), static_cast<float>(share * mean));
    return;
  }
  const double flow_px = coarse_flow_px(shot, workshop);
  const int views = std::max(blur_views(flow_px), config_.samples_per_pixel);
  const bool smeared = flow_px > config_.blur_spacing_px * views;
  light.assign(centre_rays_.direction_camera.size(), 0.0f);
  for (int k = 0; k < views; ++k) {
    const auto sample = static_cast<size_t>(k % config_.samples_per_pixel);
    const ViewRays& rays = sample_rays_.empty() ? centre_rays_ : sample_rays_[sample];
    const double share = config_.motion_blur ? (k + 0.5) / views : 0.5;
    shot.source(shot.T_world_camera(share), rays, workshop.view);
    if (smeared)
      add_smeared(workshop.view, config_.width_px,
                  flow(optics_, rays, workshop.view.depth_m,
                       shot.T_later_earlier((k + 1.0) / views, static_cast<double>(k) / views)),
                  static_cast<float>(config_.blur_spacing_px), light);
    else
      for (size_t i = 0; i < light.size(); ++i) light[i] += workshop.view.luminance[i];
  }
  if (views > 1)
    for (float& l : light) l /= static_cast<float>(views);
  workshop.view_is_middle = views == 1;
}

void Camera::add_truth(const Shot& shot, Workshop& workshop, CameraMeasurement& out) const {
  View& view = workshop.view;
  if (!workshop.view_is_middle) shot.source(out.T_world_camera, centre_rays_, view);
  if (config_.truth.clean) {
    // What covers the lens is no flaw of the image: it stays.
    const bool covered = transmission(shot.stamp) < 1;
    out.clean_grey.resize(view.luminance.size());
    sensor_.expose_clean(covered ? workshop.luminance : view.luminance, shot.exposure, out.clean_grey);
  }
  if (const Time before = stamp_of(shot.index - 1); config_.truth.flow && before >= first_)
    out.flow_px =
        flow(optics_, centre_rays_, view.depth_m, shot.T_world_camera(before).inverse() * out.T_world_camera);
  if (config_.truth.depth) out.depth_m = view.depth_m;
}

}  // namespace vsslam

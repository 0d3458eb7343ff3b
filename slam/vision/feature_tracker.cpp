#include "slam/vision/feature_tracker.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "core/errors.h"
#include "slam/vision/camera_model.h"

namespace vsslam {

void FeatureTrackerConfig::fields(Fields& f) {
  f("max_features", max_features, between(8, 2000));
  f("corners", corners);
  f("flow", flow);
  f("epipolar", epipolar);
}

namespace {

struct Track {
  int64_t id;
  WindowShape shape;          // of the window when it was chosen
  Eigen::Vector2f window_px;  // centre of what is followed
  Eigen::Vector2f offset_px;  // from there to the feature: the point whose motion the window's flow is
  Vec2 ray_camera;            // of the feature

  Vec2 pixel_px() const { return (window_px + offset_px).cast<double>(); }
};

std::vector<Eigen::Vector2f> windows(const std::vector<Track>& tracks) {
  std::vector<Eigen::Vector2f> result;
  for (const Track& track : tracks) result.push_back(track.window_px);
  return result;
}

constexpr float kWarpStepPx = 8;  // about the window's reach

Vec3 homogeneous(const Vec2& ray) {
  return {ray.x(), ray.y(), 1};
}

}  // namespace

struct FeatureTracker::Impl {
  FeatureTrackerConfig config;
  CameraCalibration calibration;
  CameraModel camera;
  OpticalFlow flow;
  std::vector<Track> tracks;  // in order of id
  int64_t next_id = 0;
  TrackingCounts counts;

  Impl(const FeatureTrackerConfig& c, const CameraCalibration& k)
      : config(c), calibration(k), camera(k), flow(c.flow, k.width_px, k.height_px) {}

  VisualFrame track(const CameraFrame& image, const Quat* q_last_now, bool keep) {
    require_size(image);
    flow.push(image);
    counts = {.equalized = flow.equalized()};
    const std::vector<Track> last = std::move(tracks);
    tracks = follow(last, q_last_now, keep);
    const Quat q_agreed = reject_outliers(last, q_last_now, image.stamp);
    follow_features(last, q_agreed);
    separate();
    if (keep) add_corners();
    return frame(image.stamp);
  }

  void require_size(const CameraFrame& image) const {
    if (image.width_px != calibration.width_px || image.height_px != calibration.height_px)
      throw InputError(
          fmt::format("camera image at {:.3f} s: expected {} x {} pixels as calibrated, found {} x {}",
                      image.stamp.seconds(), calibration.width_px, calibration.height_px, image.width_px,
                      image.height_px));
    const size_t expected = static_cast<size_t>(image.width_px) * static_cast<size_t>(image.height_px);
    if (image.grey.size() != expected)
      throw InputError(fmt::format("camera image at {:.3f} s: expected {} bytes of {} x {} pixels, found {}",
                                   image.stamp.seconds(), expected, image.width_px, image.height_px,
                                   image.grey.size()));
  }

  // Rotation moves all points of a direction alike, whatever their depth. Empty: out of sight.
  std::optional<Eigen::Vector2f> turned(const Vec2& pixel_px, const Quat& q_last_now) const {
    const std::optional<Vec2> ray = camera.ray_camera(pixel_px);
    if (!ray) return std::nullopt;
    const Vec3 ray_now = q_last_now.conjugate() * homogeneous(*ray);
    if (ray_now.z() < 0.1) return std::nullopt;
    return camera.pixel_px(ray_now.hnormalized()).cast<float>();
  }

  // Where the windows went if the camera has only turned; without a rotation, or out of sight: where they were.
  std::vector<Eigen::Vector2f> predict(const std::vector<Track>& last, const Quat* q_last_now) const {
    std::vector<Eigen::Vector2f> guess = windows(last);
    if (!q_last_now) return guess;
    for (Eigen::Vector2f& window : guess) {
      const std::optional<Eigen::Vector2f> now = turned(window.cast<double>(), *q_last_now);
      if (now && inside(*now)) window = *now;
    }
    return guess;
  }

  bool inside(const Eigen::Vector2f& p) const {
    const auto border = static_cast<float>(config.corners.border_px - 2);
    return p.x() >= border && p.y() >= border &&
           p.x() <= static_cast<float>(calibration.width_px - 1) - border &&
           p.y() <= static_cast<float>(calibration.height_px - 1) - border;
  }

  std::vector<Track> follow(const std::vector<Track>& last, const Quat* q_last_now, bool and_back) {
    const std::vector<Eigen::Vector2f> from = windows(last);
    std::vector<std::optional<Eigen::Vector2f>> to = flow.follow(from, predict(last, q_last_now), and_back);
    if (q_last_now) retry_lost(from, and_back, to);
    std::vector<Track> followed;
    for (size_t i = 0; i < last.size(); ++i) {
      if (!to[i] || !inside(*to[i])) continue;
      Track track = last[i];
      track.window_px = *to[i];
      if (locate(track)) followed.push_back(track);
    }
    counts.followed = static_cast<int>(followed.size());
    return followed;
  }

  // A wrong rotation must not cost more than none.
  void retry_lost(const std::vector<Eigen::Vector2f>& from, bool and_back,
                  std::vector<std::optional<Eigen::Vector2f>>& to) const {
    std::vector<Eigen::Vector2f> lost;
    for (size_t i = 0; i < from.size(); ++i)
      if (!to[i]) lost.push_back(from[i]);
    const std::vector<std::optional<Eigen::Vector2f>> again = flow.follow(lost, lost, and_back);
    auto next = again.begin();
    for (std::optional<Eigen::Vector2f>& position : to)
      if (!position) position = *next++;
  }

  // How much farther than its window's flow the feature went because the camera turned: the warp that the
  // rotation makes is known. That of approaching a surface is a zoom, under which the feature goes with the flow.
  Eigen::Vector2f rotation_bias(const Track& track, const Quat& q_last_now) const {
    const Vec2 at = track.window_px.cast<double>();  // of the last image
    const auto centre = turned(at, q_last_now);
    const auto right = turned(at + Vec2(kWarpStepPx, 0), q_last_now),
               down = turned(at + Vec2(0, kWarpStepPx), q_last_now);
    if (!centre || !right || !down) return Eigen::Vector2f::Zero();
    Eigen::Matrix2f warp;
    warp << (*right - *centre) / kWarpStepPx, (*down - *centre) / kWarpStepPx;
    warp -= Eigen::Matrix2f::Identity();
    return warp * track.offset_px - track.shape.flow_of(warp);
  }

  // False: the lens has no direction for this pixel.
  bool locate(Track& track) const {
    const std::optional<Vec2> ray = camera.ray_camera(track.pixel_px());
    if (ray) track.ray_camera = *ray;
    return ray.has_value();
  }

  // Returns the rotation that the remaining features agree with.
  Quat reject_outliers(const std::vector<Track>& last, const Quat* q_last_now, Time stamp) {
    std::vector<RayMatch> matches;
    for_each_followed(last, [&](const Track& before, const Track& now) {
      matches.push_back({homogeneous(before.ray_camera), homogeneous(now.ray_camera)});
    });
    const RigidMotion motion = rigid_motion(matches, q_last_now, stamp, config.epipolar);
    size_t i = 0;
    counts.rejected =
        static_cast<int>(std::erase_if(tracks, [&](const Track&) { return !motion.fits[i++]; }));
    return motion.q_last_now;
  }

  // From where the windows are to where the features are.
  void follow_features(const std::vector<Track>& last, const Quat& q_last_now) {
    for_each_followed(
        last, [&](const Track& before, Track& now) { now.offset_px += rotation_bias(before, q_last_now); });
    std::erase_if(tracks, [&](Track& track) { return !locate(track); });
  }

  template <class F>
  void for_each_followed(const std::vector<Track>& last, const F& f) {
    auto before = last.begin();
    for (Track& now : tracks) {
      while (before->id != now.id) ++before;
      f(*before, now);
    }
  }

  // Features that have run together see the same patch: the older one stays.
  void separate() {
    const auto least = static_cast<float>(config.corners.min_distance_px / 2);
    std::vector<Track> apart;
    for (const Track& track : tracks)
      if (std::none_of(apart.begin(), apart.end(), [&](const Track& other) {
            return (other.window_px - track.window_px).squaredNorm() < least * least;
          }))
        apart.push_back(track);
    tracks = std::move(apart);
  }

  void add_corners() {
    const auto most = static_cast<size_t>(config.max_features);
    if (tracks.size() >= most) return;
    const size_t before = tracks.size();
    const GreyView image = flow.newest();
    for (const Eigen::Vector2f& corner :
         find_corners(image, flow.noise_grey(), windows(tracks), most - tracks.size(), config.corners)) {
      const WindowShape shape = window_shape(image, static_cast<int>(corner.x()),
                                             static_cast<int>(corner.y()), config.flow.window());
      Track track{next_id, shape, corner, shape.centre_px(), Vec2::Zero()};
      if (!locate(track)) continue;
      tracks.push_back(track);
      ++next_id;
    }
    counts.detected = static_cast<int>(tracks.size() - before);
  }

  VisualFrame frame(Time stamp) const {
    VisualFrame result{.stamp = stamp, .features = {}};
    for (const Track& track : tracks)
      result.features.push_back({track.id, track.pixel_px(), track.ray_camera, 0});
    return result;
  }
};

FeatureTracker::FeatureTracker(const FeatureTrackerConfig& config, const CameraCalibration& camera) {
  const int least_px = 2 * config.corners.border_px + 64;
  if (camera.width_px < least_px || camera.height_px < least_px)
    throw InputError(
        fmt::format("camera calibration: expected images of at least {0} x {0} pixels, found {1} x {2}",
                    least_px, camera.width_px, camera.height_px));
  if (!(camera.fx_px > 0) || !(camera.fy_px > 0))
    throw InputError(fmt::format("camera calibration: expected positive focal lengths, found {} and {} px",
                                 camera.fx_px, camera.fy_px));
  impl_ = std::make_unique<Impl>(config, camera);
}
FeatureTracker::~FeatureTracker() = default;

VisualFrame FeatureTracker::track(const CameraFrame& image, const Quat* q_last_now, bool keep) {
  return impl_->track(image, q_last_now, keep);
}

void FeatureTracker::reset() {
  impl_->tracks.clear();
}

const TrackingCounts& FeatureTracker::counts() const {
  return impl_->counts;
}

}  // namespace vsslam

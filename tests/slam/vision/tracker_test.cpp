#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <opencv2/core.hpp>
#include <set>
#include <thread>

#include "core/errors.h"
#include "slam/vision/feature_tracker.h"
#include "tests/slam/vision/visual_scene.h"

namespace vsslam {
namespace {

using namespace testing_vision;

FeatureTrackerConfig small_config() {
  FeatureTrackerConfig config;
  config.max_features = 80;
  config.corners.min_distance_px = 16;
  config.corners.cell_px = 40;
  config.flow.levels = 2;
  return config;
}

SE3 drive_pose(int k) {
  const double t = k / 30.0;
  return before_plane({0.05 * std::sin(3 * t), 0.06 * std::sin(2 * t), 0.03 * std::sin(4 * t)},
                      {0.5 * t, 0.1 * t, 0.6 * t});
}

std::vector<CameraFrame> drive(int frames, const Picture& picture = {},
                               const CameraCalibration& camera = small_camera()) {
  const WaveTexture texture(3);
  std::vector<CameraFrame> images;
  for (int k = 0; k < frames; ++k)
    images.push_back(render(texture, camera, drive_pose(k), frame_time(k), picture));
  return images;
}
const std::vector<CameraFrame>& clean_drive() {
  static const std::vector<CameraFrame> images = drive(20);
  return images;
}

Quat turn(int k) {
  return (drive_pose(k - 1).inverse() * drive_pose(k)).rotation;
}

std::vector<VisualFrame> track_all(const std::vector<CameraFrame>& images,
                                   const CameraCalibration& camera = small_camera()) {
  FeatureTracker tracker(small_config(), camera);
  std::vector<VisualFrame> frames;
  for (size_t k = 0; k < images.size(); ++k) {
    const Quat q_last_now = k == 0 ? Quat::Identity() : turn(static_cast<int>(k));
    frames.push_back(tracker.track(images[k], k == 0 ? nullptr : &q_last_now));
  }
  return frames;
}

std::vector<double> numbers(const std::vector<VisualFrame>& frames) {
  std::vector<double> result;
  for (const VisualFrame& frame : frames)
    for (const VisualFeature& f : frame.features)
      result.insert(result.end(), {static_cast<double>(f.id), f.pixel_px.x(), f.pixel_px.y(),
                                   f.ray_camera.x(), f.ray_camera.y()});
  return result;
}

// Root mean square distance between features and the projection of where each was first seen.
double rms_error_px(const std::vector<VisualFrame>& frames, const CameraCalibration& calibration) {
  const CameraModel camera(calibration);
  std::map<int64_t, Vec2> first_odom;
  double sum = 0;
  int count = 0;
  for (size_t k = 0; k < frames.size(); ++k)
    for (const VisualFeature& f : frames[k].features) {
      const SE3 pose = drive_pose(static_cast<int>(k));
      const auto [entry, is_new] = first_odom.try_emplace(f.id, point_odom(camera, pose, f.pixel_px));
      if (is_new) continue;
      sum += (f.pixel_px - pixel_of(camera, pose, entry->second)).squaredNorm();
      ++count;
    }
  EXPECT_GT(count, 500);
  return std::sqrt(sum / count);
}

double mean_length(const std::vector<VisualFrame>& frames) {
  std::set<int64_t> ids;
  size_t seen = 0;
  for (const VisualFrame& frame : frames) {
    seen += frame.features.size();
    for (const VisualFeature& f : frame.features) ids.insert(f.id);
  }
  return static_cast<double>(seen) / static_cast<double>(ids.size());
}

TEST(FeatureTracker, FollowsPointsToATenthOfAPixel) {
  const std::vector<VisualFrame> frames = track_all(clean_drive());
  EXPECT_LT(rms_error_px(frames, small_camera()), 0.1);
  EXPECT_GT(mean_length(frames), 10);
}

TEST(FeatureTracker, FollowsPointsThroughNoise) {
  const std::vector<VisualFrame> frames = track_all(drive(20, {.noise_grey = 2}));
  EXPECT_LT(rms_error_px(frames, small_camera()), 0.3);
  EXPECT_GT(mean_length(frames), 10);
}

TEST(FeatureTracker, FollowsPointsThroughDistortion) {
  CameraCalibration camera = small_camera();
  camera.k1 = -0.28;
  camera.k2 = 0.07;
  camera.p1 = 0.001;
  camera.p2 = -0.0005;
  const std::vector<VisualFrame> frames = track_all(drive(12, {}, camera), camera);
  EXPECT_LT(rms_error_px(frames, camera), 0.1);
  const CameraModel model(camera);
  for (const VisualFeature& f : frames.back().features)
    EXPECT_LT((model.pixel_px(f.ray_camera) - f.pixel_px).norm(), 1e-9);
}

TEST(FeatureTracker, IdsIncreaseAndAreNeverUsedAgain) {
  const std::vector<VisualFrame> frames = track_all(clean_drive());
  std::set<int64_t> last, gone;
  int64_t newest = -1;
  for (const VisualFrame& frame : frames) {
    std::set<int64_t> ids;
    int64_t before = -1;
    for (const VisualFeature& f : frame.features) {
      EXPECT_GT(f.id, before);  // in order
      before = f.id;
      EXPECT_EQ(gone.count(f.id), 0u);
      EXPECT_TRUE(last.count(f.id) || f.id > newest);
      ids.insert(f.id);
    }
    for (int64_t id : last)
      if (!ids.count(id)) gone.insert(id);
    newest = std::max(newest, *ids.rbegin());
    last = ids;
  }
  EXPECT_GT(gone.size(), 0u);
}

TEST(FeatureTracker, IdsGoOnAfterAReset) {
  FeatureTracker tracker(small_config(), small_camera());
  const VisualFrame first = tracker.track(clean_drive()[0]);
  tracker.reset();
  const VisualFrame second = tracker.track(clean_drive()[1]);
  ASSERT_FALSE(second.features.empty());
  EXPECT_EQ(second.features.front().id, first.features.back().id + 1);
}

TEST(FeatureTracker, FeaturesAreSpreadAndApart) {
  for (const VisualFrame& frame : track_all(clean_drive())) {
    EXPECT_LE(frame.features.size(), 80u);
    std::map<std::pair<int, int>, int> cells;
    for (const VisualFeature& f : frame.features) {
      ++cells[{static_cast<int>(f.pixel_px.x() / 80), static_cast<int>(f.pixel_px.y() / 80)}];
      for (const VisualFeature& other : frame.features)
        EXPECT_TRUE(other.id == f.id || (f.pixel_px - other.pixel_px).norm() >= 8);
    }
    EXPECT_EQ(cells.size(), 12u);
  }
}

TEST(FeatureTracker, LosesNothingWhileStandingStill) {
  const WaveTexture texture(3);
  for (const bool with_rotation : {true, false}) {
    FeatureTracker tracker(small_config(), small_camera());
    const Quat still = Quat::Identity();
    const VisualFrame first =
        tracker.track(render(texture, small_camera(), drive_pose(0), frame_time(0), {.noise_grey = 1}));
    VisualFrame frame;
    for (int k = 1; k < 8; ++k) {
      frame = tracker.track(render(texture, small_camera(), drive_pose(0), frame_time(k), {.noise_grey = 1}),
                            with_rotation ? &still : nullptr);
      EXPECT_EQ(tracker.counts().rejected, 0);
    }
    ASSERT_EQ(frame.features.size(), first.features.size());
    for (size_t i = 0; i < frame.features.size(); ++i) {
      EXPECT_EQ(frame.features[i].id, first.features[i].id);
      EXPECT_LT((frame.features[i].pixel_px - first.features[i].pixel_px).norm(), 0.5);
    }
  }
}

TEST(FeatureTracker, KeepsFeaturesInPureRotation) {
  const WaveTexture texture(3);
  for (const bool with_rotation : {true, false}) {
    FeatureTracker tracker(small_config(), small_camera());
    const Quat q_last_now = so3_exp({0, 0.02, 0.01});
    SE3 pose = before_plane();
    tracker.track(render(texture, small_camera(), pose, frame_time(0)));
    for (int k = 1; k < 6; ++k) {
      pose = pose * SE3(q_last_now, Vec3::Zero());
      tracker.track(render(texture, small_camera(), pose, frame_time(k)),
                    with_rotation ? &q_last_now : nullptr);
      EXPECT_LE(tracker.counts().rejected, 1);
      EXPECT_GE(tracker.counts().followed, 68);
    }
  }
}

TEST(FeatureTracker, RotationHelpsAFastTurn) {
  const WaveTexture texture(3, 0.1, 0.5);
  const Quat q_last_now = so3_exp({0, 0.25, 0});  // 14 deg between two images: about 50 px
  const CameraFrame before = render(texture, small_camera(), before_plane(), frame_time(0));
  const CameraFrame after =
      render(texture, small_camera(), before_plane() * SE3(q_last_now, Vec3::Zero()), frame_time(1));
  const auto followed = [&](const Quat* q) {
    FeatureTracker tracker(small_config(), small_camera());
    tracker.track(before);
    tracker.track(after, q);
    return tracker.counts().followed - tracker.counts().rejected;
  };
  const int guided = followed(&q_last_now);
  EXPECT_GT(guided, 40);
  EXPECT_GT(guided, 2 * followed(nullptr));
}

TEST(FeatureTracker, AWrongRotationDoesNotLoseTheTracks) {
  FeatureTracker tracker(small_config(), small_camera());
  const Quat spike = so3_exp({0.5, -0.3, 0.2});
  tracker.track(clean_drive()[0]);
  tracker.track(clean_drive()[1], &spike);
  EXPECT_GT(tracker.counts().followed - tracker.counts().rejected, 65);
}

TEST(FeatureTracker, RejectsWhatMovesByItself) {
  const CameraCalibration camera = small_camera();
  // A patch of the image moves along another way than the scene, across the epipolar lines.
  const auto image = [&](int k, const WaveTexture& background, const WaveTexture& patch) {
    CameraFrame frame = render(background, camera, drive_pose(k), frame_time(k));
    const CameraFrame moving =
        render(patch, camera, before_plane(Vec3::Zero(), {0.1 * k, -0.25 * k, 0}), frame_time(k));
    for (int y = 60; y < 160; ++y)
      for (int x = 100; x < 200; ++x) {
        const auto i = static_cast<size_t>(y * camera.width_px + x);
        frame.grey[i] = moving.grey[i];
      }
    return frame;
  };
  int survivors = 0, inside = 0;
  for (const bool with_rotation : {true, false})
    for (const uint64_t seed : {4, 5, 6, 7}) {
      const WaveTexture background(3), patch(seed);
      FeatureTracker tracker(small_config(), camera);
      tracker.track(image(0, background, patch));
      std::set<int64_t> known;
      for (int k = 1; k < 5; ++k) {
        const Quat q_last_now = turn(k);
        const VisualFrame frame =
            tracker.track(image(k, background, patch), with_rotation ? &q_last_now : nullptr);
        for (const VisualFeature& f : frame.features) {
          const bool in_patch =
              f.pixel_px.x() > 115 && f.pixel_px.x() < 185 && f.pixel_px.y() > 75 && f.pixel_px.y() < 145;
          inside += in_patch;
          survivors += in_patch && known.count(f.id) > 0;
        }
        known.clear();
        for (const VisualFeature& f : frame.features) known.insert(f.id);
        EXPECT_GT(tracker.counts().followed - tracker.counts().rejected, 40);
      }
    }
  EXPECT_GT(inside, 100);
  EXPECT_LT(survivors, 0.05 * inside);  // by chance along its epipolar line
}

TEST(FeatureTracker, FollowsPointsThroughImagesThatAreNotKept) {
  FeatureTracker tracker(small_config(), small_camera());
  std::vector<VisualFrame> frames;
  for (size_t k = 0; k < clean_drive().size(); ++k) {
    const Quat q_last_now = k == 0 ? Quat::Identity() : turn(static_cast<int>(k));
    frames.push_back(tracker.track(clean_drive()[k], k == 0 ? nullptr : &q_last_now, k % 3 == 0));
  }
  EXPECT_LT(rms_error_px(frames, small_camera()), 0.1);
  EXPECT_GT(mean_length(frames), 10);
}

TEST(FeatureTracker, ChecksTheWayBackInImagesThatAreKept) {
  // A strip of something else has come over the scene: what was under it is found somewhere, but not from there.
  const WaveTexture scene(3), other(5);
  const SE3 pose = before_plane(Vec3::Zero(), Vec3::Zero());
  CameraFrame covered = render(scene, small_camera(), pose, frame_time(1));
  const CameraFrame strip = render(other, small_camera(), pose, frame_time(1));
  for (int y = 40; y < 200; ++y)
    std::copy_n(strip.grey.begin() + y * small_camera().width_px + 80, 120,
                covered.grey.begin() + y * small_camera().width_px + 80);
  FeatureTrackerConfig config = small_config();
  config.epipolar.threshold_px = 1000;  // nothing else rejects them
  std::map<bool, int> astray, in_place;
  for (const bool keep : {false, true}) {
    FeatureTracker tracker(config, small_camera());
    std::map<int64_t, Vec2> home_px;
    for (const VisualFeature& f : tracker.track(render(scene, small_camera(), pose, frame_time(0))).features)
      home_px[f.id] = f.pixel_px;
    for (const VisualFeature& f : tracker.track(covered, nullptr, keep).features)
      if (home_px.contains(f.id)) ++((f.pixel_px - home_px.at(f.id)).norm() < 1 ? in_place : astray)[keep];
  }
  EXPECT_GT(astray[false], 10);
  EXPECT_LT(astray[true], astray[false] / 4);
  EXPECT_GT(in_place[true], 30);
}

TEST(FeatureTracker, FindsNewFeaturesOnlyWhereAsked) {
  FeatureTracker tracker(small_config(), small_camera());
  const std::vector<CameraFrame> images = drive(6);
  const size_t first = tracker.track(images[0]).features.size();
  for (size_t k = 1; k < 5; ++k) {
    const VisualFrame frame = tracker.track(images[k], nullptr, false);
    EXPECT_EQ(tracker.counts().detected, 0);
    EXPECT_LE(frame.features.size(), first);
    EXPECT_LT(frame.features.back().id, static_cast<int64_t>(first));
  }
  tracker.track(images[5]);
  EXPECT_GT(tracker.counts().detected, 0);
}

TEST(FeatureTracker, EqualizesADarkImage) {
  const Picture dark{.gain = 0.05, .offset_grey = 5, .noise_grey = 0.3};
  FeatureTracker tracker(small_config(), small_camera());
  tracker.track(drive(1, dark)[0]);
  EXPECT_TRUE(tracker.counts().equalized);
  const std::vector<VisualFrame> frames = track_all(drive(12, dark));
  EXPECT_GT(frames.back().features.size(), 60u);
  EXPECT_GT(mean_length(frames), 6);
  EXPECT_LT(rms_error_px(frames, small_camera()), 0.4);
}

TEST(FeatureTracker, KeepsTracksWhenEqualizationStarts) {
  FeatureTracker tracker(small_config(), small_camera());
  const WaveTexture texture(3, 0.3, 1.2);
  for (int k = 0; k < 12; ++k) {
    const double gain = 0.6 * std::pow(0.92, k);  // the median falls below 50 at 6
    tracker.track(render(texture, small_camera(), drive_pose(k), frame_time(k), {.gain = gain}));
    EXPECT_EQ(tracker.counts().equalized, k >= 6) << k;
    EXPECT_GT(tracker.counts().followed - tracker.counts().rejected, k == 0 ? -1 : 40) << k;
  }
}

TEST(FeatureTracker, SeesNothingThroughACoveredLens) {
  for (const double grey : {0.0, 128.0, 255.0})
    for (const double noise : {0.0, 0.7, 3.0}) {
      FeatureTracker tracker(small_config(), small_camera());
      for (int k = 0; k < 4; ++k)
        EXPECT_LE(tracker.track(blank(small_camera(), frame_time(k), grey, noise)).features.size(), 4u)
            << grey << " " << noise;
    }
}

TEST(FeatureTracker, ComesBackAfterBlackImages) {
  FeatureTracker tracker(small_config(), small_camera());
  EXPECT_GT(tracker.track(clean_drive()[0]).features.size(), 70u);
  EXPECT_EQ(tracker.track(blank(small_camera(), frame_time(1), 0)).features.size(), 0u);
  EXPECT_EQ(tracker.track(blank(small_camera(), frame_time(2), 255)).features.size(), 0u);
  EXPECT_GT(tracker.track(clean_drive()[3]).features.size(), 70u);
}

TEST(FeatureTracker, ImagesMustFitTheCalibration) {
  FeatureTracker tracker(small_config(), small_camera());
  CameraFrame image = clean_drive()[0];
  image.width_px = 240;
  image.height_px = 320;
  EXPECT_THROW(tracker.track(image), InputError);
  image = clean_drive()[0];
  image.grey.pop_back();
  EXPECT_THROW(tracker.track(image), InputError);
  CameraCalibration tiny = small_camera();
  tiny.width_px = 40;
  EXPECT_THROW(FeatureTracker(small_config(), tiny), InputError);
}

TEST(FeatureTracker, SameImagesSameFeatures) {
  const std::vector<double> once = numbers(track_all(clean_drive()));
  cv::theRNG().state = 12345;
  EXPECT_EQ(numbers(track_all(clean_drive())), once);

  const int threads = cv::getNumThreads();
  for (const int n : {1, 2}) {
    cv::setNumThreads(n);
    EXPECT_EQ(numbers(track_all(clean_drive())), once) << n << " threads in OpenCV";
  }
  cv::setNumThreads(threads);

  std::vector<double> left, right;
  std::thread other([&] { left = numbers(track_all(clean_drive())); });
  right = numbers(track_all(clean_drive()));
  other.join();
  EXPECT_EQ(left, once);
  EXPECT_EQ(right, once);
}

}  // namespace
}  // namespace vsslam

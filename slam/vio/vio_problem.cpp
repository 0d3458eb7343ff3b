#include "slam/vio/vio_problem.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <utility>

#include "slam/vio/imu_factor.h"
#include "slam/vio/reprojection_factor.h"
#include "slam/vio/rest_factor.h"

namespace vsslam {

namespace {

constexpr double kFocal_px = 460;

bool usable(const WindowFeature& feature) {
  return feature.point && feature.seen.size() >= 2;
}

Variable pose(size_t frame) {
  return {VariableKind::pose, static_cast<int>(frame)};
}
Variable motion(size_t frame) {
  return {VariableKind::motion, static_cast<int>(frame)};
}

// Of the frames; add_feature() adds the points.
Linearization linearization_of(const VioWindow& window) {
  Linearization at;
  for (const WindowFrame& frame : window.frames) {
    at.frames.push_back(frame.id);
    at.now.frames.push_back(frame_blocks(frame.state));
  }
  at.first = at.now;
  for (const LinearPrior::Part& part : window.prior.parts) {
    const int size = part.kind == VariableKind::pose ? 7 : 9;
    std::copy_n(part.at.begin(), size,
                at.first.data({part.kind, static_cast<int>(window.index_of(part.frame))}));
  }
  return at;
}

void add_prior(const VioWindow& window, WindowProblem& problem) {
  if (window.prior.parts.empty()) return;
  WindowFactor factor{std::make_unique<PriorFactor>(window.prior), false, {}};
  for (const LinearPrior::Part& part : window.prior.parts)
    factor.variables.push_back({part.kind, static_cast<int>(window.index_of(part.frame))});
  problem.factors.push_back(std::move(factor));
}

// Between frame j - 1 and frame j.
void add_interval(const VioWindow& window, size_t j, const VioModel& model, WindowProblem& problem) {
  const WindowFrame& frame = window.frames[j];
  WindowFactor factor{nullptr, false, {pose(j - 1), motion(j - 1), pose(j), motion(j)}};
  if (frame.rest) {
    const double between_s = seconds_between(window.frames[j - 1].state.stamp, frame.state.stamp);
    factor.cost = std::make_unique<RestFactor>(*frame.rest, between_s, model.imu);
  } else {
    factor.cost = std::make_unique<ImuFactor>(*frame.motion, model.imu);
  }
  problem.factors.push_back(std::move(factor));
}

void add_feature(const VioWindow& window, const WindowFeature& feature, const VioModel& model,
                 WindowProblem& problem) {
  const Sighting& anchor = feature.seen.front();
  const Variable point{VariableKind::point, static_cast<int>(problem.at.now.points.size())};
  problem.at.now.points.push_back(*feature.point);
  problem.at.first.points.push_back(*feature.point);
  const Variable anchor_pose = pose(window.index_of(anchor.frame));
  const double weight = kFocal_px / model.config.feature_sigma_px, ratio = model.config.depth_sigma_ratio;
  problem.factors.push_back({std::make_unique<AnchorRayFactor>(anchor.ray_camera, weight), true, {point}});
  bool has_depth = anchor.depth_m > 0;
  if (has_depth)
    problem.factors.push_back({std::make_unique<AnchorDepthFactor>(anchor.depth_m, ratio), true, {point}});
  for (size_t k = 1; k < feature.seen.size(); ++k) {
    const Sighting& s = feature.seen[k];
    const std::vector<Variable> variables{anchor_pose, pose(window.index_of(s.frame)), point};
    problem.factors.push_back(
        {std::make_unique<ReprojectionFactor>(model.T_imu_camera, s.ray_camera, weight), true, variables});
    // One depth per feature: those of other frames come from the same points.
    if (has_depth || s.depth_m <= 0) continue;
    problem.factors.push_back(
        {std::make_unique<DepthFactor>(model.T_imu_camera, s.depth_m, ratio), true, variables});
    has_depth = true;
  }
}

// Of the features anchored in the oldest frame, those whose measurements become part of the prior: all whose tracks
// have ended, and a share of the others, the longest. What became part of the prior must not be used again; if all
// tracks that live went at once, nothing would tie the next frames to the window.
std::vector<int64_t> features_to_leave(const VioWindow& window, const VioModel& model) {
  const int64_t oldest = window.frames.front().id, newest = window.newest().id;
  std::vector<int64_t> ended, alive;
  size_t all_alive = 0;
  for (const int64_t id : usable_features(window, model.config.max_features)) {
    const WindowFeature& feature = window.features.at(id);
    const bool lives = feature.seen.back().frame == newest;
    all_alive += lives;
    if (feature.seen.front().frame != oldest) continue;
    if (!lives) ended.push_back(id);
    if (lives && feature.seen.size() > 2) alive.push_back(id);
  }
  std::stable_sort(alive.begin(), alive.end(), [&](int64_t a, int64_t b) {
    return window.features.at(a).seen.size() > window.features.at(b).seen.size();
  });
  const size_t share = 1 + all_alive / static_cast<size_t>(model.config.window);
  alive.resize(std::min(alive.size(), share));
  ended.insert(ended.end(), alive.begin(), alive.end());
  return ended;
}

// Takes them out of the window. A track that lives on does so as a new feature, anchored in its last sighting, which
// is not taken with the others.
std::vector<WindowFeature> take_leaving(VioWindow& window, const VioModel& model) {
  std::vector<WindowFeature> taken;
  const int64_t newest = window.newest().id;
  for (const int64_t id : features_to_leave(window, model)) {
    WindowFeature& feature = window.features.at(id);
    if (feature.seen.back().frame != newest) {
      taken.push_back(std::move(feature));
      window.features.erase(id);
      continue;
    }
    WindowFeature anew{{feature.seen.back()}, window.point_in(newest, feature, model.T_imu_camera)};
    feature.seen.pop_back();
    taken.push_back(std::exchange(feature, std::move(anew)));
  }
  return taken;
}

}  // namespace

VioModel make_model(const VioConfig& config, const RigCalibration& rig) {
  VioModel model{config, rig.imu, rig.imu.T_base_imu.inverse() * rig.camera.T_base_camera};
  model.imu.gyro_noise_radps_rthz *= config.imu_noise_factor;
  model.imu.accel_noise_mps2_rthz *= config.imu_noise_factor;
  model.imu.gyro_bias_walk_radps2_rthz *= config.imu_noise_factor;
  model.imu.accel_bias_walk_mps3_rthz *= config.imu_noise_factor;
  return model;
}

std::vector<int64_t> usable_features(const VioWindow& window, int max_features) {
  std::vector<int64_t> ids;
  for (const auto& [id, feature] : window.features)
    if (usable(feature)) ids.push_back(id);
  if (ids.size() <= static_cast<size_t>(max_features)) return ids;
  std::stable_sort(ids.begin(), ids.end(), [&](int64_t a, int64_t b) {
    return window.features.at(a).seen.size() > window.features.at(b).seen.size();
  });
  ids.resize(static_cast<size_t>(max_features));
  std::sort(ids.begin(), ids.end());
  return ids;
}

WindowProblem make_problem(const VioWindow& window, const std::vector<int64_t>& features,
                           const VioModel& model) {
  WindowProblem problem{features, linearization_of(window), {}};
  add_prior(window, problem);
  for (size_t j = 1; j < window.frames.size(); ++j) add_interval(window, j, model, problem);
  for (const int64_t id : features) add_feature(window, window.features.at(id), model, problem);
  return problem;
}

void leave_oldest(VioWindow& window, const VioModel& model) {
  const int64_t oldest = window.frames.front().id;
  const std::vector<WindowFeature> leaving = take_leaving(window, model);
  WindowProblem problem{{}, linearization_of(window), {}};
  add_prior(window, problem);
  add_interval(window, 1, model, problem);
  for (const WindowFeature& feature : leaving) add_feature(window, feature, model, problem);
  LinearPrior prior = marginalize(problem.factors, problem.at, 0);
  window.forget_sightings(oldest, model.T_imu_camera);
  window.prior = std::move(prior);
  window.frames.pop_front();
}

void leave_newest(VioWindow& window, const VioModel& model) {
  const int64_t newest = window.newest().id;
  window.forget_sightings(newest, model.T_imu_camera);
  const auto& parts = window.prior.parts;
  if (std::any_of(parts.begin(), parts.end(),
                  [&](const LinearPrior::Part& part) { return part.frame == newest; })) {
    WindowProblem problem{{}, linearization_of(window), {}};
    add_prior(window, problem);
    window.prior = marginalize(problem.factors, problem.at, static_cast<int>(window.frames.size()) - 1);
  }
  window.frames.pop_back();
}

Eigen::Matrix<double, 15, 15> newest_covariance(const VioWindow& window, const VioModel& model) {
  const WindowProblem problem =
      make_problem(window, usable_features(window, model.config.max_features), model);
  WindowEquations window_equations(problem.factors, problem.features.size());
  window_equations.linearize(problem.at.now, problem.at.now);
  const NormalEquations equations = window_equations.without_points();
  const Eigen::Index size = equations.H.rows();
  Eigen::MatrixXd last = Eigen::MatrixXd::Zero(size, 15);
  last.bottomRows<15>().setIdentity();
  return equations.H.ldlt().solve(last).bottomRows<15>();
}

}  // namespace vsslam

// The window as a least-squares problem: its factors, its solution, and what it leaves behind when a frame goes.
#pragma once

#include "slam/vio/marginalization.h"
#include "slam/vio/vio_window.h"

namespace vsslam {

struct VioModel {
  VioConfig config;
  ImuCalibration imu;  ///< densities already times VioConfig::imu_noise_factor
  SE3 T_imu_camera;
};
VioModel make_model(const VioConfig& config, const RigCalibration& rig);

/// Features with a depth that two frames have seen; the `max_features` longest of them, by id.
std::vector<int64_t> usable_features(const VioWindow& window, int max_features);

struct WindowProblem {
  std::vector<int64_t> features;  ///< ids, by index of their points
  Linearization at;
  std::vector<WindowFactor> factors;
};
/// Refers to the window's prior and preintegrations.
WindowProblem make_problem(const VioWindow& window, const std::vector<int64_t>& features,
                           const VioModel& model);

struct VioSolution {
  double initial_cost = 0, final_cost = 0;
  int iterations = 0;
  bool usable = false;
};
/// When a step changes the cost by less than this share, it is good enough: the cost is half of chi-squared, about 100 for
/// a window, a change of it by 0.1 says nothing about the state, and the next frame's solution goes on from there.
inline constexpr double kCostTolerance = 1e-3;
/// Moves `x` to where the factors' cost is least. No limit on wall-clock time.
VioSolution minimize(const std::vector<WindowFactor>& factors, WindowValues& x, int max_iterations,
                     double cost_tolerance = kCostTolerance);
/// Optimises all states and the points of the usable features, and writes them into the window.
VioSolution solve(VioWindow& window, const VioModel& model, int max_iterations);

/// Removes the oldest frame; the prior keeps what its measurements said of the others.
void leave_oldest(VioWindow& window, const VioModel& model);
/// Removes the newest frame; what it saw is forgotten, and what the prior said of it is kept by the others.
void leave_newest(VioWindow& window, const VioModel& model);

/// Covariance of the newest state, tangent order [pose; velocity; gyro bias; accel bias].
Eigen::Matrix<double, 15, 15> newest_covariance(const VioWindow& window, const VioModel& model);

}  // namespace vsslam

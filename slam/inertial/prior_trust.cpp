#include "slam/inertial/prior_trust.h"

#include <Eigen/Cholesky>
#include <algorithm>

namespace vsslam {

namespace {

constexpr double kMemory = 0.8;    // of a running mean: the last five scans
constexpr double kRefused = 25.0;  // five sigma
constexpr double kHarm_m = 0.05;   // less does not hurt undistortion or registration: wider covariances do
constexpr double kWorse = 2;       // times as far off as the last velocity
constexpr double kGood = 4.0;      // two sigma
constexpr int kGoodScans = 20;
constexpr double kArm_m = 2.0;     // a turn harms what is so far away

double size_m(const Vec6& shift) {
  return shift.tail<3>().norm() + kArm_m * shift.head<3>().norm();
}

void remember(double& mean, double value) {
  mean = kMemory * mean + (1 - kMemory) * value;
}

}  // namespace

void PriorTrust::add(const Vec6& shift, const Mat6& claimed, const Mat6& known, const Vec6& rival,
                     bool blind) {
  const auto factor = claimed.ldlt();
  const double seen = 6 - factor.solve(known).trace();  // degrees of freedom that the scan decided
  if (seen < 1 || blind) return;
  const double surprise = shift.dot(factor.solve(shift)) / seen;  // 1 on average if the claim is true
  remember(mean_, std::min(surprise, 1e4));
  remember(own_m_, size_m(shift));
  remember(rival_m_, size_m(rival));
  good_ = surprise < kGood ? good_ + 1 : 0;
  if (believed_ && mean_ > kRefused && own_m_ > kHarm_m && own_m_ > kWorse * rival_m_) believed_ = false;
  if (!believed_ && !refused_ && good_ >= kGoodScans) {
    believed_ = true;
    mean_ = 1;
  }
}

}  // namespace vsslam

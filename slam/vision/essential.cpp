#include "slam/vision/essential.h"

#include <opencv2/calib3d.hpp>

namespace vsslam {

namespace {

Quat rotation(const cv::Mat& r) {
  Mat3 m;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) m(i, j) = r.at<double>(i, j);
  return Quat(m).normalized();
}

}  // namespace

std::optional<Quat> rotation_of_matches(const std::vector<RayMatch>& matches, double threshold) {
  if (matches.size() < 6) return std::nullopt;
  std::vector<cv::Point2d> last, now;
  for (const RayMatch& m : matches) {
    last.emplace_back(m.last.x(), m.last.y());
    now.emplace_back(m.now.x(), m.now.y());
  }
  // RANSAC of OpenCV draws from a generator of its own that starts anew in each call; USAC and LMEDS may not.
  constexpr double kConfidence = 0.99;
  constexpr int kMostDraws = 200;
  const cv::Mat essential = cv::findEssentialMat(last, now, cv::Mat::eye(3, 3, CV_64F), cv::RANSAC,
                                                 kConfidence, threshold, kMostDraws);
  if (essential.rows != 3 || essential.cols != 3) return std::nullopt;
  cv::Mat first, second, translation;
  cv::decomposeEssentialMat(essential, first, second, translation);
  const Quat a = rotation(first), b = rotation(second);  // now from last
  if (!a.coeffs().allFinite() || !b.coeffs().allFinite()) return std::nullopt;
  return (std::abs(a.w()) >= std::abs(b.w()) ? a : b).conjugate();
}

}  // namespace vsslam

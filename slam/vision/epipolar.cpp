#include "slam/vision/epipolar.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <optional>

#include "core/rng.h"
#include "slam/vision/essential.h"

namespace vsslam {

void EpipolarConfig::fields(Fields& f) {
  f("threshold_px", threshold_px, positive());
  f("hypotheses", hypotheses, between(1, 10000));
  f("min_inlier_share", min_inlier_share, between(0, 1));
}

namespace {

constexpr double kFocalPx = 460;
constexpr size_t kFewest = 6;  // matches that can outvote an outlier

// A match with its rotation undone, in the camera frame of now: X_now = R X_last + t, so that the direction now
// lies between `turned` (a point at infinity) and t.
struct Parallax {
  Vec3 turned, now;  // z = 1
  Vec3 normal;       // turned x now: of the epipolar plane
  bool moved;        // by more than the threshold

  Parallax(const RayMatch& match, const Mat3& R_now_last, double threshold) : now(match.now) {
    turned = R_now_last * match.last;
    turned /= turned.z();
    normal = turned.cross(now);
    moved = (now - turned).squaredNorm() > threshold * threshold;
  }
  // Sign of the direction of translation that the match fits: of t (1), of -t (-1), of both (0); empty: neither.
  // By Sampson's distance, scaled to that of one image. What did not move fits any translation; what moved must
  // have moved away from the epipole, or it would lie behind.
  std::optional<int> fits(const Vec3& t, double threshold) const {
    if (!moved) return 0;
    const Vec3 a = turned.cross(t);
    const double error = normal.dot(t), bx = now.y() * t.z() - t.y(), by = t.x() - now.x() * t.z();
    const double slope2 = a.x() * a.x() + a.y() * a.y() + bx * bx + by * by;
    if (2 * error * error > threshold * threshold * slope2) return std::nullopt;
    return normal.dot(a) > 0 ? 1 : -1;
  }
};

class TranslationSearch {
 public:
  TranslationSearch(const std::vector<RayMatch>& matches, const Mat3& R_now_last, double threshold)
      : threshold_(threshold) {
    for (const RayMatch& match : matches) parallaxes_.emplace_back(match, R_now_last, threshold);
    count_still();
  }
  /// Two matches give a direction: it lies in both epipolar planes.
  void draw(int hypotheses, Time stamp) {
    const RandomStream draw(0, "vision.epipolar");
    const size_t n = parallaxes_.size();
    for (int k = 0; k < hypotheses && !certain_after(k); ++k) {
      const uint64_t bits = draw.bits(static_cast<uint64_t>(stamp.ns), static_cast<uint64_t>(k));
      const size_t i = static_cast<size_t>((bits >> 32) % n),
                   j = static_cast<size_t>((bits & 0xFFFFFFFFu) % n);
      keep_if_better(parallaxes_[i].normal.cross(parallaxes_[j].normal));
    }
  }
  /// The direction that fits all inliers best.
  void refine() {
    Mat3 sum = Mat3::Zero();
    for (const Parallax& p : parallaxes_)
      if (p.fits(best_t_, threshold_).value_or(-1) >= 0) sum += p.normal * p.normal.transpose();
    keep_if_better(Eigen::SelfAdjointEigenSolver<Mat3>(sum).eigenvectors().col(0));
  }
  size_t inliers() const { return best_count_; }
  std::vector<uint8_t> fits() const {
    std::vector<uint8_t> result;
    for (const Parallax& p : parallaxes_)
      result.push_back(p.fits(best_t_, threshold_).value_or(-1) >= 0 ? 1 : 0);
    return result;
  }

 private:
  void count_still() {
    for (const Parallax& p : parallaxes_) best_count_ += p.moved ? 0 : 1;
  }
  // If the best direction's inliers are all there are, so many draws have hit two of them.
  bool certain_after(int draws) const {
    constexpr double kMissed = 1e-3;
    const double share = static_cast<double>(best_count_) / static_cast<double>(parallaxes_.size());
    return draws > 0 && std::pow(1 - share * share, draws) < kMissed;
  }
  // t or -t, whichever more matches fit.
  void keep_if_better(const Vec3& t) {
    const double length = t.norm();
    if (length < 1e-15) return;
    size_t forward = 0, backward = 0;
    for (const Parallax& p : parallaxes_) {
      const std::optional<int> sign = p.fits(t, threshold_);
      if (!sign) continue;
      forward += *sign >= 0 ? 1 : 0;
      backward += *sign <= 0 ? 1 : 0;
    }
    if (std::max(forward, backward) <= best_count_) return;
    best_count_ = std::max(forward, backward);
    best_t_ = (forward >= backward ? 1 : -1) / length * t;
  }

  double threshold_;  // tangent of an angle
  std::vector<Parallax> parallaxes_;
  Vec3 best_t_ = Vec3::Zero();  // zero: no translation
  size_t best_count_ = 0;
};

TranslationSearch search(const std::vector<RayMatch>& matches, const Quat& q_last_now, Time stamp,
                         const EpipolarConfig& config) {
  TranslationSearch search(matches, q_last_now.conjugate().toRotationMatrix(),
                           config.threshold_px / kFocalPx);
  search.draw(config.hypotheses, stamp);
  search.refine();
  return search;
}

}  // namespace

RigidMotion rigid_motion(const std::vector<RayMatch>& matches, const Quat* q_last_now, Time stamp,
                         const EpipolarConfig& config) {
  const Quat first = q_last_now ? *q_last_now : Quat::Identity();
  if (matches.size() < kFewest) return {std::vector<uint8_t>(matches.size(), 1), first};
  const TranslationSearch given = search(matches, first, stamp, config);
  const double share = static_cast<double>(given.inliers()) / static_cast<double>(matches.size());
  if (q_last_now && share >= config.min_inlier_share) return {given.fits(), first};
  const std::optional<Quat> second = rotation_of_matches(matches, config.threshold_px / kFocalPx);
  if (!second) return {given.fits(), first};
  const TranslationSearch estimated = search(matches, *second, stamp, config);
  if (estimated.inliers() > given.inliers()) return {estimated.fits(), *second};
  return {given.fits(), first};
}

}  // namespace vsslam

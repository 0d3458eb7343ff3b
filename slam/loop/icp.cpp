#include "slam/loop/icp.h"

#include <Eigen/SVD>
#include <cmath>
#include <limits>
#include <nanoflann.hpp>
#include <vector>

namespace vsslam {

namespace {

struct Points {
  const Cloud& cloud;
  size_t kdtree_get_point_count() const { return cloud.size(); }
  float kdtree_get_pt(size_t i, size_t dimension) const {
    return cloud[i][static_cast<Eigen::Index>(dimension)];
  }
  template <class Box>
  bool kdtree_get_bbox(Box&) const {
    return false;
  }
};

/// nanoflann result set: the two nearest points within a radius.
class TwoNearest {
 public:
  explicit TwoNearest(float squared_radius) : first_(squared_radius), second_(squared_radius) {}
  bool full() const { return true; }
  float worstDist() const { return second_; }
  bool addPoint(float squared, uint32_t index) {
    if (squared < first_) {
      second_ = first_;
      first_ = squared;
      nearest_ = static_cast<int>(index);
    } else if (squared < second_) {
      second_ = squared;
    }
    return true;
  }
  IcpTarget::Neighbours neighbours() const { return {nearest_, std::sqrt(first_), std::sqrt(second_)}; }

 private:
  int nearest_ = -1;
  float first_, second_;
};

}  // namespace

class IcpTarget::Tree {
 public:
  explicit Tree(const Cloud& cloud)
      : points_{cloud}, index_(3, points_, nanoflann::KDTreeSingleIndexAdaptorParams(kLeafSize)) {}

  Neighbours find(const Eigen::Vector3f& point, float radius_m) const {
    TwoNearest result(radius_m * radius_m);
    index_.findNeighbors(result, point.data(), nanoflann::SearchParams());
    return result.neighbours();
  }

  Cloud nearest(const Eigen::Vector3f& point, int count) const {
    const auto wanted = static_cast<size_t>(count);
    std::vector<uint32_t> indices(wanted);
    std::vector<float> squared(wanted);
    indices.resize(index_.knnSearch(point.data(), wanted, indices.data(), squared.data()));
    Cloud near;
    for (uint32_t i : indices) near.push_back(points_.cloud[i]);
    return near;
  }

 private:
  static constexpr size_t kLeafSize = 12;
  Points points_;
  nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<float, Points>, Points, 3, uint32_t>
      index_;
};

IcpTarget::IcpTarget(Cloud points) : points_(std::move(points)), tree_(std::make_unique<Tree>(points_)) {}
IcpTarget::~IcpTarget() = default;

IcpTarget::Neighbours IcpTarget::find(const Eigen::Vector3f& point, float radius_m) const {
  return tree_->find(point, radius_m);
}

Cloud IcpTarget::nearest(const Eigen::Vector3f& point, int count) const {
  return tree_->nearest(point, count);
}

namespace {

/// Nearest target points of a moving source. A point that has moved by m since its search keeps its nearest
/// neighbour, now at distance d, while d + m is below the distance that the second nearest had then: by the
/// triangle inequality nothing else can have come nearer. Most searches of late iterations are saved by that.
class Pairing {
 public:
  Pairing(const Cloud& source, const IcpTarget& target, double max_distance_m)
      : source_(source),
        target_(target),
        max_distance_m_(static_cast<float>(max_distance_m)),
        search_radius_m_(1.25f * max_distance_m_),
        memory_(source.size()) {}

  void update(const SE3& T_target_source) {
    const Eigen::Matrix3f r = T_target_source.matrix3().cast<float>();
    const Eigen::Vector3f t = T_target_source.translation.cast<float>();
    for (size_t i = 0; i < source_.size(); ++i) update(memory_[i], r * source_[i] + t);
  }

  size_t size() const { return source_.size(); }
  bool paired(size_t i) const {
    return memory_[i].found.nearest >= 0 && memory_[i].distance_m <= max_distance_m_;
  }
  float distance_m(size_t i) const { return memory_[i].distance_m; }
  const Eigen::Vector3f& source_point(size_t i) const { return source_[i]; }
  const Eigen::Vector3f& target_point(size_t i) const {
    return target_.points()[static_cast<size_t>(memory_[i].found.nearest)];
  }

 private:
  struct Memory {
    Eigen::Vector3f searched_at = Eigen::Vector3f::Constant(std::numeric_limits<float>::infinity());
    IcpTarget::Neighbours found;
    float distance_m = 0;
  };

  void update(Memory& m, const Eigen::Vector3f& point) const {
    const float moved_m = (point - m.searched_at).norm();  // infinite before the first search
    if (m.found.nearest >= 0)
      m.distance_m = (point - target_.points()[static_cast<size_t>(m.found.nearest)]).norm();
    const float now_m = m.found.nearest >= 0 ? m.distance_m : max_distance_m_;
    if (now_m + moved_m < m.found.next_distance_m) return;
    m.searched_at = point;
    m.found = target_.find(point, search_radius_m_);
    m.distance_m = m.found.distance_m;
  }

  const Cloud& source_;
  const IcpTarget& target_;
  float max_distance_m_, search_radius_m_;
  std::vector<Memory> memory_;
};

struct Moments {
  int count = 0;
  Vec3 mean_source = Vec3::Zero(), mean_target = Vec3::Zero();
  Mat3 cross = Mat3::Zero();  ///< sum of (target - mean) (source - mean)^T
  double mean_squared_m2 = 0;
};

Moments moments(const Pairing& pairing) {
  Moments m;
  double squared = 0;
  Mat3 products = Mat3::Zero();
  for (size_t i = 0; i < pairing.size(); ++i) {
    if (!pairing.paired(i)) continue;
    const Vec3 source = pairing.source_point(i).cast<double>(),
               target = pairing.target_point(i).cast<double>();
    const double distance = pairing.distance_m(i);
    ++m.count;
    m.mean_source += source;
    m.mean_target += target;
    products += target * source.transpose();
    squared += distance * distance;
  }
  if (m.count == 0) return m;
  m.mean_source /= m.count;
  m.mean_target /= m.count;
  m.cross = products - m.count * m.mean_target * m.mean_source.transpose();
  m.mean_squared_m2 = squared / m.count;
  return m;
}

/// The transform of least squared distance between the pairs (Umeyama 1991, without scale).
SE3 closed_form(const Moments& m) {
  const Eigen::JacobiSVD<Mat3> svd(m.cross, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Mat3 mirror = Mat3::Identity();
  if (svd.matrixU().determinant() * svd.matrixV().determinant() < 0) mirror(2, 2) = -1;
  const Quat q(Mat3(svd.matrixU() * mirror * svd.matrixV().transpose()));
  return {q, m.mean_target - q * m.mean_source};
}

/// PCL's criteria in PCL's order: iterations, size of the step, change of the mean squared distance.
bool stands_still(const SE3& step, double mse, double previous_mse, const IcpConfig& config) {
  if (step.angle() <= config.step_rotation_rad && step.translation.norm() <= config.step_translation_m)
    return true;
  constexpr double kSameMse = 1e-12;
  const double change = std::abs(mse - previous_mse);
  return change < kSameMse || change < config.relative_mse_change * previous_mse;
}

void score(const Pairing& pairing, double overlap_distance_m, IcpResult& result) {
  const Moments m = moments(pairing);
  if (m.count == 0) return;
  size_t near = 0;
  for (size_t i = 0; i < pairing.size(); ++i)
    if (pairing.paired(i) && pairing.distance_m(i) <= overlap_distance_m) ++near;
  const auto all = static_cast<double>(pairing.size());
  result.fitness_m2 = m.mean_squared_m2;
  result.inlier_ratio = m.count / all;
  result.overlap = static_cast<double>(near) / all;
}

/// Iterates until the transform stands still or `last_iteration` is reached. False: too few correspondences.
bool iterate(Pairing& pairing, const IcpConfig& config, int last_iteration, IcpResult& result) {
  double previous_mse = std::numeric_limits<double>::max();
  while (true) {
    pairing.update(result.T_target_source);
    const Moments m = moments(pairing);
    if (m.count < 3) return false;
    const SE3 before = result.T_target_source;
    result.T_target_source = closed_form(m);
    ++result.iterations;
    const SE3 step = result.T_target_source * before.inverse();
    if (result.iterations >= last_iteration || stands_still(step, m.mean_squared_m2, previous_mse, config))
      return true;
    previous_mse = m.mean_squared_m2;
  }
}

Cloud every_nth(const Cloud& cloud, int n) {
  Cloud out;
  for (size_t i = 0; i < cloud.size(); i += static_cast<size_t>(n)) out.push_back(cloud[i]);
  return out;
}

}  // namespace

IcpResult align(const Cloud& source, const IcpTarget& target, const SE3& T_target_source,
                const IcpConfig& config, double overlap_distance_m) {
  constexpr int kLeftForAll = 10;  // iterations
  IcpResult result;
  result.T_target_source = T_target_source;
  if (config.coarse_stride > 1 && config.max_iterations > kLeftForAll) {
    const Cloud coarse = every_nth(source, config.coarse_stride);
    Pairing pairing(coarse, target, config.max_correspondence_m);
    iterate(pairing, config, config.max_iterations - kLeftForAll, result);
  }
  Pairing pairing(source, target, config.max_correspondence_m);
  result.converged = iterate(pairing, config, config.max_iterations, result);
  pairing.update(result.T_target_source);
  score(pairing, overlap_distance_m, result);
  return result;
}

void score(const Cloud& source, const IcpTarget& target, double max_correspondence_m,
           double overlap_distance_m, IcpResult& result) {
  Pairing pairing(source, target, max_correspondence_m);
  pairing.update(result.T_target_source);
  score(pairing, overlap_distance_m, result);
}

}  // namespace vsslam

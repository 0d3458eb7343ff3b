// How well a point-to-plane problem is constrained: the blocks of H = sum J^T J and their eigenvalues.
#pragma once

#include "core/se3.h"

namespace vsslam {

/// One 3 x 3 block of H. Eigenvalues ascending; eigenvectors in columns, in the sensor (lidar) frame.
struct InformationBlock {
  Vec3 eigenvalues = Vec3::Zero();
  Mat3 eigenvectors = Mat3::Identity();
  /// Oblateness (l_max - l_min) / l_max, in [0, 1]; 1 if there is no information. Song et al. 2025,
  /// section 4.2.1.
  double alpha() const {
    return eigenvalues[2] > 0 ? (eigenvalues[2] - eigenvalues[0]) / eigenvalues[2] : 1.0;
  }
};

/// Information of a scan about its own pose: sensor-centred right perturbation [rotation; translation],
/// unweighted, one row J = [(p x n)^T, n^T] per correspondence.
struct Information {
  Mat6 H = Mat6::Zero();
  InformationBlock rotation, translation;
};

/// Fills the blocks of H.
Information analyse_information(const Mat6& H);

/// The row of J of a point with the normal of its plane, both in the sensor frame.
inline Vec6 point_to_plane_row(const Vec3& point_lidar, const Vec3& normal_lidar) {
  Vec6 row;
  row << point_lidar.cross(normal_lidar), normal_lidar;
  return row;
}

}  // namespace vsslam

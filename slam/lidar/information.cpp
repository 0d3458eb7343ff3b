#include "slam/lidar/information.h"

#include <Eigen/Eigenvalues>

namespace vsslam {

namespace {

InformationBlock analyse_block(const Mat3& block) {
  const Eigen::SelfAdjointEigenSolver<Mat3> solver(block);
  return {solver.eigenvalues().cwiseMax(0.0), solver.eigenvectors()};
}

}  // namespace

Information analyse_information(const Mat6& H) {
  return {H, analyse_block(H.topLeftCorner<3, 3>()), analyse_block(H.bottomRightCorner<3, 3>())};
}

}  // namespace vsslam

// Numbers as other systems' configuration files want them written.
#pragma once

#include <string>

#include "core/se3.h"

namespace vsslam {

struct DatasetFacts;

/// With a point, always: Python's YAML takes 1e-05 for a text, OpenCV's 1 for a whole number.
std::string real_text(double value);
/// "r00, r01, r02,\n<indent>r10, ..." row by row.
std::string matrix_text(const Mat3& R, const std::string& indent);
/// The same of the 4 x 4 matrix.
std::string matrix_text(const SE3& T, const std::string& indent);
/// "- [r00, r01, r02, x]" line by line, as kalibr writes them.
std::string kalibr_rows(const SE3& T, const std::string& indent);
std::string vector_text(const Vec3& v);  ///< "x, y, z"
/// Noise of one sample from a continuous-time density, and back for random walks: density * sqrt(rate).
double per_sample(double density, double rate_hz);
/// Thinning of clouds: as the scenario sets `slam.odometry.voxel_m`, else for indoors.
double leaf_size_m(const DatasetFacts& facts);

}  // namespace vsslam

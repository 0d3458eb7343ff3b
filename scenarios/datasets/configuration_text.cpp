#include "scenarios/datasets/configuration_text.h"

#include <fmt/format.h>

#include <cmath>

namespace vsslam {

std::string matrix_text(const Mat3& R, const std::string& indent) {
  std::string text;
  for (int r = 0; r < 3; ++r)
    text += fmt::format("{}{}, {}, {}", r == 0 ? "" : ",\n" + indent, R(r, 0), R(r, 1), R(r, 2));
  return text;
}

std::string matrix_text(const SE3& T, const std::string& indent) {
  const Eigen::Matrix4d m = T.matrix4();
  std::string text;
  for (int r = 0; r < 4; ++r)
    text += fmt::format("{}{}, {}, {}, {}", r == 0 ? "" : ",\n" + indent, m(r, 0), m(r, 1), m(r, 2), m(r, 3));
  return text;
}

std::string kalibr_rows(const SE3& T, const std::string& indent) {
  const Eigen::Matrix4d m = T.matrix4();
  std::string text;
  for (int r = 0; r < 4; ++r)
    text += fmt::format("{}- [{}, {}, {}, {}]\n", indent, m(r, 0), m(r, 1), m(r, 2), m(r, 3));
  return text;
}

std::string vector_text(const Vec3& v) {
  return fmt::format("{}, {}, {}", v.x(), v.y(), v.z());
}

double per_sample(double density, double rate_hz) {
  return density * std::sqrt(rate_hz);
}

}  // namespace vsslam

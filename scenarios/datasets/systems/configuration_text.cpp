#include "scenarios/datasets/systems/configuration_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scenarios/datasets/facts/dataset_facts.h"

namespace vsslam {

std::string real_text(double value) {
  std::string text = fmt::format("{}", value);
  if (text.find('.') == std::string::npos) text.insert(std::min(text.find('e'), text.size()), ".0");
  return text;
}

std::string matrix_text(const Mat3& R, const std::string& indent) {
  std::string text;
  for (int r = 0; r < 3; ++r)
    text += fmt::format("{}{}, {}, {}", r == 0 ? "" : ",\n" + indent, real_text(R(r, 0)), real_text(R(r, 1)),
                        real_text(R(r, 2)));
  return text;
}

std::string matrix_text(const SE3& T, const std::string& indent) {
  const Eigen::Matrix4d m = T.matrix4();
  std::string text;
  for (int r = 0; r < 4; ++r)
    text += fmt::format("{}{}, {}, {}, {}", r == 0 ? "" : ",\n" + indent, real_text(m(r, 0)),
                        real_text(m(r, 1)), real_text(m(r, 2)), real_text(m(r, 3)));
  return text;
}

std::string kalibr_rows(const SE3& T, const std::string& indent) {
  const Eigen::Matrix4d m = T.matrix4();
  std::string text;
  for (int r = 0; r < 4; ++r)
    text += fmt::format("{}- [{}, {}, {}, {}]\n", indent, real_text(m(r, 0)), real_text(m(r, 1)),
                        real_text(m(r, 2)), real_text(m(r, 3)));
  return text;
}

std::string vector_text(const Vec3& v) {
  return fmt::format("{}, {}, {}", real_text(v.x()), real_text(v.y()), real_text(v.z()));
}

double per_sample(double density, double rate_hz) {
  return density * std::sqrt(rate_hz);
}

double leaf_size_m(const DatasetFacts& facts) {
  constexpr double kIndoors_m = 0.2;
  return facts.scenario.slam.odometry.voxel_m.value_or(kIndoors_m);
}

}  // namespace vsslam

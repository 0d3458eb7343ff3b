// From an echo to what the device reports: bias, noise, lost echoes, quantisation, reflectivity byte.
#pragma once

#include <array>
#include <vector>

#include "core/rng.h"
#include "sensors/lidar/lidar_echo.h"

namespace vsslam {

struct alignas(64) ReportedPacket {
  int any[kLanes];
  float range_m[kLanes];
  float intensity[kLanes];
};

/// Extra range at grazing incidence: constant_m + per_m * range.
struct IncidenceBias {
  double constant_m, per_m;
};

/// The slanted footprint lengthens the echo (Laconte et al., ICRA 2019, fitted to an HDL-32E). Their two terms, the
/// detector's 7.08 mm * (1 / cos - 1) and the footprint's 0.0132 mm/m * range * tan^2, are met to 2 % from 1 to 40 m;
/// constant beyond 85 deg, where they end.
IncidenceBias incidence_bias(double cos_incidence);
double incidence_bias_m(double cos_incidence, double range_m);

class LidarErrors {
 public:
  LidarErrors(const LidarConfig& config, size_t lasers, uint64_t seed);
  /// `first_cycle`: of the packet's lane 0, counted from time 0.
  void report(const EchoPacket& echo, size_t laser, int64_t first_cycle, ReportedPacket& out) const;
  double laser_bias_m(size_t laser) const { return laser_bias_m_[laser]; }

 private:
  void add_bias_and_noise(const EchoPacket& echo, size_t laser, int64_t first_cycle,
                          float (&range_m)[kLanes]) const;
  void detect(const EchoPacket& echo, size_t laser, int64_t first_cycle, int (&any)[kLanes]) const;

  LidarConfig config_;
  RandomStream range_noise_, detection_noise_, intensity_noise_;
  const NormalTable& normal_;
  std::vector<float> laser_bias_m_;
  static constexpr int kBiasCells = 512;
  std::array<float, kBiasCells + 1> bias_constant_m_, bias_per_m_;  ///< incidence bias, by cos(incidence)
  float detection_gain_;
};

}  // namespace vsslam

#include "sim/vibration.h"

#include <cmath>

#include "core/rng.h"

namespace vsslam {

namespace {
constexpr double kShortest_m = 0.06,
                 kLongest_m = 0.17;  // 6 to 17 Hz at 1 m/s: the truth's knots resolve them
}

Vibration::Vibration(const ScoutConfig& scout)
    : scout_(scout),
      z_m_(waves(0, scout.vibration_accel_mps2, 2)),
      roll_rad_(waves(1, scout.vibration_rate_radps, 1)),
      pitch_rad_(waves(2, scout.vibration_rate_radps, 1)) {}

// Waves a sin(k s + phase) whose n-th derivatives by time at 1 m/s, of amplitude a k^n, have this RMS together.
Vibration::Waves Vibration::waves(uint64_t axis, double rms, int derivative) const {
  const RandomStream stream(scout_.vibration_seed, "vibration");
  Waves out;
  for (size_t i = 0; i < out.size(); ++i) {
    const double share =
        (static_cast<double>(i) + stream.uniform(axis, 2 * i)) / static_cast<double>(out.size());
    const double wavelength_m = kShortest_m * std::pow(kLongest_m / kShortest_m, share);
    out[i].k_radpm = 2 * M_PI / wavelength_m;
    out[i].amplitude =
        rms * std::sqrt(2.0 / static_cast<double>(out.size())) / std::pow(out[i].k_radpm, derivative);
    out[i].phase_rad = 2 * M_PI * stream.uniform(axis, 2 * i + 1);
  }
  return out;
}

void Vibration::roll_on(const RobotState& state, double dt_s) {
  double sum_radps = 0;
  for (const double radps : state.wheel_radps) sum_radps += std::abs(radps);
  rolled_m_ += 0.25 * sum_radps * scout_.wheel_radius_m * dt_s;
}

double Vibration::sum(const Waves& waves) const {
  double value = 0;
  for (const Wave& wave : waves)
    value += wave.amplitude * std::sin(wave.k_radpm * rolled_m_ + wave.phase_rad);
  return value;
}

SE3 Vibration::T_still_base() const {
  if (scout_.vibration_accel_mps2 == 0 && scout_.vibration_rate_radps == 0) return {};
  return {so3_exp({sum(roll_rad_), sum(pitch_rad_), 0}), {0, 0, sum(z_m_)}};
}

}  // namespace vsslam

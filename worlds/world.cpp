#include "worlds/world.h"

#include <cmath>
#include <numbers>

#include "core/rng.h"

namespace vsslam {

namespace {

constexpr int kWaves = 8;

/// One wave a sin(k . p + phase).
struct Wave {
  double amplitude_m, kx_radpm, ky_radpm, phase_rad;
};

// Wavelengths from the shortest to four times that, amplitude in proportion, so that slopes are alike.
// Independent sines of amplitude a have a mean square of a^2 / 2.
Wave wave(const Floor& floor, const RandomStream& stream, int i) {
  const auto stretch = [](int j) { return std::pow(4.0, static_cast<double>(j) / (kWaves - 1)); };
  double mean_square = 0;
  for (int j = 0; j < kWaves; ++j) mean_square += 0.5 * stretch(j) * stretch(j);
  const double k = 2 * std::numbers::pi / (floor.wavelength_m * stretch(i));
  const double heading = 2 * std::numbers::pi * stream.uniform(static_cast<uint64_t>(i), 0);
  return {.amplitude_m = floor.unevenness_m * stretch(i) / std::sqrt(mean_square),
          .kx_radpm = k * std::cos(heading),
          .ky_radpm = k * std::sin(heading),
          .phase_rad = 2 * std::numbers::pi * stream.uniform(static_cast<uint64_t>(i), 1)};
}

}  // namespace

double Floor::height(double x_m, double y_m) const {
  if (unevenness_m == 0) return height_m;
  const RandomStream stream(seed, "floor");
  double z_m = height_m;
  for (int i = 0; i < kWaves; ++i) {
    const Wave w = wave(*this, stream, i);
    z_m += w.amplitude_m * std::sin(w.kx_radpm * x_m + w.ky_radpm * y_m + w.phase_rad);
  }
  return z_m;
}

Vec3 Floor::normal(double x_m, double y_m) const {
  if (unevenness_m == 0) return Vec3::UnitZ();
  const RandomStream stream(seed, "floor");
  Vec3 n(0, 0, 1);  // (-dz/dx, -dz/dy, 1)
  for (int i = 0; i < kWaves; ++i) {
    const Wave w = wave(*this, stream, i);
    const double slope = w.amplitude_m * std::cos(w.kx_radpm * x_m + w.ky_radpm * y_m + w.phase_rad);
    n -= slope * Vec3(w.kx_radpm, w.ky_radpm, 0);
  }
  return n.normalized();
}

size_t World::triangle_count() const {
  size_t count = 0;
  for (const Object& object : objects)
    for (const Primitive& primitive : meshes[static_cast<size_t>(object.mesh)].primitives)
      count += primitive.triangles.size();
  return count;
}

}  // namespace vsslam

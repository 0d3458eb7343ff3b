#include "slam/loop/scan_context.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numbers>

namespace vsslam {

namespace {

constexpr float kPi = std::numbers::pi_v<float>, kSectorsPerRad = kSectors / (2 * kPi);

// 0..59: clamp(ceil(theta / 360 deg * 60), 1, 60) - 1.
int exact_sector(float x, float y) {
  const float theta = std::atan2(y, x);  // atan2(0, 0) is 0
  const float turn = theta < 0 ? theta + 2 * kPi : theta;
  return std::clamp(static_cast<int>(std::ceil(turn * kSectorsPerRad)), 1, kSectors) - 1;
}

// The same without the library's atan2, which would be most of a descriptor's time, wherever the border is not near.
int sector_of(float x, float y) {
  const float far = std::max(std::abs(x), std::abs(y)), near = std::min(std::abs(x), std::abs(y));
  const float z = near / far, z2 = z * z;
  // The odd polynomial of this degree that is nearest to atan on [0, 1] (Remez): off by 1.7e-6 rad.
  float turn = z * (0.99997722f +
                    z2 * (-0.33262283f +
                          z2 * (0.19354038f + z2 * (-0.11642648f + z2 * (0.05264735f + z2 * -0.01171914f)))));
  if (std::abs(y) > std::abs(x)) turn = kPi / 2 - turn;
  if (x < 0) turn = kPi - turn;
  if (y < 0) turn = 2 * kPi - turn;
  const float sectors = turn * kSectorsPerRad, end = std::ceil(sectors);
  constexpr float kNear = 1e-4f;  // of a sector; six times what the polynomial is off by
  const bool inside = end - sectors > kNear && end - sectors < 1 - kNear;  // false at the origin: 0 / 0
  return inside ? static_cast<int>(end) - 1 : exact_sector(x, y);
}

}  // namespace

PolarHeights polar_heights(const Cloud& points_lidar, double mount_height_m, const ScanContextConfig& config,
                           const Eigen::Vector2d& offset_m) {
  PolarHeights heights = PolarHeights::Zero();
  const auto max_range = static_cast<float>(config.max_range_m),
             mount_height = static_cast<float>(mount_height_m);
  const Eigen::Vector2f offset = offset_m.cast<float>();
  const float rings_per_m = kRings / max_range;
  for (const Eigen::Vector3f& point : points_lidar) {
    const float x = point.x() - offset.x(), y = point.y() - offset.y();
    const float r = std::sqrt(x * x + y * y);
    if (!(r <= max_range)) continue;
    const int ring = std::clamp(static_cast<int>(std::ceil(r * rings_per_m)), 1, kRings) - 1;
    float& height = heights(ring, sector_of(x, y));
    height = std::max(height, point.z() + mount_height);
  }
  return heights;
}

namespace {

constexpr int kFrequencies = kSectors / 2 + 1;
constexpr int kPadded = RingSpectra::RowsAtCompileTime;
constexpr uint64_t kAllSectors = (uint64_t{1} << kSectors) - 1;

/// cos and sin of 2 pi frequency sector / 60.
struct Waves {
  Eigen::Matrix<float, kPadded, kSectors> cosine = decltype(cosine)::Zero(), sine = decltype(sine)::Zero();
  /// The same for the way back, for shifts 0..30: with 1/60, and twice where a frequency stands for its
  /// mirror too.
  Eigen::Matrix<float, kPadded, kFrequencies> back_cosine, back_sine;

  Waves() {
    for (int k = 0; k < kFrequencies; ++k)
      for (int j = 0; j < kSectors; ++j) {
        const double angle = 2 * std::numbers::pi * ((k * j) % kSectors) / kSectors;
        cosine(k, j) = static_cast<float>(std::cos(angle));
        sine(k, j) = static_cast<float>(std::sin(angle));
      }
    Eigen::Matrix<float, kPadded, 1> share = Eigen::Matrix<float, kPadded, 1>::Constant(2.0f / kSectors);
    share[0] = share[kFrequencies - 1] = 1.0f / kSectors;
    back_cosine = share.asDiagonal() * cosine.leftCols<kFrequencies>();
    back_sine = share.asDiagonal() * sine.leftCols<kFrequencies>();
  }
};

const Waves& waves() {
  static const Waves table;
  return table;
}

/// Bit j of the result is bit (j + shift) mod 60 of the mask.
uint64_t rotate(uint64_t mask, int shift) {
  if (shift == 0) return mask;
  return ((mask >> shift) | (mask << (kSectors - shift))) & kAllSectors;
}

/// sums[s] = sum over j of q_j . c_(j+s), a circular correlation: its spectrum is conj(Q) C, summed over
/// rings. Empty columns are zero and add nothing.
std::array<float, kSectors> cosine_sums(const ScanContext& q, const ScanContext& c) {
  using Spectrum = Eigen::Array<float, kPadded, 1>;
  Spectrum real = Spectrum::Zero(), imaginary = Spectrum::Zero();
  for (int ring = 0; ring < kRings; ++ring) {
    real += q.real.col(ring) * c.real.col(ring) + q.imaginary.col(ring) * c.imaginary.col(ring);
    imaginary += q.real.col(ring) * c.imaginary.col(ring) - q.imaginary.col(ring) * c.real.col(ring);
  }
  const Waves& table = waves();
  std::array<float, kSectors> sums{};
  for (int s = 0; s < kFrequencies; ++s) {
    const float even = (real * table.back_cosine.col(s).array()).sum();
    const float odd = (imaginary * table.back_sine.col(s).array()).sum();
    sums[static_cast<size_t>(s)] = even - odd;
    if (s > 0) sums[static_cast<size_t>(kSectors - s)] = even + odd;
  }
  return sums;
}

}  // namespace

ScanContext::ScanContext(const PolarHeights& heights)
    : ring_key(heights.rowwise().mean()), sector_key(heights.colwise().mean().transpose()) {
  PolarHeights columns = PolarHeights::Zero();
  for (int j = 0; j < kSectors; ++j) {
    const float norm = heights.col(j).norm();
    if (norm <= 0) continue;
    columns.col(j) = heights.col(j) / norm;
    occupied |= uint64_t{1} << j;
  }
  real.matrix().noalias() = waves().cosine * columns.transpose();
  imaginary.matrix().noalias() = -(waves().sine * columns.transpose());
}

double ShiftedDistance::yaw_rad() const {
  const int turns = shift <= kSectors / 2 ? shift : shift - kSectors;
  return turns * (2 * std::numbers::pi / kSectors);
}

ShiftedDistance scan_context_distance(const ScanContext& query, const ScanContext& stored) {
  const std::array<float, kSectors> sums = cosine_sums(query, stored);
  ShiftedDistance best;
  for (int shift = 0; shift < kSectors; ++shift) {
    const int pairs = std::popcount(query.occupied & rotate(stored.occupied, shift));
    if (pairs < kSectors / 2) continue;
    const double distance = 1.0 - static_cast<double>(sums[static_cast<size_t>(shift)]) / pairs;
    if (distance < best.distance) best = {distance, shift};
  }
  return best;
}

}  // namespace vsslam

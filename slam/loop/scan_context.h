// Scan Context (Kim and Kim, IROS 2018; Kim, Choi and Kim, T-RO 2022): the highest point of each cell of a
// polar grid around the LiDAR, and a distance between two such grids that does not depend on heading.
#pragma once

#include <cstdint>

#include "slam/lidar/cloud.h"
#include "slam/loop/loop_config.h"

namespace vsslam {

inline constexpr int kRings = 20, kSectors = 60;

/// Height above the ground in m, 0 where a cell is empty or below ground. Rows are rings outwards, columns
/// sectors of 6 deg counter-clockwise from the LiDAR's x axis.
using PolarHeights = Eigen::Matrix<float, kRings, kSectors>;

/// ring = clamp(ceil(r / r_max * 20), 1, 20), sector = clamp(ceil(theta / 360 deg * 60), 1, 60).
/// `offset_m` moves the sensor in its own x-y plane: the grid of the cloud as seen from there.
PolarHeights polar_heights(const Cloud& points_lidar, double mount_height_m, const ScanContextConfig& config,
                           const Eigen::Vector2d& offset_m = Eigen::Vector2d::Zero());

/// Real and imaginary parts of a spectrum over sectors, one column per ring. 31 frequencies, padded to 32.
using RingSpectra = Eigen::Array<float, 32, kRings>;

/// What is stored of a scan. Columns are scaled to unit length (empty ones stay zero) and each ring is kept
/// as its discrete Fourier transform over the sectors, in which all 60 shifts cost little more than one.
struct ScanContext {
  RingSpectra real = RingSpectra::Zero(), imaginary = RingSpectra::Zero();
  uint64_t occupied = 0;                         ///< bit j: column j is not empty
  Eigen::Matrix<float, kRings, 1> ring_key;      ///< row means of the heights
  Eigen::Matrix<float, kSectors, 1> sector_key;  ///< column means

  ScanContext() : ScanContext(PolarHeights(PolarHeights::Zero())) {}
  explicit ScanContext(const PolarHeights& heights);
};

/// Distance of a query to a stored scan, minimised over all 60 shifts. A sector j of the query corresponds to
/// sector (j + shift) mod 60 of the stored scan.
struct ShiftedDistance {
  double distance = 1.0;  ///< rounded to about 1e-6
  int shift = 0;

  /// Yaw of the query in the stored scan's frame, in (-pi, pi].
  double yaw_rad() const;
};

/// Mean of 1 - cosine over the pairs of occupied columns; 1 if they are fewer than half of all (equation 4).
ShiftedDistance scan_context_distance(const ScanContext& query, const ScanContext& stored);

}  // namespace vsslam

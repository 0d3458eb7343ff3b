// Least-squares alignment of two trajectories: Umeyama, "Least-squares estimation of transformation
// parameters between two point patterns", PAMI 13 (1991).
#pragma once

#include <span>

#include "core/se3.h"

namespace vsslam {

enum class Alignment { none, se3, sim3 };

/// p_truth = T_truth_estimate * (scale * p_estimate).
struct Similarity {
  double scale = 1.0;
  SE3 T_truth_estimate;

  Vec3 operator*(const Vec3& p_estimate) const { return T_truth_estimate * (scale * p_estimate); }
  SE3 operator*(const SE3& T_estimate_x) const {
    return T_truth_estimate * SE3(T_estimate_x.rotation, scale * T_estimate_x.translation);
  }
};

/// Minimises sum |truth_i - s R estimate_i - t|^2; s = 1 unless `with_scale`. Spans of the same length, at
/// least one point. Where points on a line or a single point leave the rotation open, the result is one of
/// the minimisers (for a single point: a translation).
Similarity align_points(std::span<const Vec3> estimate, std::span<const Vec3> truth, bool with_scale);

/// T_truth_estimate from positions and orientations: the rotation is the chordal mean of R_truth_i R_estimate_i^T,
/// the translation joins the centroids. Unlike align_points it is determined on a straight line too. Spans of
/// the same length, at least one pose.
SE3 align_poses(std::span<const SE3> estimate, std::span<const SE3> truth);

}  // namespace vsslam

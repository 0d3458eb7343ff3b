// The camera's rotation between two images, from matches alone.
#pragma once

#include <optional>
#include <vector>

#include "slam/vision/epipolar.h"

namespace vsslam {

/// q_last_now by the five-point method (Nister, PAMI 2004) in RANSAC; of the essential matrix's two rotations
/// the smaller. `threshold`: distance from the epipolar line for a focal length of 1. Empty if there is none.
std::optional<Quat> rotation_of_matches(const std::vector<RayMatch>& matches, double threshold);

}  // namespace vsslam

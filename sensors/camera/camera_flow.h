// How static points move through the image between two poses of the camera.
#pragma once

#include <vector>

#include "sensors/camera/camera_optics.h"

namespace vsslam {

/// For each ray of `rays` (row-major), seen from pose `a` at depth `depth_m`: the image point of the same world point
/// from pose `b` minus that from pose `a`, px. Infinite depth moves by rotation alone; infinite where the point lies
/// behind `b`.
std::vector<Vec2f> flow(const CameraOptics& optics, const ViewRays& rays, const std::vector<float>& depth_m,
                        const SE3& T_b_a);

/// Length that 95 % of these vectors do not exceed, px; points behind count as infinite.
double length_of_most(const std::vector<Vec2f>& flow_px);

}  // namespace vsslam

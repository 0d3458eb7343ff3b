// What the visual front end sees in one image: features with names that last as long as they are tracked.
#pragma once

#include <cstdint>
#include <vector>

#include "core/se3.h"
#include "core/time.h"

namespace vsslam {

struct VisualFeature {
  int64_t id = 0;                  ///< the same point of the scene in all frames; never used again
  Vec2 pixel_px = Vec2::Zero();    ///< as measured, distortion included
  Vec2 ray_camera = Vec2::Zero();  ///< undistorted direction (x / z, y / z) in the camera frame
  double depth_m = 0;              ///< along the camera's z axis, from the LiDAR; 0: unknown
};

/// Features of one image, in order of id.
struct VisualFrame {
  Time stamp;  ///< mid-exposure, by the camera's clock
  std::vector<VisualFeature> features;
};

}  // namespace vsslam

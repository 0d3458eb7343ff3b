// Which matches between two images fit one rigid motion of the camera.
#pragma once

#include <cstdint>
#include <vector>

#include "core/config.h"
#include "core/se3.h"
#include "core/time.h"

namespace vsslam {

/// One point of the scene in two images: directions (x / z, y / z, 1) in the two camera frames.
struct RayMatch {
  Vec3 last, now;
};

struct EpipolarConfig {
  double threshold_px = 1.0;      ///< distance from the epipolar line, at a focal length of 460 px
  int hypotheses = 100;           ///< directions of translation that are tried
  double min_inlier_share = 0.7;  ///< below it the rotation is estimated from the matches as well
  void fields(Fields& f);
};

/// The camera's motion that most matches agree with.
struct RigidMotion {
  std::vector<uint8_t> fits;           ///< 1 for each match that agrees, in their order
  Quat q_last_now = Quat::Identity();  ///< as given, or as estimated where that explains more matches
};

/// Given the rotation (coordinates in `now` to coordinates in `last`) the rest is a direction of translation,
/// which two matches give: cheap, and without the degenerate cases of a fundamental matrix (standing still, pure
/// rotation, planes). Without it, or where too few matches agree with it, one estimated from the matches
/// competes with it (or with no rotation). The draw depends on `stamp` only.
RigidMotion rigid_motion(const std::vector<RayMatch>& matches, const Quat* q_last_now, Time stamp,
                         const EpipolarConfig& config);

}  // namespace vsslam

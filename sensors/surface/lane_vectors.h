// Eight vectors of three numbers at once.
#pragma once

#include "sensors/surface/lanes.h"
#include "worlds/world.h"

namespace vsslam::lanes {

struct Vectors {
  Floats x, y, z;
  Vectors operator-(const Vectors& o) const { return {x - o.x, y - o.y, z - o.z}; }
  Floats dot(const Vectors& o) const { return x * o.x + y * o.y + z * o.z; }
  Floats dot(const Vec3f& o) const { return x * o.x() + y * o.y() + z * o.z(); }
  Vectors cross(const Vectors& o) const { return {y * o.z - z * o.y, z * o.x - x * o.z, x * o.y - y * o.x}; }
  /// Negated where the sign bit is set.
  Vectors signed_by(Ints sign) const {
    return {(Floats)((Ints)x ^ sign), (Floats)((Ints)y ^ sign), (Floats)((Ints)z ^ sign)};
  }
};

}  // namespace vsslam::lanes

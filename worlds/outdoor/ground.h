// What lies on the ground: surfaces of one material, and beds with a kerb around them.
#pragma once

#include "worlds/kit/floor_plan.h"
#include "worlds/kit/mesh_builder.h"

namespace vsslam {

/// A level rectangle, cut in pieces of at most `piece_m`; its texture is fixed to the world's axes.
void pave(MeshBuilder& builder, const Finish& finish, const Rect& rect, double height_m, double piece_m = 8);

inline constexpr double kKerbWidth_m = 0.16;

/// Kerb stones along the inside of a rectangle's edge, `height_m` above `base_m`, and the bed between them.
void raise_bed(MeshBuilder& builder, const Finish& kerb, const Finish& bed, const Rect& rect, double base_m,
               double height_m);

Rect shrunk(const Rect& rect, double by_m);

}  // namespace vsslam

// Things that stand about outdoors. Meshes have their foot at the origin and face +x.
#pragma once

#include "worlds/kit/mesh_builder.h"
#include "worlds/kit/outdoor_palette.h"

namespace vsslam {

inline constexpr double kLampHead_m = 5.0;   ///< height of a street lamp's luminous panel ...
inline constexpr double kLampReach_m = 1.1;  ///< ... and how far before its foot it hangs
inline constexpr double kLampArea_m2 = 0.4 * 0.3;

Mesh make_street_lamp(const OutdoorPalette& palette);
Mesh make_sign_pole(const OutdoorPalette& palette);
Mesh make_street_bench(const OutdoorPalette& palette);
Mesh make_bin(const OutdoorPalette& palette);
Mesh make_bollard(const OutdoorPalette& palette);
/// A round column with posters, 1.3 m thick.
Mesh make_advert_column(const OutdoorPalette& palette);
/// A stone trough with a shrub, 1.2 m x 1.2 m.
Mesh make_planter(const OutdoorPalette& palette);
/// 2.5 m along y: posts at its ends, three rails and upright bars that most rays pass between.
Mesh make_fence(const OutdoorPalette& palette);
Mesh make_flagpole(const OutdoorPalette& palette);
/// A stepped pedestal with a stone on it, 3 m x 3 m.
Mesh make_monument(const OutdoorPalette& palette);

/// `variant` chooses body and paint.
Mesh make_car(const OutdoorPalette& palette, int variant);
inline constexpr double kCarLength_m = 4.5, kCarWidth_m = 1.8;

/// Somebody who stands; `variant` chooses clothes, height and how the arms hang.
Mesh make_person(const OutdoorPalette& palette, int variant);

}  // namespace vsslam

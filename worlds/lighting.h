// How the world is lit: which of its lights shine, and how strongly.
#pragma once

#include <cstdint>
#include <vector>

#include "core/config.h"
#include "worlds/world.h"

namespace vsslam {

/// The `lighting` section of a scenario. LiDAR scans do not depend on it; images do.
struct LightingConfig {
  /// even: all lamps burn. non_uniform: stretches without light, and lamps of unequal age. low: all dimmed.
  /// dark: only emergency lamps, and the headlight. bright: over-bright lamps, daylight in the panes.
  /// In a world with a sun (a directional light): even: the sun through thin clouds. low: dusk, the sun has set.
  /// dark: night. In both its lamps burn fully. bright: a clear sun, bright_level times as strong.
  enum class Preset { even, non_uniform, low, dark, bright };
  enum class Switch { automatic, on, off };

  Preset preset = Preset::even;
  uint64_t seed = 1;                      ///< of what non_uniform draws
  double off_share = 0.4;                 ///< non_uniform: of the stretches
  double off_stretch_m = 9;               ///< non_uniform: lamps go out together within squares of this size
  double dimmest_level = 0.4;             ///< non_uniform: lamps that burn have a level between this and 1
  double low_level = 0.05;                ///< low: of lamps indoors, and of the sky
  double bright_level = 4;                ///< bright: of lamps and sun
  double window_luminance_cdpm2 = 10000;  ///< bright: of panes of glass
  double sky_luminance_cdpm2 =
      4000;                      ///< overcast, in the zenith; where the world has a sun or no light at all
  double night_level = 0.00002;  ///< dark: of sky and sun
  Switch headlight = Switch::automatic;  ///< automatic: in the dark preset
  double headlight_intensity_cd = 150;
  double headlight_cone_deg = 45;  ///< half the opening angle

  void fields(Fields& f);
};

/// Moves with the camera and shines along its axis, evenly within three quarters of its cone.
struct Headlight {
  double intensity_cd = 0;  ///< 0: none
  double cone_rad = 0.7853981633974483;
};

/// What a preset makes of a world.
struct Illumination {
  std::vector<double> light_level;   ///< factor of each of World::lights
  double sky_luminance_cdpm2 = 0;    ///< in the zenith
  double glass_luminance_cdpm2 = 0;  ///< of what is seen through glass
  bool ambient = false;              ///< a world without any light: the sky reaches into closed rooms, too
  Headlight headlight;
};
Illumination illuminate(const World& world, const LightingConfig& config);

}  // namespace vsslam

#include "worlds/lighting.h"

namespace vsslam {

void LightingConfig::fields(Fields& f) {
  f.choice("preset", preset,
           {{"even", Preset::even},
            {"non_uniform", Preset::non_uniform},
            {"low", Preset::low},
            {"dark", Preset::dark},
            {"bright", Preset::bright}});
}

}  // namespace vsslam

// Where a scenario's world comes from: a generator with its parameters, or a glTF file.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/config.h"
#include "worlds/indoor/corridor.h"
#include "worlds/indoor/room.h"
#include "worlds/outdoor/gate.h"
#include "worlds/outdoor/street.h"
#include "worlds/world.h"

namespace vsslam {

/// The `world` section of a scenario, and the content of worlds/library/*.yaml.
struct WorldSource {
  enum class Generator { corridor, room, street, gate };
  std::string file;  ///< .glb or .gltf; wins over the generator. Relative to the file that names it.
  Generator generator = Generator::corridor;
  CorridorConfig corridor;
  RoomConfig room;
  StreetConfig street;
  GateConfig gate;

  void fields(Fields& f);
};

/// Generates or loads. Deterministic. Throws InputError.
World make_world(const WorldSource& source);

/// Words that `generator` may be.
const std::vector<std::string>& generator_names();

}  // namespace vsslam

// Where a scenario's world comes from: a generator with its parameters, or a glTF file.
#pragma once

#include <filesystem>
#include <string>

#include "core/config.h"
#include "worlds/corridor.h"
#include "worlds/room.h"
#include "worlds/world.h"

namespace vsslam {

/// The `world` section of a scenario, and the content of worlds/library/*.yaml.
struct WorldSource {
  enum class Generator { corridor, room };
  std::string file;  ///< .glb or .gltf; wins over the generator. Relative to the file that names it.
  Generator generator = Generator::corridor;
  CorridorConfig corridor;
  RoomConfig room;

  void fields(Fields& f);
};

/// Generates or loads. Deterministic. Throws InputError.
World make_world(const WorldSource& source);

}  // namespace vsslam

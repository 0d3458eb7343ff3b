#include "worlds/world_source.h"

#include "worlds/gltf.h"

namespace vsslam {

void WorldSource::fields(Fields& f) {
  f.base("worlds", *this);
  f("file", file);
  if (f.loading() && !file.empty() && std::filesystem::path(file).is_relative())
    file = (f.folder() / file).lexically_normal().string();
  f.choice("generator", generator, {{"corridor", Generator::corridor}, {"room", Generator::room}});
  // Only the section that is in use, so that a key in the other one is an error and tails stay unambiguous.
  if (generator == Generator::corridor) f("corridor", corridor);
  if (generator == Generator::room) f("room", room);
}

World make_world(const WorldSource& source) {
  if (!source.file.empty()) return read_gltf(source.file);
  return source.generator == WorldSource::Generator::corridor ? make_corridor(source.corridor)
                                                              : make_room(source.room);
}

}  // namespace vsslam

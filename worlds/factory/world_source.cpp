#include "worlds/factory/world_source.h"

#include "worlds/gltf/gltf.h"

namespace vsslam {

void WorldSource::fields(Fields& f) {
  f.base("worlds", *this);
  f("file", file);
  if (f.loading() && !file.empty() && std::filesystem::path(file).is_relative())
    file = (f.folder() / file).lexically_normal().string();
  f.choice("generator", generator,
           {{"corridor", Generator::corridor},
            {"room", Generator::room},
            {"street", Generator::street},
            {"gate", Generator::gate}});
  // Only the section that is in use, so that a key in another one is an error and tails stay unambiguous.
  if (generator == Generator::corridor) f("corridor", corridor);
  if (generator == Generator::room) f("room", room);
  if (generator == Generator::street) f("street", street);
  if (generator == Generator::gate) f("gate", gate);
}

World make_world(const WorldSource& source) {
  if (!source.file.empty()) return read_gltf(source.file);
  switch (source.generator) {
    case WorldSource::Generator::corridor:
      return make_corridor(source.corridor);
    case WorldSource::Generator::room:
      return make_room(source.room);
    case WorldSource::Generator::street:
      return make_street(source.street);
    case WorldSource::Generator::gate:
      return make_gate(source.gate);
  }
  return {};
}

const std::vector<std::string>& generator_names() {
  static const std::vector<std::string> names{"corridor", "room", "street", "gate"};
  return names;
}

}  // namespace vsslam

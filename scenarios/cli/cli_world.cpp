#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>

#include "core/errors.h"
#include "scenarios/cli/cli.h"
#include "scenarios/experiment/library_files.h"
#include "worlds/describe.h"
#include "worlds/factory/world_source.h"
#include "worlds/gltf/gltf.h"

namespace vsslam {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

struct WorldArguments {
  std::string world;
  std::vector<std::string> settings;
  std::string glb;
  bool info = false;
};

bool is_gltf(const fs::path& path) {
  return path.extension() == ".glb" || path.extension() == ".gltf";
}

// A library world, a generator's name, a .yaml of a world, or a glTF file.
World load_world(const WorldArguments& arguments) {
  std::vector<Override> overrides;
  for (const std::string& setting : arguments.settings) overrides.push_back(Override::parse(setting));
  if (is_gltf(arguments.world)) {
    if (!overrides.empty())
      throw InputError("--set: a glTF file has no settings; name a world of the library");
    return read_gltf(find_file("worlds", arguments.world));
  }
  WorldSource source;
  const auto holds = [&](const std::vector<std::string>& names) {
    return std::find(names.begin(), names.end(), arguments.world) != names.end();
  };
  if (!holds(library_names("worlds")) && holds(generator_names())) {
    load_config_text("generator: " + arguments.world, arguments.world, source, library(), overrides);
  } else {
    load_config(find_file("worlds", arguments.world), source, library(), overrides);
  }
  return make_world(source);
}

Json facts(const World& world) {
  const Bounds box = bounds(world);
  Json routes = Json::array();
  for (const Route& route : world.routes) {
    double length_m = 0;
    const size_t count = route.points_world.size();
    for (size_t i = 1; i < count + (route.closed ? 1 : 0); ++i)
      length_m += (route.points_world[i % count] - route.points_world[i - 1]).norm();
    routes.push_back(
        {{"name", route.name}, {"closed", route.closed}, {"points", count}, {"length_m", length_m}});
  }
  return {{"name", world.name},
          {"triangles", world.triangle_count()},
          {"objects", world.objects.size()},
          {"meshes", world.meshes.size()},
          {"materials", world.materials.size()},
          {"textures", world.textures.size()},
          {"lights", world.lights.size()},
          {"extent",
           {{"low_m", {box.low_world.x(), box.low_world.y(), box.low_world.z()}},
            {"high_m", {box.high_world.x(), box.high_world.y(), box.high_world.z()}}}},
          {"routes", routes}};
}

int show_world(const WorldArguments& arguments, const Console& console) {
  const World world = load_world(arguments);
  if (!arguments.glb.empty()) {
    if (fs::path(arguments.glb).extension() != ".glb")
      throw InputError(fmt::format("--out {}: expected a name that ends in .glb", arguments.glb));
    write_glb(world, arguments.glb);
    console.err << "wrote " << arguments.glb << '\n';
  }
  if (console.json) {
    console.out << facts(world).dump(2) << '\n';
  } else if (arguments.info || arguments.glb.empty()) {
    console.out << describe(world);
  }
  return kDone;
}

}  // namespace

void add_world_command(CLI::App& app, Console& console, Command& command) {
  CLI::App* sub = app.add_subcommand("world", "generate a world and write it as .glb, or describe one");
  const auto arguments = std::make_shared<WorldArguments>();
  sub->add_option("world", arguments->world,
                  "a name from the library, a generator, or a .yaml, .glb or .gltf file")
      ->required();
  sub->add_option("--set", arguments->settings,
                  "key=value; changes a setting of the generator; may be repeated")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  sub->add_option("--out", arguments->glb, "the .glb file to write");
  sub->add_flag("--info", arguments->info, "describe the world");
  add_common_options(*sub, console);
  sub->callback([&console, &command, arguments] {
    command = [&console, arguments] { return show_world(*arguments, console); };
  });
}

}  // namespace vsslam

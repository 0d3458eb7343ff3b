#include "worlds/indoor_world.h"

#include <utility>

namespace vsslam {

void add_shell(World& world, Shell shell) {
  const auto add = [&](Mesh& mesh, Collision collision) {
    world.objects.push_back(
        {.name = mesh.name, .mesh = static_cast<int>(world.meshes.size()), .collision = collision});
    world.meshes.push_back(std::move(mesh));
  };
  add(shell.floor, Collision::none);
  add(shell.walls, Collision::mesh);
  add(shell.ceiling, Collision::none);
}

void adopt_palette(World& world, IndoorPalette palette) {
  std::vector<int> new_material(palette.materials.size(), -1), new_texture(palette.textures.size(), -1);
  for (Mesh& mesh : world.meshes)
    for (Primitive& primitive : mesh.primitives) new_material[static_cast<size_t>(primitive.material)] = 0;
  for (size_t m = 0; m < palette.materials.size(); ++m) {
    if (new_material[m] < 0) continue;
    new_material[m] = static_cast<int>(world.materials.size());
    int& texture = palette.materials[m].base_color_texture;
    if (texture >= 0) {
      int& kept = new_texture[static_cast<size_t>(texture)];
      if (kept < 0) {
        kept = static_cast<int>(world.textures.size());
        world.textures.push_back(std::move(palette.textures[static_cast<size_t>(texture)]));
      }
      texture = kept;
    }
    world.materials.push_back(std::move(palette.materials[m]));
  }
  for (Mesh& mesh : world.meshes)
    for (Primitive& primitive : mesh.primitives)
      primitive.material = new_material[static_cast<size_t>(primitive.material)];
}

}  // namespace vsslam

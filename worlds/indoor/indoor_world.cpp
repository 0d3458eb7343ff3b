#include "worlds/indoor/indoor_world.h"

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

}  // namespace vsslam

#include "worlds/gltf.h"

#include "core/errors.h"
namespace vsslam {
World read_gltf(const std::filesystem::path& path) {
  throw InputError(path.string() + ": glTF reading is not there yet");
}
void write_glb(const World&, const std::filesystem::path& path) {
  throw InputError(path.string() + ": glTF writing is not there yet");
}
}  // namespace vsslam

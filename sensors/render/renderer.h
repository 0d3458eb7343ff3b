// Radiance images of the world for any camera pose: traced primary rays, filtered textures, baked light maps.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "core/se3.h"
#include "sensors/ray/raycaster.h"
#include "sensors/ray/view_rays.h"
#include "worlds/lighting.h"
#include "worlds/world.h"

namespace vsslam {

/// One instant seen through ViewRays, row-major.
struct View {
  std::vector<float> luminance;  ///< cd/m^2, linear
  std::vector<float> depth_m;    ///< along the camera's z axis; infinity: nothing hit
};

/// Factor of each light group of the world (`Light::group`) against its own intensity.
struct LightLevels {
  std::vector<float> of_group;  ///< in order of Renderer::light_groups()
};

class Renderer {
 public:
  /// Bakes the light maps. World and raycaster must outlive the renderer.
  Renderer(const World& world, const Raycaster& raycaster, const LightingConfig& lighting);
  ~Renderer();

  const std::vector<std::string>& light_groups() const;
  /// Changes what shines from the next render() on; not thread-safe against it.
  void set_light_levels(const LightLevels& levels);
  /// Thread-safe; the same bytes for any number of threads.
  void render(const SE3& T_world_camera, const ViewRays& rays, View& view) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace vsslam

// Motion blur within a view: the scene flows past the pixels while they collect light.
#pragma once

#include <vector>

#include "sensors/render/renderer.h"

namespace vsslam {

/// Adds to `light` what each pixel collects while the view flows by `flow_px` (both row-major, as the view): the mean
/// of its luminance at points spread evenly over the flow, which is centred on the pixel, at most `spacing_px` apart.
/// Bilinear between pixels; beyond the edge of the image its last pixels go on.
///
/// Exact where the flow is the same all along it. What an object uncovers behind its edge was not seen in this view: the
/// edge stays as sharp on that side as it was.
void add_smeared(const View& view, int width_px, const std::vector<Vec2f>& flow_px, float spacing_px,
                 std::vector<float>& light);

}  // namespace vsslam

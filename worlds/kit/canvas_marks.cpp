#include "worlds/kit/canvas_marks.h"

#include <cmath>
#include <numbers>

namespace vsslam {

void spots(Canvas& canvas, Draws& draw, int count, double smallest_m, double largest_m, float strongest) {
  for (int i = 0; i < count; ++i) {
    const double x = draw(0, canvas.width_m()), y = draw(0, canvas.height_m());
    const float tone = static_cast<float>(draw(0.1, 0.5)), opacity = static_cast<float>(draw(0.1, strongest));
    canvas.disc(x, y, draw(smallest_m, largest_m), Vec3f::Constant(tone), opacity);
  }
}

void cracks(Canvas& canvas, Draws& draw, int count, int pieces, double piece_m, float opacity) {
  for (int crack = 0; crack < count; ++crack) {
    double x = draw(0, canvas.width_m()), y = draw(0, canvas.height_m());
    double heading = draw(0, 2 * std::numbers::pi);
    for (int i = 0; i < pieces; ++i) {
      heading += draw(-0.7, 0.7);
      const double to_x = x + piece_m * std::cos(heading), to_y = y + piece_m * std::sin(heading);
      canvas.stroke(x, y, to_x, to_y, draw(0.004, 0.012), Vec3f::Constant(0.08f), opacity);
      x = to_x, y = to_y;
    }
  }
}

}  // namespace vsslam

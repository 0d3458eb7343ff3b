#include "worlds/outdoor/ground.h"

#include <algorithm>
#include <cmath>

namespace vsslam {

Rect shrunk(const Rect& r, double by_m) {
  return {r.x0 + by_m, r.y0 + by_m, r.x1 - by_m, r.y1 - by_m};
}

void pave(MeshBuilder& builder, const Finish& finish, const Rect& r, double height_m, double piece_m) {
  const auto pieces = [&](double length_m) {
    return std::max(1, static_cast<int>(std::ceil(length_m / piece_m - 1e-9)));
  };
  const int nx = pieces(r.x1 - r.x0), ny = pieces(r.y1 - r.y0);
  const auto at = [&](int i, int j) {
    return Vec3(i == nx ? r.x1 : r.x0 + (r.x1 - r.x0) * i / nx,
                j == ny ? r.y1 : r.y0 + (r.y1 - r.y0) * j / ny, height_m);
  };
  for (int j = 0; j < ny; ++j)
    for (int i = 0; i < nx; ++i)
      builder.face(finish.material, {at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)}, Vec3::UnitZ(),
                   1 / finish.width_m);
}

void raise_bed(MeshBuilder& builder, const Finish& kerb, const Finish& bed, const Rect& r, double base_m,
               double height_m) {
  const double top_m = base_m + height_m, uv = 1 / kerb.width_m;
  const Rect in = shrunk(r, kKerbWidth_m);
  const Vec3 outer[] = {{r.x0, r.y0, 0}, {r.x1, r.y0, 0}, {r.x1, r.y1, 0}, {r.x0, r.y1, 0}};
  const Vec3 inner[] = {{in.x0, in.y0, 0}, {in.x1, in.y0, 0}, {in.x1, in.y1, 0}, {in.x0, in.y1, 0}};
  const Vec3 out[] = {-Vec3::UnitY(), Vec3::UnitX(), Vec3::UnitY(), -Vec3::UnitX()};
  const Vec3 low(0, 0, base_m - 0.05), high(0, 0, top_m);
  for (size_t k = 0; k < 4; ++k) {
    const Vec3 &a = outer[k], &b = outer[(k + 1) % 4], &c = inner[k], &d = inner[(k + 1) % 4];
    builder.face(kerb.material, {a + low, b + low, b + high, a + high}, out[k], uv);
    builder.face(kerb.material, {a + high, b + high, d + high, c + high}, Vec3::UnitZ(), uv);
  }
  pave(builder, bed, in, top_m);
}

}  // namespace vsslam

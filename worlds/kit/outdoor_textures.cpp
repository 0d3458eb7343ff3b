#include "worlds/kit/outdoor_textures.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "worlds/kit/canvas_marks.h"

namespace vsslam {

namespace {

float as_float(double value) {
  return static_cast<float>(value);
}

}  // namespace

Texture asphalt_texture(uint64_t seed, const std::string& name, int size_px, double size_m) {
  Canvas canvas(size_px, size_px, size_px / size_m, seed, name);
  Draws draw(canvas);
  const Vec3f color(0.34f, 0.34f, 0.35f);
  canvas.fill(color);
  for (int i = 0; i < 3; ++i) {  // repaired patches
    const double x = draw(0, size_m), y = draw(0, size_m), w = draw(0.5, 1.6), h = draw(0.4, 1.0);
    canvas.rectangle(x, y, x + w, y + h, color * as_float(draw(0.7, 0.85)));
    canvas.frame(x, y, x + w, y + h, 0.03, Vec3f::Constant(0.16f), 0.8f);
  }
  canvas.mottle(1.5, 5, 0.16f);
  canvas.speckle(0.12, {0.58f, 0.57f, 0.54f}, 0.5f);
  canvas.speckle(0.14, {0.14f, 0.14f, 0.15f}, 0.6f);
  spots(canvas, draw, 200, 0.008, 0.02, 0.6f);
  spots(canvas, draw, 8, 0.06, 0.25, 0.35f);
  cracks(canvas, draw, 5, 14, 0.14, 0.75f);
  return canvas.finish();
}

Texture lawn_texture(uint64_t seed, const std::string& name, int size_px, double size_m) {
  Canvas canvas(size_px, size_px, size_px / size_m, seed, name);
  Draws draw(canvas);
  canvas.fill({0.33f, 0.43f, 0.21f});
  canvas.mottle(1.2, 5, 0.28f);
  for (int i = 0; i < 1500; ++i) {
    const double x = draw(0, size_m), y = draw(0, size_m), a = draw(0, 2 * std::numbers::pi);
    const double length = draw(0.03, 0.09), thickness = draw(0.004, 0.012);
    const Vec3f color = Vec3f(0.42f, 0.56f, 0.24f) * as_float(draw(0.35, 1.35));
    canvas.stroke(x, y, x + length * std::cos(a), y + length * std::sin(a), thickness, color, 0.8f);
  }
  for (int i = 0; i < 60; ++i) {
    const double x = draw(0, size_m), y = draw(0, size_m);
    const Vec3f color = draw(0, 1) < 0.4 ? Vec3f(0.85f, 0.85f, 0.75f) : Vec3f(0.5f, 0.42f, 0.28f);
    canvas.disc(x, y, draw(0.01, 0.03), color, 0.8f);
  }
  return canvas.finish();
}

Texture brick_texture(uint64_t seed, const std::string& name, const Vec3f& color, int size_px,
                      double size_m) {
  Canvas canvas(size_px, size_px, size_px / size_m, seed, name);
  Draws draw(canvas);
  const int rows = static_cast<int>(std::lround(size_m / 0.08)),
            columns = static_cast<int>(std::lround(size_m / 0.25));
  const double row_m = size_m / rows, column_m = size_m / columns;
  canvas.fill({0.66f, 0.64f, 0.6f});
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i) {
      const double x = (i + (j % 2 ? 0.5 : 0.0)) * column_m, y = j * row_m;
      canvas.rectangle(x, y, x + column_m - 0.012, y + row_m - 0.012, color * as_float(draw(0.65, 1.25)));
    }
  canvas.mottle(0.8, 4, 0.1f);
  canvas.speckle(0.06, color * 0.5f, 0.5f);
  spots(canvas, draw, 20, 0.03, 0.2, 0.2f);
  return canvas.finish();
}

Texture plaster_texture(uint64_t seed, const std::string& name, const Vec3f& color, int size_px,
                        double size_m) {
  Canvas canvas(size_px, size_px, size_px / size_m, seed, name);
  Draws draw(canvas);
  canvas.fill(color);
  canvas.mottle(1.5, 5, 0.09f);
  canvas.grain(0.12, 2.0, 3, 0.07f);
  canvas.mottle(0.03, 2, 0.07f);
  for (int i = 0; i < 25; ++i) {  // rain
    const double x = draw(0, size_m), y = draw(0, size_m), length = draw(0.3, 1.6), wide = draw(0.01, 0.05);
    canvas.stroke(x, y, x + draw(-0.05, 0.05), y + length, wide, color * 0.55f, as_float(draw(0.1, 0.4)));
  }
  spots(canvas, draw, 25, 0.04, 0.25, 0.16f);
  spots(canvas, draw, 120, 0.008, 0.03, 0.6f);
  cracks(canvas, draw, 5, 10, 0.12, 0.5f);
  return canvas.finish();
}

Texture concrete_texture(uint64_t seed, const std::string& name, int size_px, double size_m) {
  Canvas canvas(size_px, size_px, size_px / size_m, seed, name);
  Draws draw(canvas);
  const Vec3f color(0.62f, 0.61f, 0.59f);
  canvas.fill(color);
  const int panels = 2;
  const double panel_m = size_m / panels;
  for (int i = 0; i < panels; ++i)
    for (int j = 0; j < 2 * panels; ++j)
      canvas.rectangle(i * panel_m, 0.5 * j * panel_m, (i + 1) * panel_m, 0.5 * (j + 1) * panel_m,
                       color * as_float(draw(0.85, 1.12)));
  canvas.mottle(0.9, 5, 0.12f);
  canvas.grain(0.1, 1.2, 3, 0.06f);
  canvas.speckle(0.05, color * 0.6f, 0.5f);
  for (int i = 0; i < panels; ++i) {
    canvas.rectangle(i * panel_m, 0, i * panel_m + 0.02, size_m, color * 0.45f);
    for (int j = 0; j < 2 * panels; ++j) {
      const double y = 0.5 * j * panel_m;
      canvas.rectangle(i * panel_m, y, (i + 1) * panel_m, y + 0.02, color * 0.45f);
      for (const double x : {0.2, panel_m - 0.2})
        canvas.disc(i * panel_m + x, y + 0.25 * panel_m, 0.025, color * 0.3f);
    }
  }
  spots(canvas, draw, 40, 0.01, 0.06, 0.5f);
  cracks(canvas, draw, 3, 8, 0.1, 0.5f);
  return canvas.finish();
}

Texture window_texture(uint64_t seed, const std::string& name) {
  constexpr double kWidth_m = 1.2, kHeight_m = 1.5, kFrame_m = 0.07;
  Canvas canvas(240, 300, 200, seed, name);
  Draws draw(canvas);
  canvas.fill(Vec3f(0.22f, 0.26f, 0.3f) * as_float(draw(0.7, 1.2)));
  for (int i = 0; i < 6; ++i) {  // what the panes mirror
    const double x = draw(0, kWidth_m), y = draw(0, kHeight_m), w = draw(0.1, 0.6), h = draw(0.1, 0.7);
    canvas.rectangle(x, y, x + w, y + h, Vec3f::Constant(as_float(draw(0.12, 0.5))), 0.4f);
  }
  const Vec3f cloth = draw.color(0.45, 0.8);
  if (draw(0, 1) < 0.5) {
    const double side_m = draw(0.12, 0.3);
    for (double x = kFrame_m; x < side_m; x += 0.05) {
      const Vec3f fold = cloth * as_float(draw(0.6, 1.0));
      canvas.rectangle(x, 0, x + 0.05, kHeight_m, fold);
      canvas.rectangle(kWidth_m - x - 0.05, 0, kWidth_m - x, kHeight_m, fold);
    }
  } else {
    const double drawn_m = draw(0.2, 1.1);
    for (double y = kFrame_m; y < drawn_m; y += 0.045)
      canvas.rectangle(0, y, kWidth_m, y + 0.03, cloth * as_float(draw(0.85, 1.0)));
  }
  canvas.mottle(0.4, 3, 0.1f);
  const Vec3f frame = draw(0, 1) < 0.5 ? Vec3f(0.86f, 0.86f, 0.84f) : Vec3f(0.3f, 0.24f, 0.2f);
  canvas.frame(0, 0, kWidth_m, kHeight_m, kFrame_m, frame);
  canvas.rectangle(kWidth_m / 2 - 0.035, 0, kWidth_m / 2 + 0.035, kHeight_m, frame);
  const double bar_m = draw(0.4, 0.6);
  canvas.rectangle(0, bar_m, kWidth_m, bar_m + 0.05, frame);
  canvas.frame(kFrame_m, kFrame_m, kWidth_m - kFrame_m, kHeight_m - kFrame_m, 0.012, Vec3f::Constant(0.08f));
  return canvas.finish();
}

Texture leaves_texture(uint64_t seed, const std::string& name, const Vec3f& color) {
  Canvas canvas(256, 256, 256, seed, name);  // 1 m x 1 m
  Draws draw(canvas);
  canvas.fill(color * 0.5f);
  for (int i = 0; i < 260; ++i) {
    const double x = draw(0, 1), y = draw(0, 1), a = draw(0, 2 * std::numbers::pi), length = draw(0.03, 0.08);
    canvas.stroke(x, y, x + length * std::cos(a), y + length * std::sin(a), draw(0.02, 0.045),
                  color * as_float(draw(0.5, 1.5)), 0.9f);
  }
  canvas.mottle(0.3, 4, 0.2f);
  return canvas.finish();
}

}  // namespace vsslam

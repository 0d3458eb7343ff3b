#include "worlds/kit/indoor_textures.h"

#include <cmath>

#include "worlds/kit/canvas.h"
#include "worlds/kit/canvas_marks.h"

namespace vsslam {

namespace {

// Marks of use: more of them low on the wall, where trolleys and shoes reach.
void scuff(Canvas& canvas, Draws& draw, int count) {
  const double h = canvas.height_m();
  for (int i = 0; i < count; ++i) {
    const double x = draw(0, canvas.width_m()), low = draw(0, 1), y = h - 0.12 - 1.6 * low * low;
    const double angle = draw(-0.5, 0.5), length = draw(0.02, 0.3);
    const float tone = static_cast<float>(draw(0.15, 0.55));
    canvas.stroke(x, y, x + length * std::cos(angle), y + length * std::sin(angle), draw(0.003, 0.012),
                  Vec3f::Constant(tone), static_cast<float>(draw(0.15, 0.6)));
  }
}

// Light switches at 1.05 m, sockets at 0.3 m: a pale plate with dark details.
void plates(Canvas& canvas, Draws& draw, int count) {
  for (int i = 0; i < count; ++i) {
    const double x = draw(0.2, canvas.width_m() - 0.2), y = canvas.height_m() - (i % 2 ? 1.09 : 0.34);
    canvas.rectangle(x, y, x + 0.08, y + 0.08, {0.93f, 0.93f, 0.9f});
    canvas.frame(x, y, x + 0.08, y + 0.08, 0.005, {0.4f, 0.4f, 0.4f});
    if (i % 2) {
      canvas.stroke(x + 0.04, y + 0.015, x + 0.04, y + 0.065, 0.006, {0.5f, 0.5f, 0.5f});
    } else {
      for (const double dx : {0.028, 0.052}) canvas.disc(x + dx, y + 0.04, 0.006, {0.1f, 0.1f, 0.1f});
    }
  }
}

}  // namespace

Texture wall_texture(uint64_t seed, const std::string& name, const Vec3f& paint, int width_px, double width_m,
                     double height_m) {
  const double px_per_m = width_px / width_m;
  Canvas canvas(width_px, static_cast<int>(std::lround(height_m * px_per_m)), px_per_m, seed, name);
  Draws draw(canvas);
  const double w = canvas.width_m(), h = canvas.height_m();
  canvas.fill(paint);
  canvas.rectangle(0, h - 1.0, w, h, paint.cwiseProduct(Vec3f(0.78f, 0.8f, 0.84f)));
  canvas.rectangle(0, h - 1.02, w, h - 0.96, paint.cwiseProduct(Vec3f(0.45f, 0.5f, 0.62f)));
  canvas.mottle(0.7, 4, 0.07f);
  canvas.mottle(0.03, 2, 0.06f);
  spots(canvas, draw, 12, 0.04, 0.2, 0.12f);
  spots(canvas, draw, 60, 0.004, 0.012, 0.7f);
  scuff(canvas, draw, 45);
  for (int crack = 0; crack < 3; ++crack) {
    double x = draw(0, w), y = draw(0.2, h - 1.2);
    for (int i = 0; i < 8; ++i) {
      const double dx = draw(-0.05, 0.05), dy = draw(0.01, 0.08);
      canvas.stroke(x, y, x + dx, y + dy, 0.003, Vec3f::Constant(0.3f), 0.5f);
      x += dx, y += dy;
    }
  }
  plates(canvas, draw, 2 + static_cast<int>(draw(0, 3)));
  canvas.rectangle(0, h - 0.1, w, h, {0.27f, 0.25f, 0.24f});
  canvas.rectangle(0, h - 0.1, w, h - 0.092, {0.12f, 0.12f, 0.12f});
  canvas.rectangle(0, h - 2.62, w, h - 2.56, {0.82f, 0.82f, 0.8f});
  canvas.rectangle(0, h - 2.565, w, h - 2.557, {0.45f, 0.45f, 0.44f});
  for (double x = 0.25; x < w; x += 0.5)
    canvas.rectangle(x, h - 2.62, x + 0.008, h - 2.56, {0.5f, 0.5f, 0.5f});
  return canvas.finish();
}

Texture tiles_texture(uint64_t seed, const std::string& name, const Vec3f& color, int size_px,
                      double size_m) {
  Canvas canvas(size_px, size_px, size_px / size_m, seed, name);
  Draws draw(canvas);
  const double tile_m = size_m / 4;
  canvas.fill(color);
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j)
      canvas.rectangle(i * tile_m, j * tile_m, (i + 1) * tile_m, (j + 1) * tile_m,
                       color * static_cast<float>(draw(0.82, 1.18)));
  canvas.mottle(0.5, 4, 0.12f);
  canvas.speckle(0.05, color * 1.6f, 0.55f);
  canvas.speckle(0.05, color * 0.4f, 0.6f);
  spots(canvas, draw, 18, 0.03, 0.16, 0.25f);
  spots(canvas, draw, 90, 0.004, 0.014, 0.75f);
  for (int i = 0; i < 4; ++i) {
    canvas.rectangle(i * tile_m, 0, i * tile_m + 0.008, size_m, color * 0.45f);
    canvas.rectangle(0, i * tile_m, size_m, i * tile_m + 0.008, color * 0.45f);
  }
  for (int i = 0; i < 10; ++i) {
    const double x = draw(0, size_m), y = draw(0, size_m), a = draw(0, 6.28), length = draw(0.05, 0.5);
    canvas.stroke(x, y, x + length * std::cos(a), y + length * std::sin(a), 0.004, color * 0.5f, 0.4f);
  }
  return canvas.finish();
}

Texture parquet_texture(uint64_t seed, const std::string& name, int size_px, double size_m) {
  Canvas canvas(size_px, size_px, size_px / size_m, seed, name);
  Draws draw(canvas);
  const Vec3f oak(0.58f, 0.43f, 0.29f);
  const int rows = 16;
  const double plank_m = size_m / rows;
  canvas.fill(oak);
  for (int row = 0; row < rows; ++row) {
    const double shift = draw(0, size_m);
    for (int k = 0; k < 3; ++k) {
      const double x = shift + k * size_m / 3;
      canvas.rectangle(x, row * plank_m, x + size_m / 3, (row + 1) * plank_m,
                       oak * static_cast<float>(draw(0.75, 1.15)));
      canvas.rectangle(x, row * plank_m, x + 0.006, (row + 1) * plank_m, oak * 0.4f);
    }
    canvas.rectangle(0, row * plank_m, size_m, row * plank_m + 0.005, oak * 0.45f);
  }
  canvas.grain(0.4, 0.02, 3, 0.14f);
  spots(canvas, draw, 40, 0.004, 0.02, 0.5f);
  return canvas.finish();
}

Texture ceiling_texture(uint64_t seed, const std::string& name, int size_px, double size_m) {
  Canvas canvas(size_px, size_px, size_px / size_m, seed, name);
  Draws draw(canvas);
  const double panel_m = size_m / 4;
  canvas.fill({0.86f, 0.86f, 0.84f});
  canvas.mottle(0.6, 3, 0.03f);
  canvas.speckle(0.09, {0.45f, 0.45f, 0.44f}, 0.6f);
  spots(canvas, draw, 5, 0.05, 0.15, 0.2f);
  for (int i = 0; i < 4; ++i) {
    canvas.rectangle(i * panel_m - 0.012, 0, i * panel_m + 0.012, size_m, {0.66f, 0.66f, 0.65f});
    canvas.rectangle(0, i * panel_m - 0.012, size_m, i * panel_m + 0.012, {0.66f, 0.66f, 0.65f});
  }
  canvas.frame(panel_m + 0.15, 2 * panel_m + 0.15, panel_m + 0.45, 2 * panel_m + 0.45, 0.02,
               {0.35f, 0.35f, 0.36f});
  for (double y = 0.2; y < 0.42; y += 0.04)
    canvas.rectangle(panel_m + 0.18, 2 * panel_m + y, panel_m + 0.42, 2 * panel_m + y + 0.014,
                     {0.3f, 0.3f, 0.31f});
  return canvas.finish();
}

Texture door_texture(uint64_t seed, const std::string& name, const Vec3f& color, int number) {
  constexpr double kWidth_m = 1.1, kHeight_m = 2.1;
  Canvas canvas(268, 512, 512 / kHeight_m, seed, name);
  Draws draw(canvas);
  canvas.fill(color);
  canvas.grain(0.03, 0.6, 4, 0.16f);
  for (const double y : {0.25, 1.15}) canvas.frame(0.22, y, 0.88, y + 0.75, 0.012, color * 0.6f, 0.8f);
  scuff(canvas, draw, 12);
  canvas.rectangle(0.06, kHeight_m - 0.22, kWidth_m - 0.06, kHeight_m - 0.03, {0.5f, 0.5f, 0.51f});
  canvas.frame(0, 0, kWidth_m, kHeight_m + 0.08, 0.06, {0.42f, 0.43f, 0.45f});
  canvas.frame(0.06, 0.06, kWidth_m - 0.06, kHeight_m + 0.08, 0.008, {0.08f, 0.08f, 0.08f});
  canvas.rectangle(0.9, 1.0, 0.94, 1.2, {0.62f, 0.62f, 0.6f});
  canvas.stroke(0.92, 1.05, 0.8, 1.05, 0.022, {0.78f, 0.78f, 0.76f});
  canvas.disc(0.92, 1.15, 0.01, {0.05f, 0.05f, 0.05f});
  canvas.rectangle(0.42, 0.1, 0.68, 0.19, {0.93f, 0.93f, 0.9f});
  canvas.text(std::to_string(number), 0.47, 0.113, 0.063, {0.08f, 0.1f, 0.3f});
  return canvas.finish();
}

Texture poster_texture(uint64_t seed, const std::string& name) {
  constexpr double kWidth_m = 0.6, kHeight_m = 0.8;
  Canvas canvas(288, 384, 480, seed, name);
  Draws draw(canvas);
  const Vec3f paper = draw.color(0.75, 0.97), ink = draw.color(0.0, 0.35), accent = draw.color(0.1, 0.9);
  canvas.fill(paper);
  canvas.rectangle(0.03, 0.03, kWidth_m - 0.03, 0.14, accent);
  for (double x = 0.05; x < 0.5;) {  // words of a headline
    const double word_m = draw(0.04, 0.12);
    canvas.rectangle(x, 0.06, x + word_m, 0.11, paper);
    x += word_m + 0.02;
  }
  canvas.rectangle(0.05, 0.18, kWidth_m - 0.05, 0.5, draw.color(0.3, 0.8));
  for (int i = 0; i < 9; ++i) {
    const double x = draw(0.1, 0.5), y = draw(0.22, 0.46), size = draw(0.015, 0.04);
    const Vec3f color = draw.color(0.0, 1.0);
    if (draw(0, 1) < 0.5)
      canvas.disc(x, y, size, color);
    else
      canvas.rectangle(x - size, y - size, x + size, y + size, color);
  }
  for (double y = 0.54; y < 0.74; y += 0.028)  // lines of words
    for (double x = 0.05; x < 0.5;) {
      const double word_m = draw(0.015, 0.07);
      canvas.rectangle(x, y, std::min(x + word_m, 0.55), y + 0.012, ink, 0.85f);
      x += word_m + 0.012;
    }
  canvas.frame(0, 0, kWidth_m, kHeight_m, 0.012, ink);
  canvas.mottle(0.3, 3, 0.04f);
  return canvas.finish();
}

Texture extinguisher_texture(uint64_t seed, const std::string& name) {
  Canvas canvas(128, 192, 640, seed, name);  // 0.2 m x 0.3 m
  canvas.fill({0.78f, 0.06f, 0.05f});
  canvas.frame(0.008, 0.008, 0.192, 0.292, 0.006, {0.95f, 0.95f, 0.95f});
  canvas.rectangle(0.06, 0.08, 0.11, 0.2, {0.95f, 0.95f, 0.95f});
  canvas.disc(0.085, 0.08, 0.025, {0.95f, 0.95f, 0.95f});
  canvas.stroke(0.085, 0.05, 0.14, 0.06, 0.01, {0.95f, 0.95f, 0.95f});
  canvas.stroke(0.14, 0.06, 0.15, 0.15, 0.008, {0.95f, 0.95f, 0.95f});
  canvas.text("FIRE", 0.05, 0.23, 0.03, {0.95f, 0.95f, 0.95f});
  return canvas.finish();
}

Texture exit_texture(uint64_t seed, const std::string& name) {
  Canvas canvas(256, 107, 107 / 0.25, seed, name);  // 0.6 m x 0.25 m
  const Vec3f white(0.95f, 0.97f, 0.95f);
  canvas.fill({0.04f, 0.5f, 0.22f});
  canvas.frame(0.01, 0.01, 0.588, 0.24, 0.008, white);
  canvas.text("EXIT", 0.05, 0.07, 0.11, white);
  canvas.stroke(0.45, 0.125, 0.55, 0.125, 0.02, white);
  for (const double dy : {-0.04, 0.04}) canvas.stroke(0.55, 0.125, 0.51, 0.125 + dy, 0.02, white);
  return canvas.finish();
}

Texture stuff_texture(uint64_t seed, const std::string& name, const Vec3f& color, double cell_x_m,
                      double cell_y_m, float contrast) {
  Canvas canvas(256, 256, 256, seed, name);  // 1 m x 1 m
  Draws draw(canvas);
  canvas.fill(color);
  canvas.grain(cell_x_m, cell_y_m, 4, contrast);
  canvas.speckle(0.06, color * 0.5f, 0.5f);
  spots(canvas, draw, 25, 0.004, 0.02, 0.5f);
  return canvas.finish();
}

}  // namespace vsslam

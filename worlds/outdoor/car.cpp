#include <algorithm>
#include <array>
#include <vector>

#include "worlds/outdoor/street_furniture.h"

namespace vsslam {

namespace {

/// A body's outline from the side, counter-clockwise from the lower front: x forward, z up.
struct Outline {
  struct Point {
    double x_m, z_m;
    bool glass = false;  ///< the surface from here to the next point
  };
  std::vector<Point> points;
  std::array<Eigen::Vector2d, 4> side_window;
};

// Seen from the right-hand side (-y), where x runs to the right.
Outline saloon() {
  return {{{-2.18, 0.3},
           {2.15, 0.3},
           {2.25, 0.55},
           {2.15, 0.76},
           {1.05, 0.92, true},
           {0.3, 1.42},
           {-0.95, 1.44, true},
           {-1.65, 1.02},
           {-2.2, 0.96},
           {-2.25, 0.55}},
          {Eigen::Vector2d(-1.35, 0.98), {0.85, 0.95}, {0.25, 1.36}, {-0.9, 1.38}}};
}

Outline van() {
  return {{{-2.2, 0.35},
           {2.2, 0.35},
           {2.25, 0.7},
           {2.05, 1.05, true},
           {1.3, 1.75},
           {0.9, 1.85},
           {-2.1, 1.85},
           {-2.22, 1.2}},
          {Eigen::Vector2d(0.2, 1.1), {1.75, 1.1}, {1.2, 1.7}, {0.2, 1.72}}};
}

constexpr double kBelt_m = 0.95, kLean = 0.35;  // above the belt the sides lean inwards

double half_width_m(double z_m) {
  return kCarWidth_m / 2 - kLean * std::max(0.0, z_m - kBelt_m);
}

void add_body(MeshBuilder& b, const Outline& outline, int paint, int glass) {
  const size_t n = outline.points.size();
  const auto at = [&](size_t i, double side) {
    const Outline::Point& q = outline.points[i % n];
    return Vec3(q.x_m, side * half_width_m(q.z_m), q.z_m);
  };
  const auto flat = [&](int material, std::array<Vec3, 4> c) {
    b.face(material, c, (c[1] - c[0]).cross(c[2] - c[0]).normalized());
  };
  for (size_t i = 0; i < n; ++i) {
    flat(outline.points[i].glass ? glass : paint, {at(i, -1), at(i, 1), at(i + 1, 1), at(i + 1, -1)});
    for (const double side : {-1.0, 1.0}) {
      const Vec3 middle(0, side * half_width_m(0.6), 0.6), first = at(side < 0 ? i : i + 1, side),
                                                           second = at(side < 0 ? i + 1 : i, side);
      const Vec3f normal = (first - middle).cross(second - middle).normalized().cast<float>();
      const auto vertex = [&](const Vec3& v) {
        return Vertex{v.cast<float>(), normal, Eigen::Vector2d(v.x(), -v.z()).cast<float>()};
      };
      b.triangle(paint, vertex(middle), vertex(first), vertex(second));
    }
  }
  for (const double side : {-1.0, 1.0}) {
    std::array<Vec3, 4> pane;
    for (size_t k = 0; k < 4; ++k) {
      const Eigen::Vector2d& q = outline.side_window[side < 0 ? k : 3 - k];
      pane[k] = {q.x(), side * (half_width_m(q.y()) + 0.02), q.y()};
    }
    flat(glass, pane);
  }
}

void add_wheels(MeshBuilder& b, int rubber, int rim) {
  for (const double x : {-1.35, 1.4})
    for (const double side : {-1.0, 1.0}) {
      const double outer_m = side * (kCarWidth_m / 2 + 0.02);
      b.limb(rubber, {x, side * 0.6, 0.32}, {x, outer_m, 0.32}, 0.32, 0.32, 12, true);
      b.limb(rim, {x, outer_m - side * 0.02, 0.32}, {x, outer_m + side * 0.01, 0.32}, 0.19, 0.17, 6, true);
    }
}

}  // namespace

Mesh make_car(const OutdoorPalette& p, int variant) {
  MeshBuilder b;
  const int paint = p.car_paints[static_cast<size_t>(variant) % p.car_paints.size()];
  add_body(b, variant % 4 == 3 ? van() : saloon(), paint, p.car_glass);
  add_wheels(b, p.rubber, p.steel);
  for (const double side : {-1.0, 1.0}) {
    b.box(p.tail_light, {-2.23, side * 0.68, 0.7}, {0.06, 0.3, 0.14});
    b.box(p.steel, {2.2, side * 0.66, 0.58}, {0.08, 0.32, 0.14});
    b.box(p.car_paints.front(), {0.75, side * 0.98, 0.92}, {0.1, 0.16, 0.12});
  }
  for (const double x : {-2.255, 2.255}) b.box(p.number_plate, {x, 0, 0.42}, {0.02, 0.52, 0.11});
  return b.finish("car");
}

}  // namespace vsslam

#include "sensors/surface/texture_filter.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <tuple>

#include "core/ordered_parallel.h"

namespace vsslam {

namespace {

using namespace lanes;

/// A grey image, row-major.
struct Image {
  int width_px = 1, height_px = 1;
  std::vector<float> texels{1.0f};
};

const std::array<float, 256>& linear_of_srgb() {
  static const std::array<float, 256> table = [] {
    std::array<float, 256> t{};
    for (size_t i = 0; i < 256; ++i) {
      const double c = static_cast<double>(i) / 255;
      t[i] = static_cast<float>(c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4));
    }
    return t;
  }();
  return table;
}

Image grey_image(const World& world, const Material& material) {
  const Vec3f weight = material.base_color.cwiseProduct(kGreyWeights);
  if (material.base_color_texture < 0) return {1, 1, {std::clamp(weight.sum(), 0.0f, 1.0f)}};
  const Texture& texture = world.textures[static_cast<size_t>(material.base_color_texture)];
  const std::array<float, 256>& linear = linear_of_srgb();
  Image image{texture.width_px, texture.height_px, {}};
  image.texels.resize(texture.rgba.size() / 4);
  for (size_t i = 0; i < image.texels.size(); ++i) {
    const uint8_t* p = &texture.rgba[4 * i];
    image.texels[i] =
        std::min(1.0f, weight[0] * linear[p[0]] + weight[1] * linear[p[1]] + weight[2] * linear[p[2]]);
  }
  return image;
}

/// Halves the number of lines along one direction; each new line is the mean of the old ones under it, parts
/// of lines included. Lines lie `step` apart, texels within a line `along` apart.
std::vector<float> halved(const std::vector<float>& from, int lines, size_t step, int length, size_t along,
                          bool columns) {
  const int half = std::max(1, lines / 2);
  const double ratio = static_cast<double>(lines) / half;
  std::vector<float> to(static_cast<size_t>(half) * static_cast<size_t>(length));
  for (int i = 0; i < half; ++i) {
    const double low = i * ratio, high = (i + 1) * ratio;
    const int last = std::min(lines - 1, static_cast<int>(std::ceil(high)) - 1);
    for (int k = static_cast<int>(low); k <= last; ++k) {
      const auto share =
          static_cast<float>((std::min<double>(k + 1, high) - std::max<double>(k, low)) / ratio);
      const float* source = &from[static_cast<size_t>(k) * step];
      float* target = &to[static_cast<size_t>(i) * (columns ? 1 : static_cast<size_t>(length))];
      const size_t stride = columns ? static_cast<size_t>(half) : 1;
      for (size_t j = 0; j < static_cast<size_t>(length); ++j)
        target[j * stride] += share * source[j * along];
    }
  }
  return to;
}

Image half_size(const Image& image) {
  const auto width = static_cast<size_t>(image.width_px);
  Image low{image.width_px, std::max(1, image.height_px / 2), {}};
  low.texels = halved(image.texels, image.height_px, width, image.width_px, 1, false);
  if (image.height_px == 1) low.texels = image.texels;
  Image half{std::max(1, low.width_px / 2), low.height_px, {}};
  half.texels =
      low.width_px == 1 ? low.texels : halved(low.texels, low.width_px, 1, low.height_px, width, true);
  return half;
}

}  // namespace

GreyTextures::GreyTextures(const World& world) {
  using Look = std::tuple<int, float, float, float>;  // what two materials must share to share a pyramid
  std::map<Look, size_t> index_of_look;
  std::vector<size_t> look_of_material;
  std::vector<const Material*> looks;
  for (const Material& m : world.materials) {
    const Look look{m.base_color_texture, m.base_color[0], m.base_color[1], m.base_color[2]};
    const auto [it, added] = index_of_look.emplace(look, looks.size());
    if (added) looks.push_back(&m);
    look_of_material.push_back(it->second);
  }
  std::vector<std::vector<Image>> pyramids(looks.size());
  parallel_pieces(looks.size(), 1, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) {
      pyramids[i].push_back(grey_image(world, *looks[i]));
      while (pyramids[i].back().texels.size() > 1) pyramids[i].push_back(half_size(pyramids[i].back()));
    }
  });
  std::vector<Pyramid> of_look;
  size_t size = 0;
  for (const std::vector<Image>& images : pyramids) {
    of_look.push_back({static_cast<int>(levels_.size()), static_cast<int>(images.size()),
                       images.front().width_px, images.front().height_px});
    for (const Image& image : images) {
      levels_.push_back({static_cast<int32_t>(size), image.width_px + 2, static_cast<float>(image.width_px),
                         static_cast<float>(image.height_px)});
      size += static_cast<size_t>(image.width_px + 2) * static_cast<size_t>(image.height_px + 1);
    }
  }
  texels_.resize(size + 2);  // pairs are read: one may reach beyond the last texel
  parallel_pieces(looks.size(), 1, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i)
      for (size_t k = 0; k < pyramids[i].size(); ++k) {
        const Image& image = pyramids[i][k];
        uint32_t* to =
            &texels_[static_cast<size_t>(levels_[static_cast<size_t>(of_look[i].first_level) + k].offset)];
        const int w = image.width_px, h = image.height_px;
        const auto row = [&](int y) {
          return &image.texels[static_cast<size_t>((y + h) % h) * static_cast<size_t>(w)];
        };
        const auto texel = [](float reflectance) {
          return static_cast<uint32_t>(reflectance * 65535.0f + 0.5f);
        };
        for (int y = -1; y < h; ++y) {
          const float *upper = row(y), *lower = row(y + 1);
          const auto column = [&](int x) { return texel(upper[x]) | texel(lower[x]) << 16; };
          *to++ = column(w - 1);
          for (int x = 0; x < w; ++x) *to++ = column(x);
          *to++ = column(0);
        }
      }
  });
  for (const size_t look : look_of_material) pyramids_.push_back(of_look[look]);
}

struct GreyTextures::LevelLanes {
  Ints offset, stride;
  Floats width_px, height_px;
};

GreyTextures::LevelLanes GreyTextures::at(Ints level) const {
  static_assert(sizeof(Level) == 16);
  if (none(level != level[0])) {  // as mostly
    const Level& one = levels_[static_cast<size_t>(level[0])];
    return {Ints{} + one.offset, Ints{} + one.stride, all(one.width_px), all(one.height_px)};
  }
  const auto* table = reinterpret_cast<const float*>(levels_.data());
  const Ints entry = 4 * level;
  return {(Ints)gather(table, entry), (Ints)gather(table, entry + 1), gather(table, entry + 2),
          gather(table, entry + 3)};
}

inline Floats GreyTextures::bilinear(const LevelLanes& level, Floats u, Floats v) const {
  // Texel centres lie at half numbers; the border moves them by one.
  const Floats x = (u - floor(u)) * level.width_px + 0.5f, y = (v - floor(v)) * level.height_px + 0.5f;
  const Ints ix = truncated(x), iy = truncated(y);
  const Floats fx = x - floats(ix), fy = y - floats(iy);
  const Ints index = level.offset + iy * level.stride + ix;
  const auto [left, right] = gather_pairs(texels_.data(), index);
  const auto mix = [&fy](Words column) {
    const Floats upper = floats((Ints)(column & 0xFFFFu)), lower = floats((Ints)(column >> 16));
    return upper + fy * (lower - upper);
  };
  const Floats at_left = mix(left);
  return at_left + fx * (mix(right) - at_left);
}

Floats GreyTextures::along(const LevelLanes& level, Floats u, Floats v, Floats length_u, Floats length_v,
                           Floats probes) const {
  const Floats share = 1.0f / probes;
  const Floats step_u = length_u * share, step_v = length_v * share;
  Floats at_u = u + 0.5f * (step_u - length_u), at_v = v + 0.5f * (step_v - length_v);
  Floats sum = bilinear(level, at_u, at_v);
  for (int k = 1; k < kMaxProbes; ++k) {
    const Ints on = probes > static_cast<float>(k);
    if (none(on)) break;
    at_u += step_u;
    at_v += step_v;
    sum += on ? bilinear(level, at_u, at_v) : all(0);
  }
  return sum * share;
}

Floats GreyTextures::sample(Ints first_level, Ints levels, Floats width_px, Floats height_px, Floats u,
                            Floats v, const Footprint& f) const {
  const Floats across2 = f.across_x * f.across_x + f.across_y * f.across_y,
               down2 = f.down_x * f.down_x + f.down_y * f.down_y;
  const Ints across_longer = across2 > down2;
  const Floats major2 = max(max(across2, down2), all(1e-12f));
  const Floats area = f.across_x * f.down_y - f.across_y * f.down_x;
  // Long / short = long^2 / area. Probes lie a little further apart than the short side: each is a tent.
  const Floats ratio = major2 / max(max(area, -area), all(1e-12f));
  const Floats wanted = min(max(floor(0.7f * ratio + 0.5f), all(1)), all(kMaxProbes));
  const Floats probes = major2 > 1.0f ? wanted : all(1);
  const Floats length_u = (across_longer ? f.across_x : f.down_x) / width_px,
               length_v = (across_longer ? f.across_y : f.down_y) / height_px;
  const Floats top = floats(levels - 1);
  const Floats lod = min(max(0.5f * rough_log2(major2 / (probes * probes)), all(0)), top);
  const Ints fine = truncated(lod);
  // Half of the way needs one level only: blending over the rest is as smooth to the eye.
  const Floats blend = min(max(2.0f * (lod - floats(fine)) - 0.5f, all(0)), all(1));
  const auto finer = [&] { return along(at(first_level + fine), u, v, length_u, length_v, probes); };
  if (none(blend > 0)) return finer() * (1 / 65535.0f);
  // Texels of the next level are twice as large: half the probes do.
  const Ints next = first_level + truncated(min(floats(fine) + 1.0f, top));
  const Floats coarser = along(at(next), u, v, length_u, length_v, floor(0.5f * (probes + 1.0f)));
  if (none(blend < 1)) return coarser * (1 / 65535.0f);
  const Floats near = finer();
  return (near + blend * (coarser - near)) * (1 / 65535.0f);
}

float GreyTextures::sample(const Pyramid& pyramid, const Vec2f& uv, float footprint_px) const {
  const Floats side = all(footprint_px);
  const Floats reflectance = sample(
      Ints{} + pyramid.first_level, Ints{} + pyramid.levels, all(static_cast<float>(pyramid.width_px)),
      all(static_cast<float>(pyramid.height_px)), all(uv.x()), all(uv.y()), {side, all(0), all(0), side});
  return reflectance[0];
}

}  // namespace vsslam

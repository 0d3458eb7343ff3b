#include "slam/vision/corners.h"

#include <immintrin.h>

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>

namespace vsslam {

void CornerConfig::fields(Fields& f) {
  f("min_distance_px", min_distance_px, between(4, 200));
  f("quality", quality, between(0, 1));
  f("min_gradient_grey", min_gradient_grey, positive());
  f("noise_factor", noise_factor, non_negative());
  f("cell_px", cell_px, at_least(16));
  f("border_px", border_px, between(8, 100));
}

double noise_sigma_grey(const GreyView& image) {
  constexpr int kStep = 4, kLargest = 16 * 255;
  constexpr double kMedianOfNormal = 0.6745, kGain = 6;  // of the mask: sqrt of the sum of its squares
  std::vector<uint32_t> histogram(kLargest + 1);
  uint32_t count = 0;
  for (int y = 1; y + 1 < image.height_px; y += kStep) {
    const uint8_t *a = image.row(y - 1), *b = image.row(y), *c = image.row(y + 1);
    for (int x = 1; x + 1 < image.width_px; x += kStep, ++count)
      ++histogram[static_cast<size_t>(std::abs(a[x - 1] - 2 * a[x] + a[x + 1] -
                                               2 * (b[x - 1] - 2 * b[x] + b[x + 1]) + c[x - 1] - 2 * c[x] +
                                               c[x + 1]))];
  }
  uint32_t below = 0;
  for (size_t value = 0; value < histogram.size(); ++value) {
    below += histogram[value];
    if (2 * below >= count) return static_cast<double>(value) / (kMedianOfNormal * kGain);
  }
  return 0;
}

namespace {

constexpr int kTile = 32;  // responses are computed for kTile x kTile pixels at once
constexpr int kHalf = 2;   // half block
constexpr int kBlock = 2 * kHalf + 1;
constexpr int kHalo = kHalf + 1;  // a response needs so many pixels on each side
constexpr int kGradients = kTile + 2 * kHalf;
constexpr int kWidth = 48;  // kGradients and the Sobel mask rounded up, so that all loops have whole vectors
constexpr float kScale = 1.0f / (64 * kBlock * kBlock);  // Sobel's weights add up to 8

float smaller_eigenvalue(float xx, float xy, float yy) {
  return 0.5f * (xx + yy - std::sqrt((xx - yy) * (xx - yy) + 4 * xy * xy));
}

// std::sqrt may set errno, which keeps a loop from becoming vector code. Rounded correctly, as it is.
void square_roots(float (&values)[kTile]) {
  for (int x = 0; x < kTile; x += 8) _mm256_store_ps(values + x, _mm256_sqrt_ps(_mm256_load_ps(values + x)));
}

// Responses of one tile. Fixed sizes and plain arrays: the compiler makes vector code of every loop.
class Tile {
 public:
  /// (x0, y0): first pixel of the tile; it needs kHalo pixels of image on each side, and kWidth bytes to be read
  /// from there on, which may run into the next row.
  void compute(const GreyView& image, int x0, int y0) {
    for (int y = 0; y < kTile + 2 * kHalo; ++y) {
      const uint8_t* row = image.row(y0 - kHalo + y) + x0 - kHalo;
      for (int x = 0; x < kWidth; ++x) grey_[y][x] = row[x];
    }
    multiply_gradients();
    for (int y = 0; y < kTile; ++y) respond(y);
  }

  /// The strongest pixel of the kStep x kStep pixels from (x0, y0) on.
  static constexpr int kStep = 8;
  struct Best {
    float response;
    int x, y;
  };
  void best_of_blocks(int y0, Best (&best)[kTile / kStep]) const {
    float column_best[kTile];
    std::copy_n(response_[y0], kTile, column_best);
    for (int y = y0 + 1; y < y0 + kStep; ++y)
      for (int x = 0; x < kTile; ++x)
        column_best[x] = response_[y][x] > column_best[x] ? response_[y][x] : column_best[x];
    for (int block = 0; block < kTile / kStep; ++block) {
      const float* columns = column_best + block * kStep;
      const int x = block * kStep + static_cast<int>(std::max_element(columns, columns + kStep) - columns);
      int y = y0;
      while (response_[y][x] != column_best[x]) ++y;
      best[block] = {column_best[x], x, y};
    }
  }

 private:
  void multiply_gradients() {
    for (int y = 0; y < kGradients; ++y) {
      const int16_t *a = grey_[y], *b = grey_[y + 1], *c = grey_[y + 2];
      for (int x = 0; x < kWidth; ++x) {
        const int dx = a[x + 2] - a[x] + 2 * (b[x + 2] - b[x]) + c[x + 2] - c[x];
        const int dy = c[x] - a[x] + 2 * (c[x + 1] - a[x + 1]) + c[x + 2] - a[x + 2];
        xx_[y][x] = dx * dx;
        xy_[y][x] = dx * dy;
        yy_[y][x] = dy * dy;
      }
    }
  }
  // Sums over the blocks of row y.
  static void sum_blocks(const int (&products)[kGradients][kWidth], int y, float (&sums)[kTile]) {
    int rows[kWidth];
    for (int x = 0; x < kWidth; ++x)
      rows[x] =
          products[y][x] + products[y + 1][x] + products[y + 2][x] + products[y + 3][x] + products[y + 4][x];
    for (int x = 0; x < kTile; ++x)
      sums[x] = kScale * static_cast<float>(rows[x] + rows[x + 1] + rows[x + 2] + rows[x + 3] + rows[x + 4]);
  }
  void respond(int y) {
    float xx[kTile], xy[kTile], yy[kTile];
    sum_blocks(xx_, y, xx);
    sum_blocks(xy_, y, xy);
    sum_blocks(yy_, y, yy);
    alignas(32) float root[kTile];
    for (int x = 0; x < kTile; ++x) root[x] = (xx[x] - yy[x]) * (xx[x] - yy[x]) + 4 * xy[x] * xy[x];
    square_roots(root);
    for (int x = 0; x < kTile; ++x) response_[y][x] = 0.5f * (xx[x] + yy[x] - root[x]);
  }

  int16_t grey_[kTile + 2 * kHalo][kWidth + 2] = {};
  int xx_[kGradients][kWidth], xy_[kGradients][kWidth], yy_[kGradients][kWidth];
  float response_[kTile][kTile];
};

// Features by place, to ask whether one is near.
class Neighbourhood {
 public:
  Neighbourhood(const GreyView& image, double distance_px)
      : distance_(static_cast<float>(distance_px)),
        columns_(static_cast<int>(static_cast<float>(image.width_px) / distance_) + 1),
        rows_(static_cast<int>(static_cast<float>(image.height_px) / distance_) + 1),
        cells_(static_cast<size_t>(columns_ * rows_)) {}

  void add(const Eigen::Vector2f& p) {
    cells_[static_cast<size_t>(cell(p.y(), rows_) * columns_ + cell(p.x(), columns_))].push_back(p);
  }
  bool near(const Eigen::Vector2f& p) const {
    const int column = cell(p.x(), columns_), row = cell(p.y(), rows_);
    for (int y = std::max(row - 1, 0); y <= std::min(row + 1, rows_ - 1); ++y)
      for (int x = std::max(column - 1, 0); x <= std::min(column + 1, columns_ - 1); ++x)
        for (const Eigen::Vector2f& q : cells_[static_cast<size_t>(y * columns_ + x)])
          if ((p - q).squaredNorm() < distance_ * distance_) return true;
    return false;
  }

 private:
  int cell(float v, int count) const { return std::clamp(static_cast<int>(v / distance_), 0, count - 1); }
  float distance_;
  int columns_, rows_;
  std::vector<std::vector<Eigen::Vector2f>> cells_;
};

struct Candidate {
  float response;
  int x, y;
  bool operator<(const Candidate& o) const {  // the stronger first; then in order of reading
    if (response != o.response) return response > o.response;
    return y != o.y ? y < o.y : x < o.x;
  }
};

// The strongest pixel of each 8 x 8 block that has room for a feature.
class CandidateSearch {
 public:
  CandidateSearch(const GreyView& image, const Neighbourhood& features, int border_px)
      : image_(image), features_(features) {
    const int right = image.width_px - border_px - kTile, bottom = image.height_px - border_px - kTile;
    for (int y = border_px; y < bottom + kTile; y += kTile)
      for (int x = border_px; x < right + kTile; x += kTile)
        search_tile(std::min(x, right), std::min(y, bottom));
  }
  std::vector<Candidate> found;

 private:
  void search_tile(int x0, int y0) {
    constexpr int kStep = Tile::kStep;
    bool computed = false;
    for (int y = 0; y < kTile; y += kStep) {
      std::array<bool, kTile / kStep> room;
      for (size_t block = 0; block < room.size(); ++block) {
        const Eigen::Vector2f corner(static_cast<float>(x0 + kStep * static_cast<int>(block)),
                                     static_cast<float>(y0 + y));
        room[block] = !features_.near(corner + Eigen::Vector2f::Constant(0.5f * kStep));
      }
      if (std::find(room.begin(), room.end(), true) == room.end()) continue;
      if (!computed) tile_.compute(image_, x0, y0);
      computed = true;
      Tile::Best best[kTile / kStep];
      tile_.best_of_blocks(y, best);
      for (size_t block = 0; block < room.size(); ++block)
        if (room[block] && best[block].response > 0)
          found.push_back({best[block].response, x0 + best[block].x, y0 + best[block].y});
    }
  }

  const GreyView& image_;
  const Neighbourhood& features_;
  Tile tile_;
};

// A pixel beside a stronger one is on the flank of a corner, not on its top.
bool is_top(const GreyView& image, const Candidate& c) {
  for (int y = c.y - 1; y <= c.y + 1; ++y)
    for (int x = c.x - 1; x <= c.x + 1; ++x)
      if (corner_response(image, x, y) > c.response) return false;
  return true;
}

// The cells that corners are spread over: how many features each has, and its candidates, the best first.
struct Cells {
  struct Cell {
    size_t features = 0, next = 0;
    std::vector<Candidate> candidates;
  };
  float size_px;
  int columns, rows;
  std::vector<Cell> cells;

  Cells(const GreyView& image, double cell_px)
      : size_px(static_cast<float>(cell_px)),
        columns(static_cast<int>(static_cast<float>(image.width_px) / size_px) + 1),
        rows(static_cast<int>(static_cast<float>(image.height_px) / size_px) + 1),
        cells(static_cast<size_t>(columns * rows)) {}

  Cell& at(float x, float y) {
    const int column = std::clamp(static_cast<int>(x / size_px), 0, columns - 1);
    const int row = std::clamp(static_cast<int>(y / size_px), 0, rows - 1);
    return cells[static_cast<size_t>(row * columns + column)];
  }
  /// The cell with the fewest features that still has candidates; the first of several; null: none.
  Cell* poorest() {
    Cell* best = nullptr;
    for (Cell& cell : cells)
      if (cell.next < cell.candidates.size() && (!best || cell.features < best->features)) best = &cell;
    return best;
  }
};

float smallest_response(const GreyView& image, const std::vector<Candidate>& candidates,
                        const std::vector<Eigen::Vector2f>& taken, const CornerConfig& config) {
  float strongest = 0;
  for (const Candidate& c : candidates) strongest = std::max(strongest, c.response);
  for (const Eigen::Vector2f& p : taken) {
    const int x = std::clamp(static_cast<int>(std::lround(p.x())), kHalo, image.width_px - kHalo - 1);
    const int y = std::clamp(static_cast<int>(std::lround(p.y())), kHalo, image.height_px - kHalo - 1);
    strongest = std::max(strongest, corner_response(image, x, y));
  }
  const double faintest = std::max(config.min_gradient_grey, config.noise_factor * noise_sigma_grey(image));
  return std::max(static_cast<float>(config.quality) * strongest, static_cast<float>(faintest * faintest));
}

}  // namespace

float corner_response(const GreyView& image, int x, int y) {
  int xx = 0, xy = 0, yy = 0;
  for (int j = y - kHalf; j <= y + kHalf; ++j) {
    const uint8_t *a = image.row(j - 1), *b = image.row(j), *c = image.row(j + 1);
    for (int i = x - kHalf; i <= x + kHalf; ++i) {
      const int dx = a[i + 1] - a[i - 1] + 2 * (b[i + 1] - b[i - 1]) + c[i + 1] - c[i - 1];
      const int dy = c[i - 1] - a[i - 1] + 2 * (c[i] - a[i]) + c[i + 1] - a[i + 1];
      xx += dx * dx;
      xy += dx * dy;
      yy += dy * dy;
    }
  }
  return smaller_eigenvalue(kScale * static_cast<float>(xx), kScale * static_cast<float>(xy),
                            kScale * static_cast<float>(yy));
}

WindowShape window_shape(const GreyView& image, int x, int y, int window_px) {
  const int reach = std::min({window_px / 2, x - 1, y - 1, image.width_px - 2 - x, image.height_px - 2 - y});
  Eigen::Matrix2d sum = Eigen::Matrix2d::Zero(), sum_x = sum, sum_y = sum;
  for (int v = -reach; v <= reach; ++v) {
    const uint8_t *a = image.row(y + v - 1) + x, *b = image.row(y + v) + x, *c = image.row(y + v + 1) + x;
    for (int u = -reach; u <= reach; ++u) {  // Scharr's gradient, which Lucas-Kanade uses
      const double dx = 3 * (a[u + 1] - a[u - 1] + c[u + 1] - c[u - 1]) + 10 * (b[u + 1] - b[u - 1]);
      const double dy = 3 * (c[u - 1] - a[u - 1] + c[u + 1] - a[u + 1]) + 10 * (c[u] - a[u]);
      const Eigen::Matrix2d tensor{{dx * dx, dx * dy}, {dx * dy, dy * dy}};
      sum += tensor;
      sum_x += u * tensor;
      sum_y += v * tensor;
    }
  }
  if (sum.determinant() <= 1e-6 * sum.trace() * sum.trace()) return {};
  const Eigen::Matrix2d inverse = sum.inverse();
  WindowShape shape{(inverse * sum_x).cast<float>(), (inverse * sum_y).cast<float>()};
  return shape.centre_px().cwiseAbs().maxCoeff() > static_cast<float>(reach) ? WindowShape{} : shape;
}

std::vector<Eigen::Vector2f> find_corners(const GreyView& image, const std::vector<Eigen::Vector2f>& taken,
                                          size_t wanted, const CornerConfig& config) {
  std::vector<Eigen::Vector2f> corners;
  const int least_px = 2 * config.border_px + kTile;
  if (wanted == 0 || image.width_px < least_px || image.height_px < least_px) return corners;

  Neighbourhood features(image, config.min_distance_px);
  Cells cells(image, config.cell_px);
  for (const Eigen::Vector2f& p : taken) {
    features.add(p);
    ++cells.at(p.x(), p.y()).features;
  }
  const std::vector<Candidate> found = CandidateSearch(image, features, config.border_px).found;
  const float smallest = smallest_response(image, found, taken, config);
  for (const Candidate& c : found)
    if (c.response >= smallest)
      cells.at(static_cast<float>(c.x), static_cast<float>(c.y)).candidates.push_back(c);
  for (Cells::Cell& cell : cells.cells) std::sort(cell.candidates.begin(), cell.candidates.end());

  while (corners.size() < wanted) {
    Cells::Cell* cell = cells.poorest();
    if (!cell) break;
    const Candidate& candidate = cell->candidates[cell->next++];
    if (!is_top(image, candidate)) continue;
    const Eigen::Vector2f corner(static_cast<float>(candidate.x), static_cast<float>(candidate.y));
    if (features.near(corner)) continue;
    features.add(corner);
    corners.push_back(corner);
    ++cell->features;
  }
  return corners;
}

}  // namespace vsslam

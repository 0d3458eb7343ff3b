#include "slam/vision/corners.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "slam/vision/corner_response.h"

namespace vsslam {

void CornerConfig::fields(Fields& f) {
  f("min_distance_px", min_distance_px, between(4, 200));
  f("quality", quality, between(0, 1));
  f("min_gradient_grey", min_gradient_grey, positive());
  f("noise_factor", noise_factor, non_negative());
  f("cell_px", cell_px, at_least(16));
  f("border_px", border_px, between(8, 100));
}

namespace {

constexpr int kSize = ResponseTile::kSize;
constexpr int kReach = 3;  // pixels on each side that a response needs

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
    const int right = image.width_px - border_px - kSize, bottom = image.height_px - border_px - kSize;
    for (int y = border_px; y < bottom + kSize; y += kSize)
      for (int x = border_px; x < right + kSize; x += kSize)
        search_tile(std::min(x, right), std::min(y, bottom));
  }
  std::vector<Candidate> found;

 private:
  void search_tile(int x0, int y0) {
    constexpr int kStep = ResponseTile::kStep;
    bool computed = false;
    for (int y = 0; y < kSize; y += kStep) {
      std::array<bool, kSize / kStep> room;
      for (size_t block = 0; block < room.size(); ++block) {
        const Eigen::Vector2f corner(static_cast<float>(x0 + kStep * static_cast<int>(block)),
                                     static_cast<float>(y0 + y));
        room[block] = !features_.near(corner + Eigen::Vector2f::Constant(0.5f * kStep));
      }
      if (std::find(room.begin(), room.end(), true) == room.end()) continue;
      if (!computed) tile_.compute(image_, x0, y0);
      computed = true;
      const auto best = tile_.best_of_blocks(y);
      for (size_t block = 0; block < room.size(); ++block)
        if (room[block] && best[block].response > 0)
          found.push_back({best[block].response, x0 + best[block].x, y0 + best[block].y});
    }
  }

  const GreyView& image_;
  const Neighbourhood& features_;
  ResponseTile tile_;
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

float smallest_response(const GreyView& image, double noise_grey, const std::vector<Candidate>& candidates,
                        const std::vector<Eigen::Vector2f>& taken, const CornerConfig& config) {
  float strongest = 0;
  for (const Candidate& c : candidates) strongest = std::max(strongest, c.response);
  for (const Eigen::Vector2f& p : taken) {
    const int x = std::clamp(static_cast<int>(std::lround(p.x())), kReach, image.width_px - kReach - 1);
    const int y = std::clamp(static_cast<int>(std::lround(p.y())), kReach, image.height_px - kReach - 1);
    strongest = std::max(strongest, corner_response(image, x, y));
  }
  const double faintest = std::max(config.min_gradient_grey, config.noise_factor * noise_grey);
  return std::max(static_cast<float>(config.quality) * strongest, static_cast<float>(faintest * faintest));
}

}  // namespace

std::vector<Eigen::Vector2f> find_corners(const GreyView& image, double noise_grey,
                                          const std::vector<Eigen::Vector2f>& taken, size_t wanted,
                                          const CornerConfig& config) {
  std::vector<Eigen::Vector2f> corners;
  const int least_px = 2 * config.border_px + kSize;
  if (wanted == 0 || image.width_px < least_px || image.height_px < least_px) return corners;

  Neighbourhood features(image, config.min_distance_px);
  Cells cells(image, config.cell_px);
  for (const Eigen::Vector2f& p : taken) {
    features.add(p);
    ++cells.at(p.x(), p.y()).features;
  }
  const std::vector<Candidate> found = CandidateSearch(image, features, config.border_px).found;
  const float smallest = smallest_response(image, noise_grey, found, taken, config);
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

#include "slam/vision/corner_response.h"

#include <immintrin.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <vector>

namespace vsslam {

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

constexpr int kHalfBlock = 2, kBlock = 2 * kHalfBlock + 1;
constexpr float kScale = 1.0f / (64 * kBlock * kBlock);  // Sobel's weights add up to 8

float smaller_eigenvalue(float xx, float xy, float yy) {
  return 0.5f * (xx + yy - std::sqrt((xx - yy) * (xx - yy) + 4 * xy * xy));
}

// std::sqrt may set errno, which keeps a loop from becoming vector code. Rounded correctly, as it is.
template <int n>
void square_roots(float (&values)[n]) {
  static_assert(n % 8 == 0);
  for (int x = 0; x < n; x += 8) _mm256_store_ps(values + x, _mm256_sqrt_ps(_mm256_load_ps(values + x)));
}

}  // namespace

float corner_response(const GreyView& image, int x, int y) {
  int xx = 0, xy = 0, yy = 0;
  for (int j = y - kHalfBlock; j <= y + kHalfBlock; ++j) {
    const uint8_t *a = image.row(j - 1), *b = image.row(j), *c = image.row(j + 1);
    for (int i = x - kHalfBlock; i <= x + kHalfBlock; ++i) {
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

void ResponseTile::compute(const GreyView& image, int x0, int y0) {
  for (int y = 0; y < kSize + 2 * kHalo; ++y) {
    const uint8_t* row = image.row(y0 - kHalo + y) + x0 - kHalo;
    for (int x = 0; x < kWidth; ++x) grey_[y][x] = row[x];
  }
  multiply_gradients();
  for (int y = 0; y < kSize; ++y) respond(y);
}

std::array<ResponseTile::Best, ResponseTile::kSize / ResponseTile::kStep> ResponseTile::best_of_blocks(
    int y0) const {
  float of_column[kSize];
  std::copy_n(response_[y0], kSize, of_column);
  for (int y = y0 + 1; y < y0 + kStep; ++y)
    for (int x = 0; x < kSize; ++x)
      of_column[x] = response_[y][x] > of_column[x] ? response_[y][x] : of_column[x];
  std::array<Best, kSize / kStep> best;
  for (int first = 0; first < kSize; first += kStep) {
    const int x =
        static_cast<int>(std::max_element(of_column + first, of_column + first + kStep) - of_column);
    int y = y0;
    while (response_[y][x] != of_column[x]) ++y;
    best[static_cast<size_t>(first / kStep)] = {of_column[x], x, y};
  }
  return best;
}

void ResponseTile::multiply_gradients() {
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

void ResponseTile::sum_blocks(const Products& products, int y, float (&sums)[kSize]) {
  int rows[kWidth];
  for (int x = 0; x < kWidth; ++x)
    rows[x] =
        products[y][x] + products[y + 1][x] + products[y + 2][x] + products[y + 3][x] + products[y + 4][x];
  for (int x = 0; x < kSize; ++x)
    sums[x] = kScale * static_cast<float>(rows[x] + rows[x + 1] + rows[x + 2] + rows[x + 3] + rows[x + 4]);
}

void ResponseTile::respond(int y) {
  float xx[kSize], xy[kSize], yy[kSize];
  sum_blocks(xx_, y, xx);
  sum_blocks(xy_, y, xy);
  sum_blocks(yy_, y, yy);
  alignas(32) float root[kSize];
  for (int x = 0; x < kSize; ++x) root[x] = (xx[x] - yy[x]) * (xx[x] - yy[x]) + 4 * xy[x] * xy[x];
  square_roots(root);
  for (int x = 0; x < kSize; ++x) response_[y][x] = 0.5f * (xx[x] + yy[x] - root[x]);
}

}  // namespace vsslam

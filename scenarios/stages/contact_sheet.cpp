#include "scenarios/stages/contact_sheet.h"

#include <algorithm>

#include "scenarios/datasets/formats/png_file.h"

namespace vsslam {

ContactSheet::Picture ContactSheet::halved(const CameraFrame& image) {
  Picture picture{image.width_px / 2, image.height_px / 2, {}};
  const auto width = static_cast<size_t>(image.width_px);
  for (int y = 0; y < picture.height_px; ++y)
    for (int x = 0; x < picture.width_px; ++x) {
      const uint8_t* at = image.grey.data() + 2 * static_cast<size_t>(y) * width + 2 * static_cast<size_t>(x);
      picture.grey.push_back(static_cast<uint8_t>((at[0] + at[1] + at[width] + at[width + 1] + 2) / 4));
    }
  return picture;
}

void ContactSheet::add(const CameraFrame& image) {
  if (seen_++ % stride_ != 0) return;
  kept_.push_back(halved(image));
  if (kept_.size() < kMostKept) return;
  for (size_t i = 1; 2 * i < kept_.size(); ++i) kept_[i] = std::move(kept_[2 * i]);
  kept_.resize(kMostKept / 2);
  stride_ *= 2;
}

std::string ContactSheet::png() const {
  if (kept_.empty()) return {};
  const auto width = static_cast<size_t>(kept_.front().width_px),
             height = static_cast<size_t>(kept_.front().height_px), row = kColumns * width;
  constexpr size_t kPlaces = kColumns * kRows;
  std::vector<uint8_t> sheet(row * height * kRows, 0);
  for (size_t place = 0; place < std::min(kPlaces, kept_.size()); ++place) {
    const size_t chosen = kept_.size() <= kPlaces ? place : place * (kept_.size() - 1) / (kPlaces - 1);
    uint8_t* corner = sheet.data() + place / kColumns * height * row + place % kColumns * width;
    for (size_t y = 0; y < height; ++y)
      std::copy_n(kept_[chosen].grey.begin() + static_cast<std::ptrdiff_t>(y * width), width,
                  corner + y * row);
  }
  return encode_png_grey8(static_cast<int>(row), static_cast<int>(height) * kRows, sheet);
}

}  // namespace vsslam

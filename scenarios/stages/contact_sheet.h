// A few pictures of a run side by side, spread over its time: what the camera saw, for a person.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/samples.h"

namespace vsslam {

class ContactSheet {
 public:
  static constexpr int kColumns = 4, kRows = 2;

  /// Images in order of time, all of one size. Keeps a few, however many come.
  void add(const CameraFrame& image);
  /// 4 x 2 pictures of half the images' size, row by row; without any image empty.
  std::string png() const;

 private:
  static constexpr size_t kMostKept = 4 * kColumns * kRows;
  struct Picture {
    int width_px = 0, height_px = 0;
    std::vector<uint8_t> grey;
  };
  static Picture halved(const CameraFrame& image);

  std::vector<Picture> kept_;  // every `stride_`th of those seen
  size_t stride_ = 1, seen_ = 0;
};

}  // namespace vsslam

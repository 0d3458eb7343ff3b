#include "scenarios/datasets/export/sinks/image_truth_sink.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/files.h"
#include "scenarios/datasets/formats/png_file.h"

namespace vsslam {

ImageTruthSink::ImageTruthSink(const DatasetFacts& facts, Kind kind)
    : kind_(kind), folder_(facts.folder / "truth" / (kind == Kind::depth ? "depth" : "clean_images")) {}

std::filesystem::path ImageTruthSink::file(Time stamp) const {
  return folder_ / fmt::format("{}.png", dataset_time(stamp).ns);
}

bool ImageTruthSink::needs_image(Time stamp) const {
  return !std::filesystem::exists(file(stamp));
}

std::string ImageTruthSink::encode(const CameraMeasurement& camera) const {
  const int width_px = camera.frame.width_px, height_px = camera.frame.height_px;
  if (kind_ == Kind::clean) {
    std::vector<uint8_t> grey;
    for (const float value : camera.clean_grey)
      grey.push_back(static_cast<uint8_t>(std::lround(std::clamp(value, 0.0f, 255.0f))));
    return encode_png_grey8(width_px, height_px, grey);
  }
  std::vector<uint16_t> depth_mm;
  for (const float depth_m : camera.depth_m) {
    const float mm = std::round(1000 * depth_m);
    depth_mm.push_back(mm <= std::numeric_limits<uint16_t>::max() ? static_cast<uint16_t>(mm) : uint16_t{0});
  }
  return encode_png_grey16(width_px, height_px, depth_mm);
}

void ImageTruthSink::write(const DatasetSample& sample) {
  const auto* camera = std::get_if<CameraMeasurement>(&sample.measurement);
  if (camera != nullptr && needs_image(camera->frame.stamp))
    write_file(file(camera->frame.stamp), encode(*camera));
}

}  // namespace vsslam

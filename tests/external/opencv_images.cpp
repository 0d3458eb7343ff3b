// Do the images of a EuRoC folder, read by OpenCV, have the pixels of the messages? And those of the other folders: can
// it read them? opencv_images FILE.mcap DATASET_FOLDER
#include <fmt/format.h>

#include <fstream>
#include <map>
#include <opencv2/imgcodecs.hpp>

#include "core/errors.h"
#include "scenarios/datasets/formats/message_file.h"

namespace {

using namespace vsslam;
namespace fs = std::filesystem;

std::map<int64_t, ImageMessage> images_by_stamp(const fs::path& recording) {
  std::map<int64_t, ImageMessage> images;
  const auto reader = read_messages(recording);
  while (std::optional<Message> message = reader->next())
    if (auto* image = std::get_if<ImageMessage>(&message->content))
      images[image->header.stamp.ns] = std::move(*image);
  return images;
}

cv::Mat grey_image(const fs::path& path) {
  cv::Mat image = cv::imread(path.string(), cv::IMREAD_UNCHANGED);
  if (image.type() != CV_8UC1)
    throw InputError(fmt::format("{}: OpenCV finds no grey image in it", path.string()));
  return image;
}

void expect_pixels(const cv::Mat& image, const ImageMessage& message, const fs::path& path) {
  bool same = message.encoding == "mono8" && image.cols == static_cast<int>(message.width) &&
              image.rows == static_cast<int>(message.height);
  for (int y = 0; same && y < image.rows; ++y)
    same = std::equal(image.ptr(y), image.ptr(y) + image.cols,
                      message.data.data() + size_t{message.step} * static_cast<size_t>(y));
  if (!same) throw InputError(fmt::format("{}: other pixels than its message has", path.string()));
}

int check_euroc(const std::map<int64_t, ImageMessage>& messages, const fs::path& camera) {
  std::ifstream table(camera / "data.csv");
  int count = 0;
  for (std::string line; std::getline(table, line);) {
    if (line.empty() || line[0] == '#') continue;
    const int64_t stamp_ns = std::stoll(line);
    const fs::path path = camera / "data" / fmt::format("{}.png", stamp_ns);
    const auto message = messages.find(stamp_ns);
    if (message == messages.end())
      throw InputError(fmt::format("{}: no message of this stamp", path.string()));
    expect_pixels(grey_image(path), message->second, path);
    ++count;
  }
  return count;
}

int read_all(const fs::path& folder) {
  int count = 0;
  for (const auto& entry : fs::directory_iterator(folder)) {
    grey_image(entry.path());
    ++count;
  }
  return count;
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc != 3) throw InputError("usage: opencv_images FILE.mcap DATASET_FOLDER");
  const fs::path folder = argv[2];
  const int euroc = check_euroc(images_by_stamp(argv[1]), folder / "mav0" / "cam0");
  const int kitti = read_all(folder / "image_0"), tum = read_all(folder / "rgb");
  if (euroc == 0 || kitti == 0 || tum == 0)
    throw InputError(fmt::format("{}: images are missing", folder.string()));
  fmt::print("OpenCV: {} images of EuRoC as in the messages, {} of KITTI and {} of TUM\n", euroc, kitti, tum);
} catch (const std::exception& error) {
  fmt::print(stderr, "{}\n", error.what());
  return 1;
}

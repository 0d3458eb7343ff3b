#include <fmt/format.h>
#include <unistd.h>

#include "core/errors.h"
#include "scenarios/datasets/formats/message_file.h"
#include "scenarios/datasets/formats/rosbag_library.h"
#include "scenarios/datasets/messages/wire_format.h"

namespace vsslam {

namespace {

namespace fs = std::filesystem;

/// The folder of `path` made, and a name beside it.
fs::path part_of(const fs::path& path) {
  std::error_code error;
  if (path.has_parent_path()) fs::create_directories(path.parent_path(), error);
  if (error)
    throw ResourceError(
        fmt::format("{}: cannot make the folder: {}", path.parent_path().string(), error.message()));
  return fmt::format("{}.part{}", path.string(), ::getpid());
}

class BagWriter : public MessageWriter {
 public:
  explicit BagWriter(const fs::path& path)
      : path_(path), part_(part_of(path)), bag_(std::make_unique<RosbagOutput>(part_.string())) {}
  ~BagWriter() override {
    if (!bag_) return;
    bag_.reset();
    std::error_code ignored;
    fs::remove(part_, ignored);
  }

  void write(const Message& message, bool latched) override {
    if (message.recorded.ns <= 0)
      throw InputError(fmt::format("{}: a message recorded at {:.3f} s, not after 0", path_.string(),
                                   message.recorded.seconds()));
    encode_message(message.content, WireFormat::ros1, bytes_);
    bag_->write(message.topic, std::string(message_type(message.content)), message.recorded.ns, bytes_,
                latched);
  }

  void finish() override {
    bag_->close();
    check_index();
    std::error_code error;
    fs::rename(part_, path_, error);
    if (error) throw ResourceError(fmt::format("{}: cannot rename: {}", path_.string(), error.message()));
    bag_.reset();
  }

 private:
  /// Nobody else says that the last bytes did not reach the disk.
  void check_index() const {
    try {
      read_messages(part_);
    } catch (const InputError& error) {
      throw ResourceError(fmt::format("{}: not written to its end: {}", path_.string(), error.what()));
    }
  }

  fs::path path_, part_;
  std::unique_ptr<RosbagOutput> bag_;  // none: finished
  std::string bytes_;
};

}  // namespace

std::unique_ptr<MessageWriter> write_bag(const fs::path& path) {
  return std::make_unique<BagWriter>(path);
}

}  // namespace vsslam

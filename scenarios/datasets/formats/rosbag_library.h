// ROS' own library for bags behind a plain interface: its headers do not compile as C++20, and nothing of ours that does
// may be included beside them.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

namespace vsslam {

/// Writes a ROS 1 bag, format 2.0, with chunks compressed by LZ4. Throws ResourceError.
class RosbagOutput {
 public:
  explicit RosbagOutput(const std::string& path);
  ~RosbagOutput();
  RosbagOutput(const RosbagOutput&) = delete;
  RosbagOutput& operator=(const RosbagOutput&) = delete;

  /// `type` in ROS 1's spelling, one that messages.h has. `recorded_ns` since 1970, above 0.
  void write(const std::string& topic, const std::string& type, int64_t recorded_ns, const std::string& bytes,
             bool latched);
  /// Writes the index. Whether its last bytes reach the disk, the library does not look.
  void close();

 private:
  struct State;
  void give_up();
  std::unique_ptr<State> state_;
};

}  // namespace vsslam

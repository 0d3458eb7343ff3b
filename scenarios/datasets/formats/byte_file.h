// Any part of a file, and never beyond its end.
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>

namespace vsslam {

class ByteFile {
 public:
  /// Throws InputError that names the file.
  explicit ByteFile(const std::filesystem::path& path);

  const std::string& name() const { return name_; }
  uint64_t size() const { return size_; }
  /// Throws InputError (that does not name the file), before any memory is taken, if so many bytes are not there.
  std::string read(uint64_t offset, uint64_t size);
  /// The same, but only what is there.
  std::string read_available(uint64_t offset, uint64_t size);

 private:
  std::string name_;
  std::ifstream stream_;
  uint64_t size_ = 0;
};

}  // namespace vsslam

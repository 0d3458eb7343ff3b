#include "scenarios/datasets/formats/byte_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "core/errors.h"

namespace vsslam {

ByteFile::ByteFile(const std::filesystem::path& path) : name_(path.string()) {
  std::error_code error;
  if (std::filesystem::is_directory(path, error))
    throw InputError(fmt::format("{}: is a folder, not a file", name_));
  stream_.open(path, std::ios::binary | std::ios::ate);
  if (!stream_) throw InputError(fmt::format("{}: cannot read: {}", name_, std::strerror(errno)));
  size_ = static_cast<uint64_t>(stream_.tellg());
}

std::string ByteFile::read(uint64_t offset, uint64_t size) {
  if (offset > size_ || size > size_ - offset)
    throw InputError(fmt::format("byte {}: {} bytes wanted, the file ends at {}", offset, size, size_));
  std::string bytes(size, '\0');
  stream_.seekg(static_cast<std::streamoff>(offset));
  stream_.read(bytes.data(), static_cast<std::streamsize>(size));
  if (!stream_) throw InputError(fmt::format("byte {}: read failed: {}", offset, std::strerror(errno)));
  return bytes;
}

std::string ByteFile::read_available(uint64_t offset, uint64_t size) {
  return read(std::min(offset, size_), std::min(size, size_ - std::min(offset, size_)));
}

}  // namespace vsslam

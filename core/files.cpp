#include "core/files.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "core/errors.h"

namespace vsslam {

namespace fs = std::filesystem;

AtomicFile::AtomicFile(fs::path path) : path_(std::move(path)) {
  std::error_code error;
  if (path_.has_parent_path()) fs::create_directories(path_.parent_path(), error);
  if (error)
    throw ResourceError(
        fmt::format("{}: cannot make the folder: {}", path_.parent_path().string(), error.message()));
  part_ = path_;
  part_ += fmt::format(".part{}", ::getpid());
  stream_.open(part_, std::ios::binary | std::ios::trunc);
  if (!stream_) throw ResourceError(fmt::format("{}: cannot write: {}", path_.string(), std::strerror(errno)));
}

AtomicFile::~AtomicFile() {
  if (done_) return;
  stream_.close();
  std::error_code ignored;
  fs::remove(part_, ignored);
}

void AtomicFile::write(std::string_view bytes) {
  stream_.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  if (!stream_) throw ResourceError(fmt::format("{}: write failed: {}", path_.string(), std::strerror(errno)));
}

void AtomicFile::commit() {
  stream_.close();
  if (!stream_) throw ResourceError(fmt::format("{}: write failed: {}", path_.string(), std::strerror(errno)));
  std::error_code error;
  fs::rename(part_, path_, error);
  if (error) throw ResourceError(fmt::format("{}: cannot rename: {}", path_.string(), error.message()));
  done_ = true;
}

void write_file(const fs::path& path, std::string_view bytes) {
  AtomicFile file(path);
  file.write(bytes);
  file.commit();
}

std::string read_file(const fs::path& path, size_t max_bytes) {
  std::error_code error;
  if (fs::is_directory(path, error)) throw InputError(fmt::format("{}: is a folder, not a file", path.string()));
  std::ifstream stream(path, std::ios::binary);
  if (!stream) throw InputError(fmt::format("{}: cannot read: {}", path.string(), std::strerror(errno)));
  const auto size = fs::file_size(path, error);
  if (!error && size > max_bytes)
    throw InputError(fmt::format("{}: {} bytes, more than the limit of {}", path.string(), size, max_bytes));
  std::string bytes;
  if (!error) bytes.reserve(size);
  char buffer[1 << 16];
  while (stream.read(buffer, sizeof buffer) || stream.gcount() > 0) {
    bytes.append(buffer, static_cast<size_t>(stream.gcount()));
    if (bytes.size() > max_bytes)
      throw InputError(fmt::format("{}: more than the limit of {} bytes", path.string(), max_bytes));
  }
  if (stream.bad()) throw InputError(fmt::format("{}: read failed: {}", path.string(), std::strerror(errno)));
  return bytes;
}

}  // namespace vsslam

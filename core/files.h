// Whole files or none: content is written beside its final name and renamed.
#pragma once

#include <cstddef>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

namespace vsslam {

/// A file that appears under its name only when commit() succeeds; otherwise nothing is left behind.
/// Throws ResourceError (disk full, no permission) from write and commit.
class AtomicFile {
 public:
  explicit AtomicFile(std::filesystem::path path);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  void write(std::string_view bytes);
  void write(const void* bytes, size_t size) { write({static_cast<const char*>(bytes), size}); }
  void commit();

 private:
  std::filesystem::path path_, part_;
  std::ofstream stream_;
  bool done_ = false;
};

/// Writes a whole file at once through AtomicFile.
void write_file(const std::filesystem::path& path, std::string_view bytes);

/// Reads a whole file. Throws InputError if it cannot be read or is larger than `max_bytes`.
std::string read_file(const std::filesystem::path& path, size_t max_bytes = size_t{4} << 30);

}  // namespace vsslam

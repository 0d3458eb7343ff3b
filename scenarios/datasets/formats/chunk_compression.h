// The compressions of chunks in bags and MCAP files.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace vsslam {

struct Decompressed {
  std::string bytes;
  std::string damage;  ///< why there is not more; empty: all is there and in order
};

/// `compression` as the files spell it: "lz4" (frames), "bz2", "zstd", and "none" or "" for none. Never gives more
/// than `size` bytes, and takes memory as the content comes, whatever `size` claims. Of broken content, what could be
/// read before the break.
Decompressed decompress(std::string_view compression, std::string_view content, uint64_t size);

/// The same bytes for the same content and library.
std::string compress_zstd(std::string_view content);

}  // namespace vsslam

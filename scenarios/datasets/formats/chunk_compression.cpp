#include "scenarios/datasets/formats/chunk_compression.h"

#include <bzlib.h>
#include <fmt/format.h>
#include <lz4frame.h>
#include <zstd.h>

#include <algorithm>
#include <memory>

#include "core/errors.h"

namespace vsslam {

namespace {

// For clouds of noisy floats level 3 takes half as long again, and saves a sixth of the bytes.
constexpr int kZstdLevel = 1;
// What grows first, then doubles up to what the chunk claims.
constexpr uint64_t kFirstBytes = 1 << 20;

/// One step of a decompressor: consumes of `in`, fills of the `room` bytes at `out`.
struct Step {
  size_t consumed = 0, produced = 0;
  bool done = false;
  std::string damage{};
};

template <class NextStep>
Decompressed decompress_stream(std::string_view in, uint64_t size, NextStep&& next_step) {
  Decompressed out;
  uint64_t filled = 0;
  for (bool done = false; !done && out.damage.empty();) {
    if (filled == out.bytes.size())
      // One byte more than claimed: content that is too long shows by filling it.
      out.bytes.resize(std::min(size + 1, std::max(kFirstBytes, 2 * filled)));
    const Step step = next_step(in, out.bytes.data() + filled, out.bytes.size() - filled);
    in.remove_prefix(step.consumed);
    filled += step.produced;
    done = step.done;
    if (!step.damage.empty())
      out.damage = step.damage;
    else if (filled > size)
      out.damage = fmt::format("more than the {} bytes announced", size);
    else if (!done && in.empty() && step.produced == 0)
      out.damage = fmt::format("ends after {} of {} bytes", filled, size);
  }
  if (out.damage.empty() && filled < size)
    out.damage = fmt::format("{} bytes where {} were announced", filled, size);
  out.bytes.resize(std::min(filled, size));
  return out;
}

Decompressed decompress_lz4(std::string_view content, uint64_t size) {
  LZ4F_dctx* raw = nullptr;
  if (LZ4F_isError(LZ4F_createDecompressionContext(&raw, LZ4F_VERSION)))
    throw ResourceError("out of memory for LZ4");
  const std::unique_ptr<LZ4F_dctx, decltype(&LZ4F_freeDecompressionContext)> context(
      raw, LZ4F_freeDecompressionContext);
  return decompress_stream(content, size, [&](std::string_view in, char* out, size_t room) {
    size_t consumed = in.size(), produced = room;
    const size_t result = LZ4F_decompress(context.get(), out, &produced, in.data(), &consumed, nullptr);
    if (LZ4F_isError(result)) return Step{0, 0, false, fmt::format("LZ4: {}", LZ4F_getErrorName(result))};
    return Step{consumed, produced, result == 0};
  });
}

Decompressed decompress_zstd(std::string_view content, uint64_t size) {
  const std::unique_ptr<ZSTD_DCtx, decltype(&ZSTD_freeDCtx)> context(ZSTD_createDCtx(), ZSTD_freeDCtx);
  if (!context) throw ResourceError("out of memory for zstd");
  return decompress_stream(content, size, [&](std::string_view in, char* out, size_t room) {
    ZSTD_inBuffer input{in.data(), in.size(), 0};
    ZSTD_outBuffer output{out, room, 0};
    const size_t result = ZSTD_decompressStream(context.get(), &output, &input);
    if (ZSTD_isError(result))
      return Step{0, output.pos, false, fmt::format("zstd: {}", ZSTD_getErrorName(result))};
    return Step{input.pos, output.pos, result == 0};
  });
}

Decompressed decompress_bz2(std::string_view content, uint64_t size) {
  bz_stream stream{};
  if (BZ2_bzDecompressInit(&stream, 0, 0) != BZ_OK) throw ResourceError("out of memory for bzip2");
  const std::unique_ptr<bz_stream, decltype(&BZ2_bzDecompressEnd)> context(&stream, BZ2_bzDecompressEnd);
  return decompress_stream(content, size, [&](std::string_view in, char* out, size_t room) {
    const auto most = [](size_t bytes) { return static_cast<unsigned>(std::min<size_t>(bytes, 1u << 30)); };
    const unsigned given = most(in.size()), space = most(room);
    stream.next_in = const_cast<char*>(in.data());
    stream.avail_in = given;
    stream.next_out = out;
    stream.avail_out = space;
    const int result = BZ2_bzDecompress(&stream);
    const Step step{given - stream.avail_in, space - stream.avail_out, result == BZ_STREAM_END};
    if (result == BZ_OK || step.done) return step;
    return Step{0, step.produced, false, fmt::format("bzip2: error {}", result)};
  });
}

}  // namespace

Decompressed decompress(std::string_view compression, std::string_view content, uint64_t size) {
  if (compression == "lz4") return decompress_lz4(content, size);
  if (compression == "zstd") return decompress_zstd(content, size);
  if (compression == "bz2") return decompress_bz2(content, size);
  if (!compression.empty() && compression != "none")
    return {{}, fmt::format("compression \"{}\" is not known here", compression)};
  Decompressed out{std::string(content.substr(0, std::min<uint64_t>(size, content.size()))), {}};
  if (content.size() != size)
    out.damage = fmt::format("{} bytes where {} were announced", content.size(), size);
  return out;
}

std::string compress_zstd(std::string_view content) {
  std::string bytes(ZSTD_compressBound(content.size()), '\0');
  const size_t size = ZSTD_compress(bytes.data(), bytes.size(), content.data(), content.size(), kZstdLevel);
  if (ZSTD_isError(size)) throw ResourceError(fmt::format("zstd: {}", ZSTD_getErrorName(size)));
  bytes.resize(size);
  return bytes;
}

}  // namespace vsslam

#include "scenarios/datasets/messages/wire_format.h"

#include <fmt/format.h>

#include <limits>

#include "core/errors.h"
#include "scenarios/datasets/messages/message_types.h"
#include "scenarios/datasets/messages/wire_archive.h"

namespace vsslam {

namespace {

constexpr int64_t kNsPerSecond = 1'000'000'000;
// Representation identifier of plain CDR, little-endian, and two bytes of options.
constexpr std::string_view kCdrLittleEndian{"\0\1\0\0", 4};

}  // namespace

WireWriter::WireWriter(WireFormat format, std::string& bytes) : format_(format), bytes_(bytes) {
  bytes_.clear();
  if (format == WireFormat::cdr) bytes_ = kCdrLittleEndian;
}

void WireWriter::put(const std::string& text) {
  const bool cdr = format_ == WireFormat::cdr;
  put(static_cast<uint32_t>(text.size() + cdr));
  bytes_ += text;
  if (cdr) bytes_ += '\0';
}

void WireWriter::put(const Time& stamp) {
  const int64_t latest_s = format_ == WireFormat::ros1 ? int64_t{std::numeric_limits<uint32_t>::max()}
                                                       : int64_t{std::numeric_limits<int32_t>::max()};
  if (stamp.ns < 0 || stamp.ns / kNsPerSecond > latest_s)
    throw InputError(fmt::format("a stamp of {:.3f} s cannot be written to a ROS message", stamp.seconds()));
  (*this)(static_cast<uint32_t>(stamp.ns / kNsPerSecond), static_cast<uint32_t>(stamp.ns % kNsPerSecond));
}

WireReader::WireReader(WireFormat format, std::string_view bytes) : format_(format), cursor_(bytes) {
  if (format != WireFormat::cdr) return;
  const std::string_view header = cursor_.take(kCdrLittleEndian.size());
  if (header[0] == 0 && header[1] == 0) throw InputError("big-endian CDR, which is not read here");
  if (header[0] != 0 || header[1] != 1)
    throw InputError(fmt::format("CDR of kind {:02x} {:02x}, where plain little-endian CDR is 00 01",
                                 static_cast<uint8_t>(header[0]), static_cast<uint8_t>(header[1])));
}

void WireReader::finish() const {
  const size_t padding = format_ == WireFormat::cdr ? 3 : 0;
  if (cursor_.left() > padding) throw InputError(fmt::format("{} bytes too many", cursor_.left()));
}

void WireReader::get(bool& value) {
  uint8_t byte = 0;
  get(byte);
  value = byte != 0;
}

void WireReader::get(std::string& text) {
  uint32_t size = 0;
  get(size);
  text = cursor_.take(size);
  if (format_ == WireFormat::cdr && !text.empty()) text.pop_back();
}

void WireReader::get(Time& stamp) {
  uint32_t s = 0, ns = 0;
  (*this)(s, ns);
  const int64_t seconds = format_ == WireFormat::ros1 ? int64_t{s} : int64_t{static_cast<int32_t>(s)};
  stamp.ns = seconds * kNsPerSecond + ns;
}

void WireReader::get(SE3& T) {
  (*this)(T.translation, T.rotation);
  const double squared_norm = T.rotation.squaredNorm();
  if (squared_norm == 0)
    T.rotation.setIdentity();
  else if (std::abs(squared_norm - 1) > 1e-12)
    T.rotation.normalize();
}

void WireReader::fail_count(uint32_t count) const {
  throw InputError(
      fmt::format("a list of {} at byte {}, where {} bytes are left", count, cursor_.at(), cursor_.left()));
}

void encode_message(const MessageContent& content, WireFormat format, std::string& bytes) {
  WireWriter writer(format, bytes);
  std::visit([&](const auto& message) { members(writer, message); }, content);
}

MessageContent decode_message(std::string_view type, std::string_view bytes, WireFormat format) {
  std::optional<MessageContent> content = empty_message(type);
  if (!content) throw InputError(fmt::format("messages of type {} are not known here", type));
  WireReader reader(format, bytes);
  std::visit([&](auto& message) { members(reader, message); }, *content);
  reader.finish();
  return std::move(*content);
}

MessageContent decode_header(std::string_view type, std::string_view bytes, WireFormat format) {
  std::optional<MessageContent> content = empty_message(type);
  if (!content) throw InputError(fmt::format("messages of type {} are not known here", type));
  WireReader reader(format, bytes);
  std::visit(
      [&](auto& message) {
        if constexpr (requires { message.header; }) members(reader, message.header);
      },
      *content);
  return std::move(*content);
}

}  // namespace vsslam

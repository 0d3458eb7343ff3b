#include <fmt/format.h>
#include <pcap/pcap.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <span>

#include "core/errors.h"
#include "scenarios/datasets/import/packet_recording.h"

namespace vsslam {

namespace fs = std::filesystem;

namespace {

constexpr uint16_t kPort = 2368;

std::array<uint8_t, 4> first_bytes(const fs::path& path) {
  std::array<uint8_t, 4> bytes{};
  std::ifstream(path, std::ios::binary).read(reinterpret_cast<char*>(bytes.data()), bytes.size());
  return bytes;
}

uint16_t big_endian(std::span<const uint8_t> bytes, size_t at) {
  return static_cast<uint16_t>(bytes[at] << 8 | bytes[at + 1]);
}

// What a frame of the link layer carries, if that is IPv4.
std::span<const uint8_t> ip_packet(std::span<const uint8_t> frame, int link) {
  struct Layer {
    int link;
    size_t type_at, bytes;
  };
  constexpr Layer kLayers[] = {{DLT_EN10MB, 12, 14}, {DLT_LINUX_SLL, 14, 16}};
  constexpr uint16_t kIpv4 = 0x0800, kVlan = 0x8100;
  if (link == DLT_RAW || link == 101) return frame;
  if (link == DLT_NULL) return frame.size() > 4 ? frame.subspan(4) : std::span<const uint8_t>{};
  for (const Layer& layer : kLayers) {
    if (layer.link != link || frame.size() < layer.bytes + 4) continue;
    const uint16_t type = big_endian(frame, layer.type_at);
    if (type == kIpv4) return frame.subspan(layer.bytes);
    if (type == kVlan && big_endian(frame, layer.type_at + 4) == kIpv4) return frame.subspan(layer.bytes + 4);
  }
  return {};
}

// The payload of an unfragmented UDP datagram to the port of Velodyne's data; else empty.
std::span<const uint8_t> datagram(std::span<const uint8_t> ip) {
  constexpr uint8_t kUdp = 17;
  constexpr size_t kUdpBytes = 8;
  if (ip.size() < 20 || ip[0] >> 4 != 4 || ip[9] != kUdp) return {};
  const size_t header = size_t{4} * (ip[0] & 0x0F);
  if ((big_endian(ip, 6) & 0x3FFF) != 0 || ip.size() < header + kUdpBytes) return {};
  const auto udp = ip.subspan(header);
  if (big_endian(udp, 2) != kPort) return {};
  const size_t bytes = std::min<size_t>(std::max<size_t>(big_endian(udp, 4), kUdpBytes), udp.size());
  return udp.subspan(kUdpBytes, bytes - kUdpBytes);
}

class PcapFile {
 public:
  PcapFile(const fs::path& path, bool salvage) : path_(path), salvage_(salvage) {
    std::array<char, PCAP_ERRBUF_SIZE> text{};
    pcap_ = pcap_open_offline_with_tstamp_precision(path.c_str(), PCAP_TSTAMP_PRECISION_NANO, text.data());
    if (pcap_ == nullptr) throw InputError(fmt::format("{}: {}", path.string(), text.data()));
  }
  ~PcapFile() { pcap_close(pcap_); }
  PcapFile(const PcapFile&) = delete;
  PcapFile& operator=(const PcapFile&) = delete;

  std::optional<ReceivedPacket> next() {
    pcap_pkthdr* header = nullptr;
    const u_char* bytes = nullptr;
    while (true) {
      const int code = pcap_next_ex(pcap_, &header, &bytes);
      if (code == PCAP_ERROR_BREAK || (code < 0 && salvage_)) return std::nullopt;
      if (code < 0)
        throw InputError(fmt::format("{}: after frame {}: {} (--salvage reads what is before)",
                                     path_.string(), frames_, pcap_geterr(pcap_)));
      ++frames_;
      const auto payload = datagram(ip_packet({bytes, header->caplen}, pcap_datalink(pcap_)));
      if (payload.size() != VelodynePacket::kBytes) continue;
      const Time received{int64_t{header->ts.tv_sec} * 1'000'000'000 + header->ts.tv_usec};
      return ReceivedPacket{decode_packet(payload, fmt::format("{}: frame {}", path_.string(), frames_)),
                            received};
    }
  }

 private:
  fs::path path_;
  bool salvage_;
  pcap_t* pcap_ = nullptr;
  int64_t frames_ = 0;
};

}  // namespace

bool is_packet_file(const fs::path& path) {
  const auto bytes = first_bytes(path);
  return bytes[0] == 0xFF && bytes[1] == 0xEE && fs::file_size(path) >= VelodynePacket::kBytes;
}

// pcap of either byte order, with micro- or nanoseconds, and pcapng.
bool is_pcap_file(const fs::path& path) {
  using Magic = std::array<uint8_t, 4>;
  constexpr Magic kMagic[] = {{0xA1, 0xB2, 0xC3, 0xD4},
                              {0xD4, 0xC3, 0xB2, 0xA1},
                              {0xA1, 0xB2, 0x3C, 0x4D},
                              {0x4D, 0x3C, 0xB2, 0xA1},
                              {0x0A, 0x0D, 0x0D, 0x0A}};
  return std::find(std::begin(kMagic), std::end(kMagic), first_bytes(path)) != std::end(kMagic);
}

PacketReader read_packet_file(const fs::path& path, bool salvage) {
  struct State {
    std::ifstream stream;
    int64_t packets = 0;
  };
  auto state = std::make_shared<State>();
  state->stream.open(path, std::ios::binary);
  if (!state->stream) throw InputError(fmt::format("{}: cannot be read", path.string()));
  return [state, path, salvage]() -> std::optional<ReceivedPacket> {
    std::array<uint8_t, VelodynePacket::kBytes> bytes;
    state->stream.read(reinterpret_cast<char*>(bytes.data()), bytes.size());
    const auto got = static_cast<size_t>(state->stream.gcount());
    const std::string place = fmt::format("{}: packet {}", path.string(), state->packets++);
    if (got == 0 || (salvage && got < bytes.size())) return std::nullopt;
    return ReceivedPacket{decode_packet({bytes.data(), got}, place), std::nullopt};
  };
}

PacketReader read_pcap_file(const fs::path& path, bool salvage) {
  auto file = std::make_shared<PcapFile>(path, salvage);
  return [file] { return file->next(); };
}

}  // namespace vsslam

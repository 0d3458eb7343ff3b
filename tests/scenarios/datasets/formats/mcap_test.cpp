// MCAP files as other recorders write them.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <lz4frame.h>

#include "core/errors.h"
#include "core/files.h"
#include "scenarios/datasets/formats/mcap_records.h"
#include "scenarios/datasets/formats/recording_chunks.h"
#include "tests/scenarios/datasets/dataset_messages.h"
#include "tests/scratch.h"

namespace vsslam {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;

std::string record(McapOp op, std::string_view content) {
  std::string bytes;
  put_record(op, content, bytes);
  return bytes;
}

/// An IMU whose rate about z is `number`.
std::string imu_record(uint16_t channel, WireFormat format, int number) {
  ImuMessage imu;
  imu.angular_velocity.z() = number;
  std::string content, message;
  encode_message(imu, format, message);
  put_number(content, channel);
  put_number(content, uint32_t{0});
  put_number(content, static_cast<uint64_t>(after_epoch(number).ns));
  put_number(content, uint64_t{0});
  return record(McapOp::message, content + message);
}

// Channels 1: cdr, 2: ros1, 3: an encoding and 4: a type that are not read here.
std::string channel_records() {
  return record(McapOp::schema, mcap_content(McapSchema{1, "sensor_msgs/msg/Imu", "ros2msg", ""})) +
         record(McapOp::schema,
                mcap_content(McapSchema{2, "std_msgs/msg/String", "ros2msg", "string data\n"})) +
         record(McapOp::channel, mcap_content(McapChannel{1, 1, "/cdr", "cdr"})) +
         record(McapOp::channel, mcap_content(McapChannel{2, 1, "/ros1", "ros1"})) +
         record(McapOp::channel, mcap_content(McapChannel{3, 1, "/json", "json"})) +
         record(McapOp::channel, mcap_content(McapChannel{4, 2, "/text", "cdr"}));
}

std::string message_records() {
  return imu_record(1, WireFormat::cdr, 1) + imu_record(3, WireFormat::cdr, 2) +
         imu_record(4, WireFormat::cdr, 3) + imu_record(2, WireFormat::ros1, 5) +
         imu_record(1, WireFormat::cdr, 4);
}

std::string chunk_record(const std::string& records, std::string_view compression, const std::string& stored,
                         uint32_t crc) {
  std::string content;
  put_number(content, static_cast<uint64_t>(after_epoch(1).ns));
  put_number(content, static_cast<uint64_t>(after_epoch(5).ns));
  put_number(content, uint64_t{records.size()});
  put_number(content, crc);
  put_text(compression, content);
  put_number(content, uint64_t{stored.size()});
  return record(McapOp::chunk, content + stored);
}

/// A whole file without a summary.
fs::path file_of(const std::string& records) {
  const fs::path path = scratch_folder() / "other.mcap";
  write_file(path, std::string(kMcapMagic) + record(McapOp::header, std::string(8, '\0')) + records +
                       record(McapOp::data_end, std::string(4, '\0')) +
                       record(McapOp::footer, std::string(kMcapFooter, '\0')) + std::string(kMcapMagic));
  return path;
}

std::vector<int> numbers_in(MessageReader& reader) {
  std::vector<int> numbers;
  while (const auto message = reader.next())
    numbers.push_back(static_cast<int>(std::get<ImuMessage>(message->content).angular_velocity.z()));
  return numbers;
}

TEST(OtherMcap, WithoutChunksOrSummaryIsReadInOrder) {
  const auto reader = read_messages(file_of(channel_records() + message_records()));
  EXPECT_THAT(numbers_in(*reader), ElementsAre(1, 4, 5));
  std::vector<std::string> topics;
  for (const RecordedTopic& topic : reader->topics())
    topics.push_back(fmt::format("{} {} {}", topic.name, topic.type, topic.messages));
  EXPECT_THAT(topics, ElementsAre("/cdr sensor_msgs/Imu 2", "/json sensor_msgs/Imu 1",
                                  "/ros1 sensor_msgs/Imu 1", "/text std_msgs/String 1"));
  EXPECT_EQ(reader->begin(), after_epoch(1));
  EXPECT_EQ(reader->end(), after_epoch(5));
}

TEST(OtherMcap, MayHaveChunksWithoutCompressionOrChecksum) {
  const std::string records = channel_records() + message_records();
  EXPECT_THAT(numbers_in(*read_messages(file_of(chunk_record(records, "", records, 0)))),
              ElementsAre(1, 4, 5));
  EXPECT_THAT(numbers_in(*read_messages(file_of(chunk_record(records, "", records, crc32_of(records))))),
              ElementsAre(1, 4, 5));
}

TEST(OtherMcap, MayHaveChunksOfLz4) {
  const std::string records = channel_records() + message_records();
  std::string stored(LZ4F_compressFrameBound(records.size(), nullptr), '\0');
  stored.resize(LZ4F_compressFrame(stored.data(), stored.size(), records.data(), records.size(), nullptr));
  EXPECT_THAT(numbers_in(*read_messages(file_of(chunk_record(records, "lz4", stored, crc32_of(records))))),
              ElementsAre(1, 4, 5));
}

TEST(OtherMcap, WithAnotherChecksumIsBroken) {
  const std::string records = channel_records() + message_records();
  const fs::path file = file_of(chunk_record(records, "", records, 12345));
  try {
    read_messages(file);
    FAIL() << "not noticed";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("its content does not have its checksum"));
  }
  const auto reader = read_messages(file, {.salvage = true});
  EXPECT_THAT(numbers_in(*reader), ElementsAre());
  EXPECT_THAT(reader->damage(), HasSubstr("checksum"));
}

TEST(OtherMcap, MayMixMessagesInChunksAndOutside) {
  const std::string inside = imu_record(1, WireFormat::cdr, 3) + imu_record(1, WireFormat::cdr, 1);
  const std::string file = channel_records() + imu_record(1, WireFormat::cdr, 2) +
                           chunk_record(inside, "", inside, 0) + imu_record(1, WireFormat::cdr, 0) +
                           imu_record(1, WireFormat::cdr, 4);
  EXPECT_THAT(numbers_in(*read_messages(file_of(file))), ElementsAre(0, 1, 2, 3, 4));
}

TEST(OtherMcap, WithAnyByteFlippedIsReadOrRefused) {
  const std::string records = channel_records() + message_records();
  const std::string bytes = read_file(file_of(records + chunk_record(records, "", records, 0)));
  for (size_t at = 0; at < bytes.size(); at += 3)
    for (const bool salvage : {false, true}) {
      std::string flipped = bytes;
      flipped[at] = static_cast<char>(flipped[at] ^ (at % 2 == 0 ? 0x80 : 0x01));
      const fs::path file = scratch_folder() / "flipped.mcap";
      write_file(file, flipped);
      try {
        numbers_in(*read_messages(file, {.salvage = salvage}));
      } catch (const InputError& error) {
        EXPECT_THAT(error.what(), HasSubstr(file.string() + ": ")) << at;
      }
    }
}

// Each chunk covers all the time, so all are open at once; only one may stay in memory.
TEST(OtherMcap, OverlappingChunksAreReadInLittleMemory) {
  std::string records = channel_records();
  for (int chunk = 0; chunk < 4; ++chunk) {
    std::string inside;
    for (int i = 0; i < 5; ++i) inside += imu_record(1, WireFormat::cdr, chunk + 4 * i);
    records += chunk_record(inside, "", inside, crc32_of(inside));
  }
  const auto reader = read_messages(file_of(records), {.chunk_memory_bytes = 1});
  const std::vector<int> numbers = numbers_in(*reader);
  ASSERT_EQ(numbers.size(), 20u);
  for (int i = 0; i < 20; ++i) EXPECT_EQ(numbers[static_cast<size_t>(i)], i);
}

}  // namespace
}  // namespace vsslam

// Bags as other recorders write them.
#include <bzlib.h>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/errors.h"
#include "core/files.h"
#include "scenarios/datasets/formats/recording_chunks.h"
#include "scenarios/datasets/messages/byte_cursor.h"
#include "tests/scenarios/datasets/dataset_messages.h"
#include "tests/scratch.h"

namespace vsslam {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;

template <Number T>
std::string raw(T value) {
  std::string bytes;
  put_number(bytes, value);
  return bytes;
}

std::string counted(std::string_view bytes) {
  return raw(static_cast<uint32_t>(bytes.size())).append(bytes);
}

using Fields = std::vector<std::pair<std::string, std::string>>;

std::string fields_of(const Fields& fields) {
  std::string header;
  for (const auto& [name, value] : fields) header += counted(fmt::format("{}={}", name, value));
  return header;
}

std::string record(uint8_t op, Fields fields, std::string_view data) {
  fields.emplace_back("op", raw(op));
  return counted(fields_of(fields)) + counted(data);
}

std::string time_of(int number) {
  const int64_t ns = after_epoch(number).ns;
  return raw(static_cast<uint32_t>(ns / 1'000'000'000)) + raw(static_cast<uint32_t>(ns % 1'000'000'000));
}

std::string connection(uint32_t id, const std::string& topic, const std::string& type) {
  return record(7, {{"conn", raw(id)}, {"topic", topic}}, fields_of({{"topic", topic}, {"type", type}}));
}

/// An IMU whose rate about z is `number`.
std::string imu(uint32_t connection, int number) {
  ImuMessage message;
  message.angular_velocity.z() = number;
  std::string bytes;
  encode_message(message, WireFormat::ros1, bytes);
  return record(2, {{"conn", raw(connection)}, {"time", time_of(number)}}, bytes);
}

// Two publishers of one topic, and a type that is not read here.
std::string connections() {
  return connection(0, "/imu", "sensor_msgs/Imu") + connection(1, "/imu", "sensor_msgs/Imu") +
         connection(2, "/text", "std_msgs/String");
}

std::string bz2(std::string bytes) {
  std::string out(bytes.size() + 1000, '\0');
  auto size = static_cast<unsigned>(out.size());
  EXPECT_EQ(
      BZ2_bzBuffToBuffCompress(out.data(), &size, bytes.data(), static_cast<unsigned>(bytes.size()), 1, 0, 0),
      BZ_OK);
  out.resize(size);
  return out;
}

/// A whole file of one chunk.
std::string bag_of(const std::string& messages, const std::string& compression = "none") {
  const std::string records = connections() + messages;
  const auto file_header = [](uint64_t index_at) {
    return std::string(kBagMagic) +
           record(3, {{"index_pos", raw(index_at)}, {"conn_count", raw(3u)}, {"chunk_count", raw(1u)}},
                  "    ");
  };
  const uint64_t chunk_at = file_header(0).size();
  const std::string chunk =
      record(5, {{"compression", compression}, {"size", raw(static_cast<uint32_t>(records.size()))}},
             compression == "bz2" ? bz2(records) : records);
  const std::string info = record(
      6,
      {{"ver", raw(1u)}, {"chunk_pos", raw(chunk_at)}, {"start_time", time_of(1)}, {"end_time", time_of(4)}},
      raw(0u) + raw(2u) + raw(1u) + raw(1u) + raw(2u) + raw(1u));
  return file_header(chunk_at + chunk.size()) + chunk + connections() + info;
}

std::string four_messages() {
  return imu(0, 1) + imu(1, 4) + imu(2, 3) + imu(0, 2);
}

fs::path file_of(const std::string& bytes) {
  const fs::path path = scratch_folder() / "other.bag";
  write_file(path, bytes);
  return path;
}

std::vector<int> numbers_in(MessageReader& reader) {
  std::vector<int> numbers;
  while (const auto message = reader.next())
    numbers.push_back(static_cast<int>(std::get<ImuMessage>(message->content).angular_velocity.z()));
  return numbers;
}

TEST(OtherBag, MayHaveChunksOfBzip2OrOfNoCompression) {
  for (const char* compression : {"none", "bz2"}) {
    const auto reader = read_messages(file_of(bag_of(four_messages(), compression)));
    EXPECT_THAT(numbers_in(*reader), ElementsAre(1, 2, 4));
    ASSERT_EQ(reader->topics().size(), 2u);
    EXPECT_EQ(reader->topics()[0].name, "/imu");
    EXPECT_EQ(reader->topics()[0].messages, 3u);
    EXPECT_EQ(reader->topics()[1].type, "std_msgs/String");
    EXPECT_EQ(reader->begin(), after_epoch(1));
    EXPECT_EQ(reader->end(), after_epoch(4));
  }
}

TEST(OtherBag, OfAnotherCompressionIsAnErrorThatNamesIt) {
  try {
    numbers_in(*read_messages(file_of(bag_of(four_messages(), "zip"))));
    FAIL() << "not noticed";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("compression \"zip\" is not known here"));
  }
}

TEST(OtherBag, WithABrokenMessageEndsThere) {
  const std::string broken = record(2, {{"conn", raw(0u)}, {"time", time_of(3)}}, "no IMU");
  const fs::path file = file_of(bag_of(imu(0, 1) + imu(1, 2) + broken + imu(0, 4)));
  try {
    numbers_in(*read_messages(file));
    FAIL() << "not noticed";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("message on /imu at 1700000000.000 s: "));
  }
  const auto reader = read_messages(file, {.salvage = true});
  EXPECT_THAT(numbers_in(*reader), ElementsAre(1, 2));
  EXPECT_THAT(reader->damage(), HasSubstr("message on /imu"));
}

TEST(OtherBag, WithAnyByteFlippedIsReadOrRefused) {
  const std::string bytes = bag_of(four_messages());
  for (size_t at = 0; at < bytes.size(); at += 3)
    for (const bool salvage : {false, true}) {
      std::string flipped = bytes;
      flipped[at] = static_cast<char>(flipped[at] ^ (at % 2 == 0 ? 0x80 : 0x01));
      const fs::path file = file_of(flipped);
      try {
        numbers_in(*read_messages(file, {.salvage = salvage}));
      } catch (const InputError& error) {
        EXPECT_THAT(error.what(), HasSubstr(file.string() + ": ")) << at;
      }
    }
}

}  // namespace
}  // namespace vsslam

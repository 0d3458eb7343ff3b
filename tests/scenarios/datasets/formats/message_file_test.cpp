#include "scenarios/datasets/formats/message_file.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>

#include "core/errors.h"
#include "core/files.h"
#include "core/rng.h"
#include "tests/scenarios/datasets/dataset_messages.h"
#include "tests/scratch.h"

namespace vsslam {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

struct Format {
  std::string name;
  std::unique_ptr<MessageWriter> (*open)(const fs::path&);
};
void PrintTo(const Format& format, std::ostream* out) {
  *out << format.name;
}

class MessageFiles : public testing::TestWithParam<Format> {
 protected:
  fs::path path(const std::string& name = "file") const {
    return scratch_folder() / fmt::format("{}.{}", name, GetParam().name);
  }
  fs::path written(const std::vector<Message>& messages, const std::string& name = "file") const {
    const auto writer = GetParam().open(path(name));
    for (const Message& message : messages) writer->write(message);
    writer->finish();
    return path(name);
  }
  fs::path broken(std::string_view bytes) const {
    write_file(path("broken"), bytes);
    return path("broken");
  }
};
INSTANTIATE_TEST_SUITE_P(Datasets, MessageFiles,
                         testing::Values(Format{"bag", write_bag}, Format{"mcap", write_mcap}),
                         [](const auto& info) { return info.param.name; });

/// Clouds and IMU samples in several chunks; the clouds' content does not compress. Stamps ascend.
std::vector<Message> drive(int scans, size_t cloud_bytes = 400'000) {
  std::vector<Message> messages;
  for (int i = 0; i < scans; ++i) {
    PointCloudMessage cloud;
    cloud.data.resize(cloud_bytes);
    const RandomStream noise(static_cast<uint64_t>(i), "cloud");
    for (size_t k = 0; k < cloud_bytes; ++k) cloud.data[k] = static_cast<uint8_t>(noise.bits(k));
    messages.push_back({"/points", after_epoch(int64_t{100'000'000} * i + 1), std::move(cloud)});
    for (int k = 0; k < 10; ++k) {
      ImuMessage imu;
      imu.angular_velocity.z() = 0.1 * k;
      messages.push_back({"/imu", after_epoch(int64_t{100'000'000} * i + 10'000'000 * k + 2), imu});
    }
  }
  return messages;
}

std::vector<std::string> everything_in(const std::vector<Message>& messages) {
  std::vector<std::string> all;
  for (const Message& message : messages) all.push_back(vsslam::everything_in(message));
  return all;
}

void expect_prefix(const std::vector<std::string>& part, const std::vector<std::string>& whole,
                   size_t where) {
  ASSERT_LE(part.size(), whole.size()) << where;
  for (size_t i = 0; i < part.size(); ++i) ASSERT_EQ(part[i], whole[i]) << "message " << i << ", " << where;
}

TEST_P(MessageFiles, GiveBackWhatWasWritten) {
  std::vector<Message> messages;
  for (MessageContent& content : one_of_each()) {
    // Not in ROS 2.
    std::visit(
        [](auto& message) {
          if constexpr (requires { message.header; })
            message.header.seq = 0;
          else
            message.transforms.at(0).header.seq = 0;
        },
        content);
    messages.push_back({fmt::format("/topic_{}", messages.size()),
                        after_epoch(static_cast<int64_t>(messages.size())), std::move(content)});
  }
  const auto reader = read_messages(written(messages));
  EXPECT_EQ(vsslam::everything_in(*reader), everything_in(messages));
  EXPECT_EQ(reader->begin(), messages.front().recorded);
  EXPECT_EQ(reader->end(), messages.back().recorded);
  EXPECT_EQ(reader->damage(), "");
  ASSERT_EQ(reader->topics().size(), messages.size());
  for (size_t i = 0; i < messages.size(); ++i) {
    EXPECT_EQ(reader->topics()[i].name, messages[i].topic);
    EXPECT_EQ(reader->topics()[i].type, message_type(messages[i].content));
    EXPECT_EQ(reader->topics()[i].messages, 1u);
  }
}

TEST_P(MessageFiles, AreTheSameBytesTwice) {
  const std::vector<Message> messages = drive(6);
  EXPECT_EQ(read_file(written(messages, "first")), read_file(written(messages, "second")));
}

TEST_P(MessageFiles, AppearWhenFinished) {
  const fs::path folder = scratch_folder() / ("unfinished_" + GetParam().name);
  const fs::path file = folder / ("file." + GetParam().name);
  {
    const auto writer = GetParam().open(file);
    writer->write({"/imu", after_epoch(1), ImuMessage{}});
    EXPECT_FALSE(fs::exists(file));
  }
  EXPECT_TRUE(fs::is_empty(folder));
}

TEST_P(MessageFiles, MayBeEmpty) {
  const auto reader = read_messages(written({}));
  EXPECT_FALSE(reader->next());
  EXPECT_TRUE(reader->topics().empty());
  EXPECT_EQ(reader->begin(), Time{});
  EXPECT_EQ(reader->end(), Time{});
}

TEST_P(MessageFiles, WriteNothingRecordedBeforeTime0) {
  EXPECT_THROW(written({{"/imu", Time{0}, ImuMessage{}}}), InputError);
}

TEST_P(MessageFiles, AreReadInOrderOfTimeAcrossChunks) {
  std::vector<Message> messages = drive(12);
  const std::vector<std::string> ordered = everything_in(messages);
  std::swap(messages[3], messages[60]);
  std::swap(messages[20], messages[100]);
  EXPECT_EQ(vsslam::everything_in(*read_messages(written(messages))), ordered);
}

TEST_P(MessageFiles, AreReadByTopic) {
  const auto reader = read_messages(written(drive(5)), {.topics = {"/imu"}});
  EXPECT_EQ(vsslam::everything_in(*reader).size(), 50u);
  ASSERT_EQ(reader->topics().size(), 2u);
  EXPECT_EQ(reader->topics()[1].name, "/points");
  EXPECT_EQ(reader->topics()[1].messages, 5u);
}

TEST_P(MessageFiles, SaveThePartBeforeATruncation) {
  const std::vector<Message> messages = drive(16, 200'000);
  const std::vector<std::string> whole = everything_in(messages);
  const std::string bytes = read_file(written(messages));
  const RandomStream places(1, "truncation");
  size_t most = 0;
  for (size_t i = 0; i < 40; ++i) {
    const size_t size = i < 5 ? bytes.size() - 1 - i * 7 : places.bits(i) % bytes.size();
    const fs::path file = broken(std::string_view(bytes).substr(0, size));
    EXPECT_THROW(vsslam::everything_in(*read_messages(file)), InputError) << size;
    if (size < 13) continue;  // not even the name of the format
    const auto reader = read_messages(file, {.salvage = true});
    const std::vector<std::string> part = vsslam::everything_in(*reader);
    expect_prefix(part, whole, size);
    EXPECT_NE(reader->damage(), "") << size;
    // All but the last chunk or two, of about 1 MB each.
    if (size > 2'500'000) {
      EXPECT_GT(part.size() * bytes.size(), (size - 2'500'000) * whole.size()) << size;
    }
    most = std::max(most, part.size());
  }
  EXPECT_EQ(most, whole.size());  // when only the index is missing
}

TEST_P(MessageFiles, ReportABrokenChunkAndWhereItIs) {
  const std::vector<Message> messages = drive(8);
  std::string bytes = read_file(written(messages));
  bytes[bytes.size() / 2] = static_cast<char>(~bytes[bytes.size() / 2]);
  const fs::path file = broken(bytes);
  try {
    vsslam::everything_in(*read_messages(file));
    FAIL() << "not noticed";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr(file.string() + ": chunk at byte "));
  }
  const auto reader = read_messages(file, {.salvage = true});
  const std::vector<std::string> part = vsslam::everything_in(*reader);
  expect_prefix(part, everything_in(messages), 0);
  EXPECT_GT(part.size(), messages.size() / 8);
  EXPECT_THAT(reader->damage(), HasSubstr("chunk at byte "));
}

TEST_P(MessageFiles, FlippedBytesAreReadOrRefused) {
  const std::vector<Message> messages = drive(3, 10'000);
  const std::string bytes = read_file(written(messages));
  const RandomStream places(2, "flips");
  for (size_t i = 0; i < 200; ++i) {
    std::string flipped = bytes;
    // Every other one where headers and indexes are.
    const size_t at = i % 2 == 0
                          ? places.bits(i) % bytes.size()
                          : (places.bits(i) % 2 == 0 ? 0 : bytes.size() - 5000) + places.bits(i, 1) % 5000;
    flipped[at] = static_cast<char>(flipped[at] ^ (1 << places.bits(i, 2) % 8));
    const fs::path file = broken(flipped);
    for (const bool salvage : {false, true}) {
      try {
        vsslam::everything_in(*read_messages(file, {.salvage = salvage}));
      } catch (const InputError& error) {
        EXPECT_THAT(error.what(), HasSubstr(file.string() + ": "));
      }
    }
  }
}

// What a killed recorder leaves: the file as it is on disk while it is being written.
TEST_P(MessageFiles, SaveWhatAKilledRecorderLeft) {
  const std::vector<Message> messages = drive(9);
  const fs::path folder = scratch_folder() / ("killed_" + GetParam().name);
  const auto writer = GetParam().open(folder / "file");
  for (const Message& message : messages) writer->write(message);
  const fs::path left = fs::directory_iterator(folder)->path();
  try {
    read_messages(left);
    FAIL() << "not noticed";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("its recording was not finished"));
  }
  const auto reader = read_messages(left, {.salvage = true});
  const std::vector<std::string> part = vsslam::everything_in(*reader);
  expect_prefix(part, everything_in(messages), 0);
  EXPECT_GT(part.size(), messages.size() / 2);
  EXPECT_NE(reader->damage(), "");
}

/// While it lives, files end at `bytes`, as on a full disk.
class FileLimit {
 public:
  explicit FileLimit(rlim_t bytes) {
    getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limit{bytes, before_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FileLimit() {
    setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, signal_);
  }

 private:
  rlimit before_{};
  void (*signal_)(int) = std::signal(SIGXFSZ, SIG_IGN);
};

// Where it fills may be the header, a chunk or the index; the file's content does not compress.
TEST_P(MessageFiles, OnAFullDiskAreAResourceErrorAndLeaveNothing) {
  const std::vector<Message> messages = drive(3);
  const size_t whole = fs::file_size(written(messages));
  const fs::path folder = scratch_folder() / ("full_disk_" + GetParam().name);
  for (const size_t bytes : {size_t{10}, size_t{3000}, whole / 2, whole - 3000, whole - 1}) {
    const FileLimit limit(bytes);
    const auto write_all = [&] {
      const auto writer = GetParam().open(folder / "file");
      for (const Message& message : messages) writer->write(message);
      writer->finish();
    };
    EXPECT_THROW(write_all(), ResourceError) << bytes;
  }
  std::vector<fs::path> left;
  for (const auto& entry : fs::directory_iterator(folder)) left.push_back(entry.path());
  EXPECT_THAT(left, testing::IsEmpty());
}

TEST_P(MessageFiles, RememberWhatIsLatched) {
  const auto writer = GetParam().open(path());
  writer->write({"/tf_static", after_epoch(1), TransformsMessage{}}, true);
  writer->write({"/imu", after_epoch(1), ImuMessage{}});
  writer->finish();
  EXPECT_THAT(read_file(path()), HasSubstr(GetParam().name == "bag" ? "latching=1" : "offered_qos_profiles"));
}

TEST(MessageFile, IsKnownByItsContent) {
  const fs::path file = scratch_folder() / "other.bag";
  const auto refusal = [&](std::string_view content) -> std::string {
    write_file(file, content);
    try {
      read_messages(file);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_THAT(refusal(""), HasSubstr("neither a ROS 1 bag, nor an MCAP file"));
  EXPECT_THAT(refusal("some text that is no recording"), HasSubstr("neither a ROS 1 bag, nor an MCAP file"));
  EXPECT_THAT(refusal("#ROSBAG V1.2\n"), HasSubstr("another format than 2.0"));
  EXPECT_THROW(read_messages(scratch_folder() / "not_there.bag"), InputError);
  EXPECT_THROW(read_messages(scratch_folder()), InputError);
}

}  // namespace
}  // namespace vsslam

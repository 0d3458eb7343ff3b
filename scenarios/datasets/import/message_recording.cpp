#include "scenarios/datasets/import/message_recording.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "core/errors.h"
#include "scenarios/datasets/import/decoders/image_decoder.h"

namespace vsslam {

namespace {

constexpr Duration kScanSlack{5'000'000}, kExposureSlack{40'000'000};

// Times of points are rounded: the last may be a little after the end.
Time end_of(Time last, Time recorded, Duration slack) {
  constexpr Duration kRounding{1000};
  return recorded >= last - kRounding && recorded - last <= slack ? recorded : last;
}

RecordedSample moved_by(Duration shift, RecordedSample sample) {
  sample.end = sample.end + shift;
  std::visit([&](auto& s) { s.stamp = s.stamp + shift; }, sample.sample);
  if (auto* scan = std::get_if<LidarScan>(&sample.sample)) scan->end = scan->end + shift;
  sample.moved = shift.ns != 0;
  return sample;
}

CloudDecoder::Options looked_at(CloudDecoder::Options clouds, const FirstLook& look) {
  clouds.rings = std::max(clouds.rings, look.rings);
  clouds.parts = look.parts;
  return clouds;
}

std::string role_of(const TopicChoice& topics, const std::string& name) {
  for (const auto& [sensor, topic] : topics)
    if (topic == name) return sensor;
  return {};
}

}  // namespace

ImuSample imu_of_message(const ImuMessage& message) {
  ImuSample sample{message.header.stamp, message.angular_velocity, message.linear_acceleration, std::nullopt};
  // All zero: what drivers leave that never set it; -1: not measured.
  const double norm = message.orientation.norm();
  if (message.orientation_covariance[0] >= 0 && norm > 0.9 && norm < 1.1 &&
      (message.orientation_covariance[0] > 0 || !message.orientation.isApprox(Quat::Identity())))
    sample.q_earth_imu = message.orientation.normalized();
  return sample;
}

MessageRecording::MessageRecording(std::unique_ptr<MessageReader> reader, std::string file,
                                   TopicChoice topics, const RigCalibration& rig,
                                   const CloudDecoder::Options& clouds, std::vector<std::string> notes,
                                   const std::vector<RecordedTopic>& all, MessageSurvey survey)
    : reader_(std::move(reader)),
      file_(std::move(file)),
      topics_(std::move(topics)),
      rig_(rig),
      survey_(std::move(survey)),
      clouds_(looked_at(clouds, survey_.look)),
      twists_(rig.wheels),
      notes_(std::move(notes)) {
  facts_.format = "messages";
  facts_.expected_duration_s = seconds_between(reader_->begin(), reader_->end());
  for (const RecordedTopic& topic : all)
    facts_.streams.push_back({topic.name, topic.type, topic.messages, role_of(topics_, topic.name)});
  for (size_t i = 0; i < kSensors; ++i) facts_.has[i] = topics_.contains(kSensorNames[i]);
  facts_.rings = survey_.look.rings;
  for (const std::string& note : survey_.clocks.notes) notes_.push_back(note);
  if (const auto& parts = survey_.look.parts)
    notes_.push_back(fmt::format(
        "lidar: clouds are parts of turns, one every {:.1f} ms: put together to turns of {:.3f} s",
        1e3 * parts->every_s, parts->turn_s));
}

std::optional<RecordedSample> MessageRecording::next() {
  while (std::optional<Message> message = reader_->next()) {
    const std::string role = role_of(topics_, message->topic);
    if (role.empty()) continue;
    const uint64_t number = read_[message->topic]++;
    const std::string place = fmt::format("{}: {} message {}", file_, message->topic, number);
    const Duration shift = survey_.clocks.shift_of(role, number);
    if (role == "truth") {
      add_truth(*message, shift);
    } else if (auto sample = sample_or_none(stamped(std::move(*message)), role, shift, place)) {
      return sample;
    }
  }
  if (std::optional<LidarScan> last = turns_.rest()) {
    const Time end = last->end;
    return RecordedSample{std::move(*last), end};
  }
  return std::nullopt;
}

// Of a topic that could be read before, one broken message does not matter.
std::optional<RecordedSample> MessageRecording::sample_or_none(const Message& message,
                                                               const std::string& role, Duration shift,
                                                               const std::string& place) {
  const auto sensor =
      static_cast<size_t>(std::find(kSensorNames, kSensorNames + kSensors, role) - kSensorNames);
  try {
    auto sample = sample_of(message, shift, place);
    ++readable_[sensor];
    return sample;
  } catch (const InputError& error) {
    if (readable_[sensor] == 0 || ++unreadable_[sensor] > 10 + readable_[sensor] / 10) throw;
    if (unreadable_[sensor] == 1) notes_.push_back(fmt::format("left out: {}", error.what()));
    return std::nullopt;
  }
}

// Some drivers leave the stamp empty.
Message MessageRecording::stamped(Message message) {
  const auto stamp = [&](auto& content) {
    if constexpr (requires { content.header; }) {
      if (content.header.stamp.ns != 0) return;
      content.header.stamp = message.recorded;
      const std::string note =
          fmt::format("{}: empty stamps: when it was recorded stands for them", message.topic);
      if (std::find(notes_.begin(), notes_.end(), note) == notes_.end()) notes_.push_back(note);
    }
  };
  std::visit(stamp, message.content);
  return message;
}

std::optional<RecordedSample> MessageRecording::sample_of(const Message& message, Duration shift,
                                                          const std::string& place) {
  const auto ends_at_stamp = [&](auto sample) {
    return moved_by(shift, RecordedSample{sample, sample.stamp});
  };
  const auto picture = [&](CameraFrame frame) {
    check_image_size(frame, rig_.camera, place);
    const Time stamp = frame.stamp;
    RecordedSample sample = moved_by(shift, {std::move(frame), stamp});
    sample.end = end_of(sample.end, message.recorded, kExposureSlack);
    return sample;
  };
  if (const auto* imu = std::get_if<ImuMessage>(&message.content)) {
    const ImuSample sample = imu_of_message(*imu);
    return ends_at_stamp(sample);
  }
  if (const auto* joints = std::get_if<JointStateMessage>(&message.content)) {
    const auto sample = wheels_of_joints(*joints);
    return sample ? std::optional(ends_at_stamp(*sample)) : std::nullopt;
  }
  if (const auto* odometry = std::get_if<OdometryMessage>(&message.content))
    return twist_sample(*odometry, shift);
  if (const auto* image = std::get_if<ImageMessage>(&message.content))
    return picture(decode_image(*image, place, &survey_.look.depth));
  if (const auto* image = std::get_if<CompressedImageMessage>(&message.content))
    return picture(decode_compressed(*image, place, &survey_.look.depth));
  if (const auto* cloud = std::get_if<PointCloudMessage>(&message.content)) {
    LidarScan decoded = clouds_.decode(*cloud, place);
    const Time last = decoded.end;
    RecordedSample sample = moved_by(shift, {std::move(decoded), last});
    LidarScan& scan = std::get<LidarScan>(sample.sample);
    sample.end = scan.end = end_of(scan.end, message.recorded, kScanSlack);
    return survey_.look.parts ? turn_with(std::move(scan), sample.moved) : std::optional(std::move(sample));
  }
  return std::nullopt;
}

std::optional<RecordedSample> MessageRecording::turn_with(LidarScan part, bool moved) {
  std::optional<LidarScan> turn = turns_.add(std::move(part));
  if (!turn) return std::nullopt;
  const Time end = turn->end;
  return RecordedSample{std::move(*turn), end, moved};
}

// The twist holds since the message before, on one clock: a step of it is no time.
RecordedSample MessageRecording::twist_sample(OdometryMessage odometry, Duration shift) {
  odometry.header.stamp = odometry.header.stamp + shift;
  const WheelSample sample = twists_.add(odometry);
  return {sample, sample.stamp, shift.ns != 0};
}

void MessageRecording::add_truth(const Message& message, Duration shift) {
  const auto add = [&](Time recorded_stamp, const SE3& T_world_base) {
    const Time stamp = recorded_stamp + shift;
    if (truth_world_base_.empty() || stamp > truth_world_base_.back().stamp)
      truth_world_base_.push_back({stamp, T_world_base});
  };
  if (const auto* odometry = std::get_if<OdometryMessage>(&message.content))
    add(odometry->header.stamp, odometry->T_parent_child);
  if (const auto* pose = std::get_if<PoseStampedMessage>(&message.content))
    add(pose->header.stamp, pose->T_parent_child);
}

// Some drivers give the specific force in g.
std::vector<std::string> MessageRecording::notes() const {
  std::vector<std::string> notes = notes_;
  for (const std::string& note : clouds_.notes()) notes.push_back("lidar: " + note);
  if (const std::string note = note_of(survey_.look.depth); !note.empty()) notes.push_back(note);
  if (turns_.broken() > 0) notes.push_back("lidar: turns of which parts are missing are left out");
  if (!reader_->damage().empty()) notes.push_back("damaged: " + reader_->damage());
  return notes;
}

}  // namespace vsslam

// The messages of a bag or an MCAP file as samples.
#pragma once

#include <array>
#include <map>
#include <memory>
#include <string>

#include "core/calibration.h"
#include "scenarios/datasets/formats/message_file.h"
#include "scenarios/datasets/import/decoders/cloud_decoder.h"
#include "scenarios/datasets/import/decoders/wheel_decoder.h"
#include "scenarios/datasets/import/message_survey.h"
#include "scenarios/datasets/import/recording.h"
#include "scenarios/datasets/import/topic_choice.h"

namespace vsslam {

/// The end of an acquisition is taken from when its message was recorded, if that is no more than 5 ms after a scan's
/// last point, or 40 ms after the middle of an image's exposure; else it is that point, or that middle.
///
/// Clouds that are parts of turns are put together. A message that is broken is left out and counted, if others of its topic
/// are not.
class MessageRecording final : public Recording {
 public:
  /// `reader` delivers the chosen topics; `all` are listed in the facts.
  MessageRecording(std::unique_ptr<MessageReader> reader, std::string file, TopicChoice topics,
                   const RigCalibration& rig, const CloudDecoder::Options& clouds,
                   std::vector<std::string> notes, const std::vector<RecordedTopic>& all,
                   MessageSurvey survey = {});

  const RecordingFacts& facts() const override { return facts_; }
  std::optional<RecordedSample> next() override;
  Duration window() const override { return survey_.clocks.window; }
  int64_t unreadable(size_t sensor) const override { return unreadable_[sensor]; }
  const std::vector<StampedPose>& truth_world_base() const override { return truth_world_base_; }
  std::vector<std::string> notes() const override;

 private:
  std::optional<RecordedSample> sample_or_none(const Message& message, const std::string& role,
                                               Duration shift, const std::string& place);
  std::optional<RecordedSample> sample_of(const Message& message, Duration shift, const std::string& place);
  std::optional<RecordedSample> turn_with(LidarScan part, bool moved);
  RecordedSample twist_sample(OdometryMessage odometry, Duration shift);
  Message stamped(Message message);
  void add_truth(const Message& message, Duration shift);

  std::unique_ptr<MessageReader> reader_;
  std::string file_;
  TopicChoice topics_;
  RigCalibration rig_;
  MessageSurvey survey_;
  CloudDecoder clouds_;
  TurnAssembler turns_;
  TwistIntegrator twists_;
  RecordingFacts facts_;
  std::vector<StampedPose> truth_world_base_;
  std::map<std::string, uint64_t> read_;  // messages, by topic
  std::array<int64_t, kSensors> unreadable_{}, readable_{};
  std::vector<std::string> notes_;
};

ImuSample imu_of_message(const ImuMessage& message);

}  // namespace vsslam

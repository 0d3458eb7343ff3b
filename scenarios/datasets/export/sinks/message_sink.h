// A dataset as one file of messages: a ROS 1 bag or an MCAP file.
#pragma once

#include <memory>
#include <optional>

#include "scenarios/datasets/facts/dataset_facts.h"
#include "scenarios/datasets/facts/dataset_sink.h"
#include "scenarios/datasets/formats/message_file.h"

namespace vsslam {

class MessageSink final : public DatasetSink {
 public:
  MessageSink(const DatasetFacts& facts, std::unique_ptr<MessageWriter> writer);

  /// A container cannot be continued.
  bool needs_scan(int64_t, Time) const override { return true; }
  bool needs_image(Time) const override { return true; }
  void write(const DatasetSample& sample) override;
  void finish() override { writer_->finish(); }

 private:
  void write(const ImuMeasurement& imu, Time recorded);
  void write(const WheelMeasurement& wheels, Time recorded);
  void write(const LidarMeasurement& lidar, Time recorded);
  void write(const CameraMeasurement& camera, Time recorded);
  void put(const std::string& topic, Time recorded, MessageContent content);
  uint32_t next_seq(const std::string& topic) { return seq_[topic]++; }

  MessageNames names_;
  RigCalibration rig_;
  ImuDeviations deviations_;
  bool camera_;
  WheelOdometry odometry_;
  std::map<std::string, uint32_t> seq_;
  Kinematics base_;  ///< of the sample being written
  bool begun_ = false;
  std::unique_ptr<MessageWriter> writer_;
};

}  // namespace vsslam

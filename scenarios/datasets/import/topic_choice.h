// Which topic of a recording is which sensor.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "scenarios/datasets/facts/rig_sheet.h"
#include "scenarios/datasets/formats/message_file.h"
#include "scenarios/datasets/import/recording.h"

namespace vsslam {

/// By sensor: "lidar", "imu", "camera", "wheels", "truth". A sensor that is not there has no entry.
using TopicChoice = std::map<std::string, std::string>;

/// A topic that was asked for (`overrides`; "none": the sensor is not used) must be there, that of the LiDAR in any case.
/// One that the sheet names is taken if it is there. Else the topic is guessed by its type: PointCloud2; Imu; Image or
/// CompressedImage, no depth, the raw one of an image's two; JointState. Empty topics count as missing. Throws InputError:
/// nothing like that (with the nearest name), several candidates (all are listed), no LiDAR. What was guessed goes to
/// `notes`.
TopicChoice choose_topics(const std::vector<RecordedTopic>& topics, const RecordingTopics& sheet,
                          const std::map<std::string, std::string>& overrides, const std::string& file,
                          std::vector<std::string>& notes);

}  // namespace vsslam

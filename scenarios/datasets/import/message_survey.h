// What is known of a file of messages before it is read: a pass over its stamps, and a look at the first messages.
#pragma once

#include <vector>

#include "scenarios/datasets/formats/message_file.h"
#include "scenarios/datasets/import/clock_agreement.h"
#include "scenarios/datasets/import/decoders/cloud_decoder.h"
#include "scenarios/datasets/import/decoders/image_decoder.h"
#include "scenarios/datasets/import/topic_choice.h"

namespace vsslam {

/// By the first clouds and images.
struct FirstLook {
  Duration scan_lasts;               ///< from a cloud's stamp to its last point
  int rings = 0;                     ///< that the points tell of; 0: they tell nothing
  std::optional<TurnParts> parts{};  ///< clouds are parts of turns
  PixelDepth depth;
};

/// What a first pass over a file found.
struct MessageSurvey {
  FirstLook look{};
  ClockPlan clocks{};
};

/// At up to 24 clouds and 10 images, but not beyond 5 s of recording. Broken messages end it. `reader` delivers the LiDAR's
/// topic, and the camera's if it is used.
FirstLook look_at_first(MessageReader& reader, const CloudDecoder::Options& clouds);

/// Rings that the points of these clouds tell of, by their numbers or else by their elevations. Throws InputError.
int rings_of_clouds(const std::vector<PointCloudMessage>& clouds, const CloudDecoder::Options& options);

/// When the messages of the chosen topics were recorded, with the ends of their acquisition; as far as the file can be read.
/// `headers` delivers these topics' headers.
std::vector<ReceivedStream> received_streams(MessageReader& headers, const TopicChoice& topics,
                                             Duration scan_lasts);

}  // namespace vsslam

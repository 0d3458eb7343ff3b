// Brings the clocks of a recording's streams together, and finds out how late their messages arrive.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "scenarios/datasets/import/stamp_steps.h"

namespace vsslam {

/// In order of recording.
struct ReceivedStream {
  std::string sensor;  ///< as TopicChoice has it, "truth" included
  std::string name;    ///< topic, for a person
  std::vector<Receipt> messages;
};

/// From this message of its stream on, add so much to the stamps.
struct ClockShift {
  size_t from_message;
  Duration shift;
};

struct ClockPlan {
  std::map<std::string, std::vector<ClockShift>> shifts;  ///< by sensor, rising; none: as recorded
  Duration window{1'000'000'000};  ///< samples that are put in order within it are not late; 1 s .. 1 h
  std::vector<std::string> notes;

  Duration shift_of(const std::string& sensor, size_t message) const;
};

/// Clocks that were set are set back to how they were first, or to how they agree with the recorder's; a step that several
/// streams have at a time counts once, by the stream with the most messages. Streams of which the lead differs by more than
/// a delay explains are on clocks of their own: they are moved so that the least late of all arrive alike. A delay is up
/// to 10 s, and never negative; between 1 and 10 s it is another clock if the streams begin together by their receipts but
/// not by their stamps. Throws InputError that names both clocks if a sensor shares no time with the LiDAR and the
/// receipts do not tell why. Sensors first, truth last.
ClockPlan plan_clocks(std::vector<ReceivedStream> streams, const std::string& file);

}  // namespace vsslam

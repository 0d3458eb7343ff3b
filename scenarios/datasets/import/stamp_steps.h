// Clocks that are set while a recording goes on: when messages were recorded tells.
#pragma once

#include <span>
#include <vector>

#include "core/time.h"

namespace vsslam {

/// One message of a stream: when it was recorded, by the recorder's clock, and the end of its acquisition, by its own.
struct Receipt {
  Time recorded, end;
  size_t place = 0;                                 ///< in the order of reading, among all streams
  Duration lead() const { return end - recorded; }  ///< negative: it took so long to arrive
};

/// The clock of a stream was set, by so much (positive: ahead), before this message.
struct StampStep {
  size_t message;
  Time recorded;
  Duration by;
};

/// Does the recorder's clock go about as fast (0.5 .. 2) as the stream's? If not, e.g. in a recording that was converted
/// in one go, or whose receipts are all the same, they say nothing of the stream's clock. So do less than 10 messages.
bool receipts_tell(std::span<const Receipt> stream);

/// Messages in order of recording. A clock set back makes ends fall by 0.1 s or more; one set ahead makes the lead grow by
/// 0.5 s (and five usual intervals) from one message to the next, beyond all it was before: a queue that empties does
/// not. Five messages in a row must agree.
/// The step is how the lead of the least late changes, among up to 50 messages on both sides. Empty if the receipts do not tell.
std::vector<StampStep> find_steps(std::span<const Receipt> stream);

/// A step of another stream, looked for at about its time (1 s): where the lead changes by as much, if it does.
std::vector<StampStep> find_step_like(std::span<const Receipt> stream, const StampStep& other);

}  // namespace vsslam

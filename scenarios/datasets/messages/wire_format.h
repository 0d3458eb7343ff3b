// Messages as bytes.
//
// ROS 1 (http://wiki.ros.org/msg): little-endian without gaps; strings and lists after their length as uint32.
// CDR of ROS 2 (OMG, "Extensible and Dynamic Topic Types", 7.4.1, as plain XCDR1): four bytes that say the order of
// bytes, then numbers aligned to their size as counted from there; strings end with a NUL that their length counts.
#pragma once

#include <string>
#include <string_view>

#include "scenarios/datasets/messages/messages.h"

namespace vsslam {

enum class WireFormat { ros1, cdr };

/// Replaces `bytes`. Throws InputError on a stamp that the format cannot hold (before 1970, after 2106 or, in CDR, 2038).
void encode_message(const MessageContent& content, WireFormat format, std::string& bytes);

/// `type` in ROS 1's spelling, one that MessageContent has. A rotation in an SE3 is made a unit quaternion, one of
/// zeros the identity; ImuMessage::orientation stays as it is. Throws InputError if `bytes` are no such message.
MessageContent decode_message(std::string_view type, std::string_view bytes, WireFormat format);

/// The same with nothing but the header filled, of messages that have one; what follows it is not looked at.
MessageContent decode_header(std::string_view type, std::string_view bytes, WireFormat format);

}  // namespace vsslam

#include "scenarios/datasets/messages/byte_cursor.h"

#include <fmt/format.h>

#include "core/errors.h"

namespace vsslam {

void ByteCursor::fail(uint64_t size) const {
  throw InputError(fmt::format("{} bytes wanted at byte {} of {}", size, at_, bytes_.size()));
}

}  // namespace vsslam

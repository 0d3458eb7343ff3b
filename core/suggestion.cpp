#include "core/suggestion.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/config.h"

namespace vsslam {

std::string suggestion(std::string_view word, const std::vector<std::string>& candidates) {
  const std::string near = nearest(word, candidates);
  return near.empty() ? fmt::format("one of: {}", fmt::join(candidates, ", "))
                      : fmt::format("did you mean {}?", near);
}

}  // namespace vsslam

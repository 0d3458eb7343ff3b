// What a person may have meant by a word that is not known.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace vsslam {

/// "did you mean X?" where a candidate is near (see nearest()), else "one of: A, B, C".
std::string suggestion(std::string_view word, const std::vector<std::string>& candidates);

}  // namespace vsslam

// Settings of loop closing, and the methods to compare (reference: Song et al. 2025, section 5).
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/config.h"

namespace vsslam {

enum class Method { lvi_sam_no_loop, lvi_sam, sc_lvi_sam };

/// "lvi-sam-no-loop", "lvi-sam", "sc-lvi-sam".
std::string_view method_name(Method method);
/// Throws InputError with the nearest name.
Method parse_method(std::string_view name);
const std::vector<Method>& all_methods();

struct LoopConfig {
  void fields(Fields& f);
};

}  // namespace vsslam

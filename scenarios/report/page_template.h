// Pages from templates.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace vsslam {

/// Replaces each {{name}} of the template; a name without a value is our own bug (std::logic_error).
std::string fill_page(std::string_view text,
                      const std::vector<std::pair<std::string_view, std::string>>& values);

/// Empty without content. `note` is HTML.
std::string section_html(std::string_view id, std::string_view title, std::string_view note,
                         const std::string& content);

}  // namespace vsslam

#include "scenarios/report/page_template.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

namespace vsslam {

std::string fill_page(std::string_view text,
                      const std::vector<std::pair<std::string_view, std::string>>& values) {
  std::string page;
  for (size_t open = text.find("{{"); open != text.npos; open = text.find("{{")) {
    const size_t close = text.find("}}", open);
    const std::string_view name = text.substr(open + 2, close - open - 2);
    page += text.substr(0, open);
    const auto value = std::find_if(values.begin(), values.end(),
                                    [&](const auto& candidate) { return candidate.first == name; });
    if (value == values.end())
      throw std::logic_error(fmt::format("the report page has no value {{{{{}}}}}", name));
    page += value->second;
    text.remove_prefix(close + 2);
  }
  return page += text;
}

std::string section_html(std::string_view id, std::string_view title, std::string_view note,
                         const std::string& content) {
  if (content.empty()) return {};
  return fmt::format("<section id=\"{}\">\n<h2>{}</h2>\n<p class=\"note\">{}</p>\n{}</section>\n", id, title,
                     note, content);
}

}  // namespace vsslam

// Data of a page as JSON, with series as base64 typed arrays.
#pragma once

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "scenarios/report/base64.h"

namespace vsslam {

/// Named columns of floats that grow together.
class Series {
 public:
  void add(const std::string& name, double value) { columns_[name].push_back(static_cast<float>(value)); }
  nlohmann::json to_json() const {
    nlohmann::json object = nlohmann::json::object();
    for (const auto& [name, values] : columns_) object[name] = base64_array(values);
    return object;
  }

 private:
  std::map<std::string, std::vector<float>> columns_;
};

/// Every how manieth of `size` items to take for at most `most` of them.
inline size_t stride_for(size_t size, size_t most) {
  return std::max<size_t>(1, (size + most - 1) / std::max<size_t>(1, most));
}

/// Contains no "<", so it may stand inside a script element.
inline std::string script_text(const nlohmann::json& data) {
  std::string text = data.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  for (size_t at = text.find('<'); at != text.npos; at = text.find('<', at)) text.replace(at, 1, "\\u003c");
  return text;
}

}  // namespace vsslam

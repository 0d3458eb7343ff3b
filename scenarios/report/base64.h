// Numbers as base64 text, for typed arrays in a page.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace vsslam {

std::string base64(std::string_view bytes);
/// Little-endian, as every machine that we build for has it.
template <class T>
std::string base64_array(const std::vector<T>& values) {
  return base64({reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)});
}

}  // namespace vsslam

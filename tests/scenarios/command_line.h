// The program as called from a shell, in this process.
#pragma once

#include <sstream>
#include <string>
#include <vector>

#include "scenarios/cli/cli.h"

namespace vsslam {

struct Outcome {
  int code;
  std::string out, err;
};

inline Outcome call(const std::vector<std::string>& arguments) {
  std::ostringstream out, err;
  const int code = run_cli(arguments, out, err);
  return {code, out.str(), err.str()};
}

}  // namespace vsslam

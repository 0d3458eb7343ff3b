#include <unistd.h>

#include <iostream>
#include <string>
#include <vector>

#include "scenarios/cli.h"

int main(int argc, char** argv) {
  return vsslam::run_cli(std::vector<std::string>(argv + 1, argv + argc), std::cout, std::cerr,
                         isatty(STDERR_FILENO) != 0);
}

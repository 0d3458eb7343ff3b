#include <malloc.h>
#include <unistd.h>

#include <iostream>
#include <string>
#include <vector>

#include "scenarios/cli.h"

int main(int argc, char** argv) {
  // Large blocks go back to the system when they are freed; glibc would come to keep ever larger ones.
  mallopt(M_MMAP_THRESHOLD, 4 << 20);
  return vsslam::run_cli(std::vector<std::string>(argv + 1, argv + argc), std::cout, std::cerr,
                         isatty(STDERR_FILENO) != 0);
}

#include <malloc.h>
#include <unistd.h>

#include <iostream>
#include <string>
#include <vector>

#include "scenarios/cli/cli.h"

int main(int argc, char** argv) {
  // Large blocks go back to the system when they are freed; glibc would come to keep ever larger ones. What the small
  // ones leave is kept: every scan would have to ask for it again, which cost a tenth of a run without camera.
  mallopt(M_MMAP_THRESHOLD, 4 << 20);
  mallopt(M_TRIM_THRESHOLD, 16 << 20);
  mallopt(M_TOP_PAD, 4 << 20);
  return vsslam::run_cli(std::vector<std::string>(argv + 1, argv + argc), std::cout, std::cerr,
                         isatty(STDERR_FILENO) != 0);
}

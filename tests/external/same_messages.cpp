// Do the files hold the same messages? For recordings that others wrote from one of ours.
#include <fmt/format.h>

#include "core/errors.h"
#include "tests/scenarios/datasets/dataset_messages.h"

int main(int argc, char** argv) try {
  using namespace vsslam;
  if (argc < 3) throw InputError("usage: same_messages FILE FILE...");
  const std::vector<std::string> expected = everything_in(*read_messages(argv[1]));
  if (expected.empty()) throw InputError(fmt::format("{}: no messages", argv[1]));
  for (int i = 2; i < argc; ++i) {
    const std::vector<std::string> others = everything_in(*read_messages(argv[i]));
    if (others != expected) throw InputError(fmt::format("{}: other messages than {}", argv[i], argv[1]));
    fmt::print("{}: the {} messages of {}\n", argv[i], others.size(), argv[1]);
  }
} catch (const std::exception& error) {
  fmt::print(stderr, "{}\n", error.what());
  return 1;
}

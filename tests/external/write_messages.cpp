// Writes one message of every type into a bag and an MCAP file, for readers of others.
#include <fmt/format.h>

#include "tests/scenarios/datasets/dataset_messages.h"

int main(int argc, char** argv) {
  using namespace vsslam;
  if (argc != 3) {
    fmt::print(stderr, "usage: write_messages OUT.bag OUT.mcap\n");
    return 2;
  }
  const std::vector<MessageContent> contents = one_of_each();
  const auto bag = write_bag(argv[1]), mcap = write_mcap(argv[2]);
  for (size_t i = 0; i < contents.size(); ++i) {
    const Message message{fmt::format("/topic_{}", i), after_epoch(static_cast<int64_t>(i) + 1), contents[i]};
    const bool latched = std::holds_alternative<TransformsMessage>(message.content);
    bag->write(message, latched);
    mcap->write(message, latched);
  }
  bag->finish();
  mcap->finish();
}

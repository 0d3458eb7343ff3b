// Ctrl-C and SIGTERM: asks a run to stop at the next step; a second one ends the program at once.
#pragma once

#include <atomic>

namespace vsslam {

void catch_interrupts();
/// True once a signal has arrived.
const std::atomic<bool>& interrupt_flag();

}  // namespace vsslam

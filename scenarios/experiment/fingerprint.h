// What a result depends on beside its scenario.yaml.
#pragma once

#include <string>

#include "scenarios/experiment/scenario.h"

namespace vsslam {

/// 16 hexadecimal digits of the program's own bytes, and of the world's if it comes from a file: FNV-1a, 64 bit.
/// Results with the same fingerprint and the same scenario.yaml are the same. Throws InputError if the world's
/// file cannot be read.
std::string fingerprint(const Scenario& scenario);
/// Of the program alone.
std::string fingerprint();

}  // namespace vsslam

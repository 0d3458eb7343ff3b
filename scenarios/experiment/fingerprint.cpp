#include "scenarios/experiment/fingerprint.h"

#include <fmt/format.h>

#include "core/files.h"

namespace vsslam {

namespace {

constexpr uint64_t kStart = 14695981039346656037ull, kPrime = 1099511628211ull;

uint64_t hash(const std::string& bytes, uint64_t seed) {
  for (const char byte : bytes) seed = (seed ^ static_cast<unsigned char>(byte)) * kPrime;
  return seed;
}

uint64_t program() {
  static const uint64_t hashed = hash(read_file("/proc/self/exe"), kStart);
  return hashed;
}

}  // namespace

std::string fingerprint(const Scenario& scenario) {
  const std::string& file = scenario.world.file;
  return fmt::format("{:016x}", file.empty() ? program() : hash(read_file(file), program()));
}

std::string fingerprint() {
  return fmt::format("{:016x}", program());
}

}  // namespace vsslam

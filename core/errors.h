// Errors that a person can act on. Our own bugs are assertions, not exceptions.
#pragma once

#include <stdexcept>
#include <string>

namespace vsslam {

/// Bad input: a file, an option or a value. The message says where, what was expected and what was found.
/// The program ends with exit code 2.
class InputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Out of disk, memory or permission. What was finished is kept. Exit code 3.
class ResourceError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Stopped by the user (Ctrl-C, SIGTERM). What was finished is kept. Exit code 3.
class Interrupted : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace vsslam

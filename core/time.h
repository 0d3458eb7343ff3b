// Integer time. Doubles of seconds exist only inside formulas.
#pragma once

#include <cmath>
#include <compare>
#include <cstdint>

namespace vsslam {

/// A span of time in nanoseconds; may be negative.
struct Duration {
  int64_t ns = 0;

  static Duration from_seconds(double seconds) { return {std::llround(seconds * 1e9)}; }
  double seconds() const { return static_cast<double>(ns) * 1e-9; }
  auto operator<=>(const Duration&) const = default;
};

/// A stamp in nanoseconds since the epoch of the recording (simulation: start of the scenario).
struct Time {
  int64_t ns = 0;

  static Time from_seconds(double seconds) { return {std::llround(seconds * 1e9)}; }
  double seconds() const { return static_cast<double>(ns) * 1e-9; }
  auto operator<=>(const Time&) const = default;
};

inline Duration operator-(Time a, Time b) { return {a.ns - b.ns}; }
inline Time operator+(Time a, Duration d) { return {a.ns + d.ns}; }
inline Time operator-(Time a, Duration d) { return {a.ns - d.ns}; }
inline Duration operator+(Duration a, Duration b) { return {a.ns + b.ns}; }
inline Duration operator-(Duration a, Duration b) { return {a.ns - b.ns}; }
inline Duration operator*(Duration d, int64_t n) { return {d.ns * n}; }

/// Seconds from `a` to `b`.
inline double seconds_between(Time a, Time b) { return (b - a).seconds(); }

}  // namespace vsslam

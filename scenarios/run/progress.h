// How far a run is, for a person: a bar on a terminal, plain lines otherwise.
#pragma once

#include <cstdint>
#include <ostream>
#include <string>

#include "core/stage_clock.h"

namespace vsslam {

/// Simulated seconds done and expected, summed over all runs of a command.
struct ProgressState {
  double done_s = 0, expected_s = 0;
  int64_t scans = 0;
  int finished_runs = 0, runs = 0;
};

/// Not thread-safe.
class Progress {
 public:
  enum class Style { none, lines, bar };
  Progress(Style style, std::ostream& out, StageClock& clock, std::string title);
  /// Clears the bar.
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// Shows the state if it is time to: ten times a second, or every 10 % in plain lines.
  void update(const ProgressState& state);
  /// Prints a line of its own above the bar.
  void note(const std::string& line);

  /// The text that describes a state after `elapsed_s` of wall clock.
  static std::string describe(const ProgressState& state, double elapsed_s);

 private:
  void show_bar(const ProgressState& state, double elapsed_s);
  void clear_bar();

  Style style_;
  std::ostream& out_;
  StageClock& clock_;
  std::string title_;
  int64_t start_ns_, shown_ns_ = 0;
  int shown_tenths_ = 0;
  bool bar_shown_ = false;
};

}  // namespace vsslam

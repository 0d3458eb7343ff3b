#include "scenarios/run/progress.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace vsslam {

namespace {

constexpr int64_t kBarIntervalNs = 100'000'000;

double share(const ProgressState& state) {
  return state.expected_s > 0 ? std::min(1.0, state.done_s / state.expected_s) : 0.0;
}

std::string span_text(double seconds) {
  const auto whole = static_cast<int64_t>(std::ceil(seconds));
  return whole < 60 ? fmt::format("{} s", whole) : fmt::format("{} min {:02} s", whole / 60, whole % 60);
}

}  // namespace

Progress::Progress(Style style, std::ostream& out, StageClock& clock, std::string title)
    : style_(style), out_(out), clock_(clock), title_(std::move(title)), start_ns_(clock.now_ns()) {}

Progress::~Progress() {
  clear_bar();
}

std::string Progress::describe(const ProgressState& state, double elapsed_s) {
  std::string text =
      fmt::format("{:3.0f} %  {:.0f} of {:.0f} s", 100 * share(state), state.done_s, state.expected_s);
  if (elapsed_s <= 0 || state.done_s <= 0) return text;
  text += fmt::format("  {:.0f} scans/s  {:.1f} x real time", static_cast<double>(state.scans) / elapsed_s,
                      state.done_s / elapsed_s);
  const double left_s = elapsed_s * std::max(0.0, state.expected_s - state.done_s) / state.done_s;
  text += fmt::format("  {} left", span_text(left_s));
  if (state.runs > 1) text += fmt::format("  ({} of {} runs)", state.finished_runs, state.runs);
  return text;
}

void Progress::update(const ProgressState& state) {
  if (style_ == Style::none) return;
  const int64_t now_ns = clock_.now_ns();
  const double elapsed_s = static_cast<double>(now_ns - start_ns_) * 1e-9;
  if (style_ == Style::bar) {
    if (now_ns - shown_ns_ < kBarIntervalNs) return;
    shown_ns_ = now_ns;
    show_bar(state, elapsed_s);
    return;
  }
  const int tenths = static_cast<int>(share(state) * 10 + 1e-9);
  if (tenths <= shown_tenths_) return;
  shown_tenths_ = tenths;
  out_ << title_ << ' ' << describe(state, elapsed_s) << std::endl;
}

void Progress::note(const std::string& line) {
  clear_bar();
  if (style_ != Style::none) out_ << line << std::endl;
}

void Progress::show_bar(const ProgressState& state, double elapsed_s) {
  constexpr int kWidth = 24;
  const int full = static_cast<int>(share(state) * kWidth);
  out_ << fmt::format("\r\x1b[K{} [{:=<{}}{: <{}}] {}", title_, "", full, "", kWidth - full,
                      describe(state, elapsed_s))
       << std::flush;
  bar_shown_ = true;
}

void Progress::clear_bar() {
  if (bar_shown_) out_ << "\r\x1b[K" << std::flush;
  bar_shown_ = false;
}

}  // namespace vsslam

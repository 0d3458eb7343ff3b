#include "scenarios/datasets/import/stamp_steps.h"

#include <algorithm>
#include <cstdlib>

namespace vsslam {

namespace {

constexpr size_t kAgree = 5, kFewest = 10, kBeside = 50;
constexpr int64_t kBack_ns = 100'000'000, kAhead_ns = 500'000'000, kLongPause_ns = 10'000'000'000;
constexpr Duration kAbout{1'000'000'000};

int64_t usual_interval_ns(std::span<const Receipt> stream) {
  std::vector<int64_t> intervals;
  for (size_t i = 1; i < stream.size(); ++i)
    if (const int64_t ns = (stream[i].end - stream[i - 1].end).ns; ns > 0) intervals.push_back(ns);
  if (intervals.empty()) return 0;
  const auto middle = intervals.begin() + static_cast<std::ptrdiff_t>(intervals.size() / 2);
  std::nth_element(intervals.begin(), middle, intervals.end());
  return *middle;
}

/// What a clock showed so far, since it was set.
struct Reading {
  size_t first;
  Time newest;
  int64_t most_lead_ns;

  Reading(std::span<const Receipt> stream, size_t message)
      : first(message), newest(stream[message].end), most_lead_ns(stream[message].lead().ns) {}
  void add(const Receipt& message) {
    newest = std::max(newest, message.end);
    most_lead_ns = std::max(most_lead_ns, message.lead().ns);
  }
};

bool leaves(const Reading& reading, std::span<const Receipt> stream, size_t i, int64_t usual_ns) {
  const int64_t lead_ns = stream[i].lead().ns;
  if ((reading.newest - stream[i].end).ns > kBack_ns) return true;
  return lead_ns > reading.most_lead_ns + kAhead_ns &&
         lead_ns - stream[i - 1].lead().ns > kAhead_ns + 5 * usual_ns;
}

// The next ones have about the same lead, and do not go back to what was before.
bool stays(const Reading& reading, std::span<const Receipt> stream, size_t i) {
  if (i + kAgree > stream.size()) return false;
  const int64_t lead_ns = stream[i].lead().ns, by_ns = lead_ns - reading.most_lead_ns;
  const auto agrees = [&](const Receipt& m) { return std::abs(m.lead().ns - lead_ns) < std::abs(by_ns) / 2; };
  return std::all_of(stream.begin() + static_cast<std::ptrdiff_t>(i + 1),
                     stream.begin() + static_cast<std::ptrdiff_t>(i + kAgree), agrees);
}

// Nearly the most: a few strays ahead do not count.
int64_t least_late_ns(std::span<const Receipt> messages) {
  std::vector<int64_t> leads;
  for (const Receipt& m : messages) leads.push_back(m.lead().ns);
  const auto at = leads.begin() + static_cast<std::ptrdiff_t>((leads.size() - 1) * 9 / 10);
  std::nth_element(leads.begin(), at, leads.end());
  return *at;
}

// From the messages of [begin, end) that are nearest to `message`, as many before as after.
Duration step_within(std::span<const Receipt> stream, size_t begin, size_t message, size_t end) {
  const size_t beside = std::min({kBeside, message - begin, end - message});
  if (beside == 0) return {};
  return {least_late_ns(stream.subspan(message, beside)) -
          least_late_ns(stream.subspan(message - beside, beside))};
}

}  // namespace

bool receipts_tell(std::span<const Receipt> stream) {
  if (stream.size() < kFewest) return false;
  int64_t recorded_ns = 0, stamped_ns = 0;
  const auto of_it = [](Duration d) { return std::clamp<int64_t>(d.ns, 0, kLongPause_ns); };
  for (size_t i = 1; i < stream.size(); ++i) {
    recorded_ns += of_it(stream[i].recorded - stream[i - 1].recorded);
    stamped_ns += of_it(stream[i].end - stream[i - 1].end);
  }
  return recorded_ns > 0 && stamped_ns > 0 && recorded_ns / 2 <= stamped_ns && stamped_ns / 2 <= recorded_ns;
}

std::vector<StampStep> find_steps(std::span<const Receipt> stream) {
  if (!receipts_tell(stream)) return {};
  const int64_t usual_ns = usual_interval_ns(stream);
  std::vector<size_t> set = {0};
  Reading reading(stream, 0);
  for (size_t i = 1; i < stream.size(); ++i) {
    if (!leaves(reading, stream, i, usual_ns)) {
      reading.add(stream[i]);
    } else if (stays(reading, stream, i)) {
      // A few at the beginning that lie elsewhere are strays.
      if (i - reading.first < kAgree) set.pop_back();
      set.push_back(i);
      reading = Reading(stream, i);
    }
  }
  std::vector<StampStep> steps;
  set.push_back(stream.size());
  for (size_t k = 1; k + 1 < set.size(); ++k)
    steps.push_back({set[k], stream[set[k]].recorded, step_within(stream, set[k - 1], set[k], set[k + 1])});
  return steps;
}

std::vector<StampStep> find_step_like(std::span<const Receipt> stream, const StampStep& other) {
  if (!receipts_tell(stream)) return {};
  size_t at = 0;
  int64_t most_ns = 0;
  for (size_t i = 1; i < stream.size(); ++i) {
    if (stream[i].recorded < other.recorded - kAbout || stream[i].recorded > other.recorded + kAbout)
      continue;
    const int64_t change_ns = std::abs((stream[i].lead() - stream[i - 1].lead()).ns);
    if (change_ns > most_ns) most_ns = change_ns, at = i;
  }
  if (at == 0) return {};
  const StampStep found{at, stream[at].recorded, step_within(stream, 0, at, stream.size())};
  const int64_t apart_ns = std::abs((found.by - other.by).ns);
  if (apart_ns > kBack_ns / 2 || apart_ns > std::abs(other.by.ns) / 3) return {};
  return {found};
}

}  // namespace vsslam

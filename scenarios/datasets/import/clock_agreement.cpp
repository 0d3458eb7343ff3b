#include "scenarios/datasets/import/clock_agreement.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdlib>
#include <optional>
#include <tuple>

#include "core/errors.h"

namespace vsslam {

namespace {

constexpr int64_t kMs = 1'000'000, kSecond = 1'000 * kMs;
constexpr int64_t kLongestDelay_ns = 10 * kSecond, kSame_ns = 500 * kMs, kFuture_ns = 100 * kMs;
constexpr int64_t kLongestWindow_ns = 3600 * kSecond;

std::string seconds(Duration d) {
  return fmt::format("{:.3f} s", d.seconds());
}

int64_t quantile(std::vector<int64_t> values, double share) {
  const auto at =
      values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1) + 0.5);
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

// --- Clocks that are set ---

struct StreamSteps {
  ReceivedStream* stream;
  std::vector<StampStep> steps;
};

bool together(const StampStep& a, const StampStep& b) {
  return std::abs((a.recorded - b.recorded).ns) <= 2 * kSecond && std::abs((a.by - b.by).ns) <= 50 * kMs;
}

bool has_step_near(const StreamSteps& streams, const StampStep& step) {
  return std::any_of(streams.steps.begin(), streams.steps.end(), [&](const StampStep& own) {
    return std::abs((own.recorded - step.recorded).ns) <= 2 * kSecond;
  });
}

// What one stream shows clearly another may show faintly.
void find_shared_steps(std::vector<StreamSteps>& all) {
  const std::vector<StreamSteps> clear = all;
  for (const StreamSteps& from : clear)
    for (const StampStep& step : from.steps)
      for (StreamSteps& to : all)
        if (!has_step_near(to, step))
          for (const StampStep& like : find_step_like(to.stream->messages, step)) to.steps.push_back(like);
  for (StreamSteps& streams : all)
    std::sort(streams.steps.begin(), streams.steps.end(),
              [](const StampStep& a, const StampStep& b) { return a.message < b.message; });
}

// One clock, one step: that of the stream with the most messages.
void agree_on_steps(std::vector<StreamSteps>& all) {
  std::vector<const StreamSteps*> by_size;
  const std::vector<StreamSteps> measured = all;
  for (const StreamSteps& streams : measured) by_size.push_back(&streams);
  std::stable_sort(by_size.begin(), by_size.end(), [](const auto* a, const auto* b) {
    return a->stream->messages.size() > b->stream->messages.size();
  });
  for (StreamSteps& streams : all)
    for (StampStep& step : streams.steps) {
      const StampStep own = step;
      for (const StreamSteps* other : by_size) {
        const auto same = std::find_if(other->steps.begin(), other->steps.end(),
                                       [&](const StampStep& s) { return together(s, own); });
        if (same == other->steps.end()) continue;
        step.by = same->by;
        break;
      }
    }
}

// The first of the clock's settings, or else the first that agrees with the recorder's clock, stays as it is.
std::vector<ClockShift> undone(const StreamSteps& streams) {
  const std::vector<Receipt>& messages = streams.stream->messages;
  std::vector<ClockShift> shifts = {{0, {}}};
  std::vector<int64_t> middle_lead_ns;
  for (size_t k = 0; k <= streams.steps.size(); ++k) {
    const size_t begin = k == 0 ? 0 : streams.steps[k - 1].message,
                 end = k == streams.steps.size() ? messages.size() : streams.steps[k].message;
    if (k > 0) shifts.push_back({begin, shifts.back().shift - streams.steps[k - 1].by});
    std::vector<int64_t> leads;
    for (size_t i = begin; i < end; ++i) leads.push_back(messages[i].lead().ns);
    middle_lead_ns.push_back(quantile(std::move(leads), 0.5));
  }
  const auto agrees = std::find_if(middle_lead_ns.begin(), middle_lead_ns.end(),
                                   [](int64_t ns) { return std::abs(ns) < kLongestDelay_ns; });
  if (agrees != middle_lead_ns.end()) {
    const Duration right = shifts[static_cast<size_t>(agrees - middle_lead_ns.begin())].shift;
    for (ClockShift& shift : shifts) shift.shift = shift.shift - right;
  }
  return shifts;
}

void shift_messages(ReceivedStream& stream, const std::vector<ClockShift>& shifts) {
  for (size_t k = 0; k < shifts.size(); ++k) {
    const size_t end = k + 1 < shifts.size() ? shifts[k + 1].from_message : stream.messages.size();
    for (size_t i = shifts[k].from_message; i < end; ++i)
      stream.messages[i].end = stream.messages[i].end + shifts[k].shift;
  }
}

void note_steps(const std::vector<StreamSteps>& all, ClockPlan& plan) {
  std::vector<std::pair<StampStep, std::vector<std::string>>> told;
  for (const StreamSteps& streams : all)
    for (const StampStep& step : streams.steps) {
      const auto same =
          std::find_if(told.begin(), told.end(), [&](const auto& t) { return together(t.first, step); });
      const std::string who = fmt::format("{} ({})", streams.stream->sensor, streams.stream->name);
      if (same == told.end()) {
        told.push_back({step, {who}});
      } else {
        same->second.push_back(who);
      }
    }
  for (const auto& [step, who] : told)
    plan.notes.push_back(fmt::format(
        "clock of {}: set {} by {} while recording, at {} by the recorder's clock: undone in the stamps",
        fmt::join(who, ", "), step.by.ns < 0 ? "back" : "ahead", seconds({std::abs(step.by.ns)}),
        seconds({step.recorded.ns})));
}

void undo_steps(std::vector<ReceivedStream>& streams, ClockPlan& plan) {
  std::vector<StreamSteps> all;
  for (ReceivedStream& stream : streams) all.push_back({&stream, find_steps(stream.messages)});
  find_shared_steps(all);
  agree_on_steps(all);
  for (const StreamSteps& stepped : all) {
    if (stepped.steps.empty()) continue;
    plan.shifts[stepped.stream->sensor] = undone(stepped);
    shift_messages(*stepped.stream, plan.shifts[stepped.stream->sensor]);
  }
  note_steps(all, plan);
}

// --- Clocks of their own ---

/// The most lead of a stream around a time of the recorder's clock.
class LeadOverTime {
 public:
  explicit LeadOverTime(const std::vector<Receipt>& messages) {
    for (const Receipt& m : messages) {
      const auto [at, is_new] = most_ns_.emplace(m.recorded.ns / kSecond, m.lead().ns);
      if (!is_new) at->second = std::max(at->second, m.lead().ns);
    }
  }
  /// Of the nearest second that has messages, and its neighbours.
  int64_t around(Time recorded) const {
    const int64_t second = recorded.ns / kSecond;
    auto at = most_ns_.lower_bound(second - 1);
    if (at == most_ns_.end()) return std::prev(at)->second;
    int64_t most = at->second;
    for (; at != most_ns_.end() && at->first <= second + 1; ++at) most = std::max(most, at->second);
    return most;
  }

 private:
  std::map<int64_t, int64_t> most_ns_;  // by second of the recorder's clock
};

struct Clock {
  ReceivedStream* stream;
  int64_t lead_ns;        ///< of those that arrive soonest
  int64_t over_first_ns;  ///< the same, over that of the first stream at the same time

  bool is_recorders() const { return lead_ns >= -kLongestDelay_ns && lead_ns <= kFuture_ns; }
};

std::vector<Clock> read_clocks(std::vector<ReceivedStream>& streams) {
  std::vector<Clock> clocks;
  std::optional<LeadOverTime> first;
  for (ReceivedStream& stream : streams) {
    if (!receipts_tell(stream.messages)) continue;
    if (!first) first.emplace(stream.messages);
    std::vector<int64_t> leads, over_first;
    for (const Receipt& m : stream.messages) {
      leads.push_back(m.lead().ns);
      over_first.push_back(m.lead().ns - first->around(m.recorded));
    }
    clocks.push_back({&stream, quantile(std::move(leads), 0.9), quantile(std::move(over_first), 0.9)});
  }
  if (!clocks.empty()) clocks.front().over_first_ns = 0;
  return clocks;
}

// A delay of some seconds that is there when the recording begins may as well be another clock.
bool begin_together_by_receipt_only(const ReceivedStream& a, const ReceivedStream& b, int64_t apart_ns) {
  const Receipt &first_a = a.messages.front(), &first_b = b.messages.front();
  return std::abs((first_a.recorded - first_b.recorded).ns) < kSame_ns &&
         std::abs((first_a.end - first_b.end).ns) > apart_ns / 2;
}

bool same_clock(const Clock& a, const Clock& b) {
  const int64_t apart_ns = std::abs(a.over_first_ns - b.over_first_ns);
  if (apart_ns <= kSame_ns) return a.is_recorders() == b.is_recorders() || apart_ns <= kFuture_ns;
  if (apart_ns > kLongestDelay_ns || a.is_recorders() != b.is_recorders()) return false;
  return apart_ns <= kSecond || !begin_together_by_receipt_only(*a.stream, *b.stream, apart_ns);
}

void move_to(const Clock& base, const std::vector<const Clock*>& others, ClockPlan& plan) {
  const Duration shift{base.over_first_ns - others.front()->over_first_ns};
  for (const Clock* clock : others) {
    std::vector<ClockShift>& shifts = plan.shifts[clock->stream->sensor];
    if (shifts.empty()) shifts.push_back({0, {}});
    for (ClockShift& s : shifts) s.shift = s.shift + shift;
    shift_messages(*clock->stream, {{0, shift}});
    plan.notes.push_back(
        fmt::format("clock of {} ({}): {} {} that of {} ({}), by when messages were recorded: its stamps are "
                    "moved by so much",
                    clock->stream->sensor, clock->stream->name, seconds({std::abs(shift.ns)}),
                    shift.ns < 0 ? "ahead of" : "behind", base.stream->sensor, base.stream->name));
  }
}

// The recorder's clock is kept, or else the first stream's.
void bring_together(std::vector<ReceivedStream>& streams, ClockPlan& plan) {
  const std::vector<Clock> clocks = read_clocks(streams);
  if (clocks.empty()) return;
  const auto good = std::find_if(clocks.begin(), clocks.end(), [](const Clock& c) {
    return c.stream->sensor != "truth" && c.is_recorders();
  });
  const Clock& base = good == clocks.end() ? clocks.front() : *good;
  std::vector<std::vector<const Clock*>> others;
  for (const Clock& clock : clocks) {
    if (same_clock(base, clock)) continue;
    const auto with = std::find_if(others.begin(), others.end(), [&](const auto& group) {
      return std::abs(group.front()->over_first_ns - clock.over_first_ns) <= kSame_ns;
    });
    if (with == others.end()) {
      others.push_back({&clock});
    } else {
      with->push_back(&clock);
    }
  }
  for (const auto& group : others) move_to(base, group, plan);
}

// --- What cannot be brought together ---

std::pair<Time, Time> range_of(const ReceivedStream& stream) {
  std::vector<int64_t> ends;
  for (const Receipt& m : stream.messages) ends.push_back(m.end.ns);
  return {Time{quantile(ends, 0.02)}, Time{quantile(ends, 0.98)}};
}

bool apart(std::pair<Time, Time> a, std::pair<Time, Time> b) {
  const Duration slack{kSecond};
  return a.second + slack < b.first || b.second + slack < a.first;
}

bool recorded_apart(const ReceivedStream& a, const ReceivedStream& b) {
  return apart({a.messages.front().recorded, a.messages.back().recorded},
               {b.messages.front().recorded, b.messages.back().recorded});
}

// A sensor may be off while another is on: then what was recorded says so, as long as the stamps are others than that.
bool was_off(const ReceivedStream& a, const ReceivedStream& b) {
  const auto copies = [](const ReceivedStream& s) {
    return std::all_of(s.messages.begin(), s.messages.end(),
                       [](const Receipt& m) { return std::abs(m.lead().ns) < kMs / 10; });
  };
  return receipts_tell(a.messages) && receipts_tell(b.messages) && recorded_apart(a, b) && !copies(a) &&
         !copies(b);
}

void check_that_they_meet(const std::vector<ReceivedStream>& streams, const std::string& file) {
  const auto lidar = std::find_if(streams.begin(), streams.end(),
                                  [](const ReceivedStream& s) { return s.sensor == "lidar"; });
  if (lidar == streams.end()) return;
  for (const ReceivedStream& stream : streams) {
    if (stream.sensor == "truth" || stream.sensor == "lidar" || stream.messages.size() < 2) continue;
    const auto of_lidar = range_of(*lidar), own = range_of(stream);
    if (!apart(of_lidar, own) || was_off(stream, *lidar)) continue;
    throw InputError(
        fmt::format("{}: the clocks of {} ({}: {:.3f} .. {:.3f} s) and lidar ({}: {:.3f} .. {:.3f} s) have "
                    "no time in common, and "
                    "when the messages were recorded does not tell how they belong together; without that "
                    "sensor: --topic {}=none",
                    file, stream.sensor, stream.name, own.first.seconds(), own.second.seconds(), lidar->name,
                    of_lidar.first.seconds(), of_lidar.second.seconds(), stream.sensor));
  }
}

// --- Late ones ---

Duration window_for(const std::vector<ReceivedStream>& streams, ClockPlan& plan) {
  std::vector<std::tuple<Time, size_t, Time, size_t>> order;  // recorded, place, end, stream
  std::vector<std::optional<int64_t>> usual_ns(streams.size());
  for (size_t s = 0; s < streams.size(); ++s) {
    if (streams[s].sensor == "truth" || streams[s].messages.empty()) continue;
    std::vector<int64_t> leads;
    for (const Receipt& m : streams[s].messages) {
      order.emplace_back(m.recorded, m.place, m.end, s);
      leads.push_back(m.lead().ns);
    }
    if (receipts_tell(streams[s].messages)) usual_ns[s] = quantile(std::move(leads), 0.5);
  }
  std::sort(order.begin(), order.end());
  std::vector<int64_t> latest_ns(streams.size());
  std::optional<Time> newest;
  for (const auto& [recorded, place, end, s] : order) {
    const bool stray = usual_ns[s] && std::abs((end - recorded).ns - *usual_ns[s]) > kLongestDelay_ns;
    if (stray) continue;
    newest = newest ? std::max(*newest, end) : end;
    latest_ns[s] = std::max(latest_ns[s], (*newest - end).ns);
  }
  int64_t most_ns = 0;
  for (size_t s = 0; s < streams.size(); ++s) {
    most_ns = std::max(most_ns, latest_ns[s]);
    if (latest_ns[s] > kSecond)
      plan.notes.push_back(fmt::format("{} ({}): arrives up to {} after others of its time: waited for",
                                       streams[s].sensor, streams[s].name, seconds({latest_ns[s]})));
  }
  return {std::clamp(most_ns + kSecond / 4, kSecond, kLongestWindow_ns)};
}

}  // namespace

Duration ClockPlan::shift_of(const std::string& sensor, size_t message) const {
  const auto found = shifts.find(sensor);
  Duration shift;
  if (found == shifts.end()) return shift;
  for (const ClockShift& s : found->second)
    if (s.from_message <= message) shift = s.shift;
  return shift;
}

ClockPlan plan_clocks(std::vector<ReceivedStream> streams, const std::string& file) {
  std::erase_if(streams, [](const ReceivedStream& s) { return s.messages.empty(); });
  ClockPlan plan;
  undo_steps(streams, plan);
  bring_together(streams, plan);
  check_that_they_meet(streams, file);
  plan.window = window_for(streams, plan);
  return plan;
}

}  // namespace vsslam

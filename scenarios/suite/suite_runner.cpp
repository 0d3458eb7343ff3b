#include "scenarios/suite/suite_runner.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <string_view>
#include <tuple>

namespace vsslam {

SuiteRunner::SuiteRunner(const SuitePlan& plan, const SuiteRunOptions& options)
    : plan_(plan),
      options_(options),
      duration_s_(plan.scenarios.size(), 0.0),
      runs_of_(plan.scenarios.size(), 0) {
  std::map<std::pair<size_t, uint64_t>, std::vector<Method>> lacking;
  for (const PlannedRun& run : plan.runs()) {
    if (!options.fresh && stored_run(plan, run) == StoredRun::same) {
      ++kept_;
    } else {
      ++missing_;
      ++runs_of_[run.scenario];
      lacking[{run.scenario, run.seed}].push_back(run.method);
    }
  }
  for (const auto& [place, methods] : lacking) jobs_.push_back({place.first, place.second, methods});
}

// Scenarios that have not begun are taken to last as long as the others on average.
double SuiteRunner::expected_s() const {
  double known_s = 0, sum_s = 0;
  int known = 0;
  for (const double duration_s : duration_s_) known_s += duration_s, known += duration_s > 0;
  for (size_t i = 0; i < duration_s_.size(); ++i)
    sum_s += runs_of_[i] * (duration_s_[i] > 0 || known == 0 ? duration_s_[i] : known_s / known);
  return sum_s;
}

RunEvents SuiteRunner::events(const Job& job, ProgressState& state, Progress& progress) {
  const auto name = [this, scenario = job.scenario](std::string_view method, uint64_t seed) {
    return fmt::format("{} {} seed {}", plan_.scenarios[scenario].name, method, seed);
  };
  return {.on_finished =
              [this, name, &state, &progress](const FinishedRun& run) {
                ++made_, ++state.finished_runs;
                if (!run.metrics.failure.empty())
                  progress.note(name(run.metrics.method, run.seed) + ": " + run.metrics.failure);
              },
          .on_progress =
              [&state, &progress](double simulated_s, int64_t scans) {
                state.done_s += simulated_s;
                state.scans += scans;
                progress.update(state);
              },
          .on_expected =
              [this, scenario = job.scenario, &state](double duration_s) {
                duration_s_[scenario] = duration_s;
                state.expected_s = expected_s();
              },
          .on_failed =
              [this, name, scenario = job.scenario, seed = job.seed, &state, &progress](
                  Method method, const std::string& why) {
                ++state.finished_runs;
                failures_.push_back({scenario, method, seed, why});
                progress.note(name(method_name(method), seed) + " failed: " + why);
              }};
}

void SuiteRunner::run(const std::atomic<bool>& stop, Progress& progress) {
  ProgressState state;
  state.runs = missing_;
  std::vector<std::unique_ptr<Pipeline>> pipelines;
  std::shared_ptr<ScenarioWorld> place;  // kept by the runs alone, so that the last of them frees it
  for (size_t i = 0; i < jobs_.size(); ++i) {
    if (i == 0 || jobs_[i].scenario != jobs_[i - 1].scenario)
      place = std::make_shared<ScenarioWorld>(plan_.scenarios[jobs_[i].scenario]);
    add_seed_runs(place, plan_.folder, jobs_[i].methods, jobs_[i].seed, events(jobs_[i], state, progress),
                  pipelines);
  }
  place.reset();
  run_pipelines(std::move(pipelines), options_.threads, stop);
  std::sort(failures_.begin(), failures_.end(), [](const SuiteFailure& a, const SuiteFailure& b) {
    return std::tie(a.scenario, a.method, a.seed) < std::tie(b.scenario, b.method, b.seed);
  });
}

}  // namespace vsslam

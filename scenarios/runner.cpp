#include "scenarios/runner.h"

#include <algorithm>

#include "scenarios/pending_folder.h"
#include "scenarios/simulated_drive.h"

namespace vsslam {

bool FinishedRun::as_expected() const {
  return metrics.failure.empty() && std::all_of(metrics.expectations.begin(), metrics.expectations.end(),
                                                [](const ExpectationResult& e) { return e.pass; });
}

struct Runner::Impl {
  std::shared_ptr<ScenarioWorld> place;
  RunOptions options;
  std::vector<Method> methods;
  std::vector<FinishedRun> finished;

  RunEvents events(Progress& progress, ProgressState& state);
};

Runner::Runner(const Scenario& scenario, const RunOptions& options) : impl_(std::make_unique<Impl>()) {
  impl_->place = std::make_shared<ScenarioWorld>(scenario);
  impl_->options = options;
  impl_->methods = resolve_methods(scenario.methods);
  impl_->place->world();
}

Runner::~Runner() = default;

RunEvents Runner::Impl::events(Progress& progress, ProgressState& state) {
  return {.on_finished =
              [this, &progress, &state](FinishedRun run) {
                ++state.finished_runs;
                if (!run.metrics.failure.empty()) progress.note(run.metrics.failure);
                finished.push_back(std::move(run));
              },
          .on_progress =
              [&progress, &state](double simulated_s, int64_t scans) {
                state.done_s += simulated_s;
                state.scans += scans;
                progress.update(state);
              },
          .on_expected =
              [&state](double expected_s) {
                // Runs that have not begun yet will take as long.
                if (state.expected_s == 0) state.expected_s = expected_s * state.runs;
              },
          .on_failed = {}};
}

void Runner::run(const std::atomic<bool>& stop, Progress& progress) {
  ProgressState state;
  const std::vector<uint64_t>& seeds = impl_->place->scenario().seeds;
  state.runs = static_cast<int>(impl_->methods.size() * seeds.size());
  const RunEvents events = impl_->events(progress, state);
  std::vector<std::unique_ptr<Pipeline>> pipelines;
  for (const uint64_t seed : seeds) 
    add_seed_runs(impl_->place, impl_->options.out, impl_->methods, seed, events, pipelines);
  const auto link = [this] {
    if (!impl_->finished.empty()) link_latest(impl_->options.out, finished().back().folder);
  };
  try {
    run_pipelines(std::move(pipelines), impl_->options.threads, stop);
  } catch (...) {
    link();
    throw;
  }
  link();
}

std::vector<FinishedRun> Runner::finished() const {
  std::vector<FinishedRun> sorted = impl_->finished;
  const auto place = [this](Method m) {
    return std::find(impl_->methods.begin(), impl_->methods.end(), m) - impl_->methods.begin();
  };
  std::sort(sorted.begin(), sorted.end(), [&](const FinishedRun& a, const FinishedRun& b) {
    return std::pair(place(a.method), a.seed) < std::pair(place(b.method), b.seed);
  });
  return sorted;
}

}  // namespace vsslam

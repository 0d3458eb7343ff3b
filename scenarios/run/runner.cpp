#include "scenarios/run/runner.h"

#include <algorithm>

#include "scenarios/run/pending_folder.h"
#include "scenarios/run/simulated_drive.h"

namespace vsslam {

bool FinishedRun::as_expected() const {
  return metrics.failure.empty() && metrics.health.worthless.empty() &&
         std::all_of(metrics.expectations.begin(), metrics.expectations.end(),
                     [](const ExpectationResult& e) { return e.pass; });
}

struct Runner::Impl {
  using Pipelines = std::vector<std::unique_ptr<Pipeline>>;

  RunOptions options;
  std::vector<Method> methods;
  int runs = 0;
  std::function<void(const RunEvents&, Pipelines&)> add_pipelines;
  std::vector<FinishedRun> finished;

  RunEvents events(Progress& progress, ProgressState& state);
};

Runner::Runner(const Scenario& scenario, const RunOptions& options) : impl_(std::make_unique<Impl>()) {
  const auto place = std::make_shared<ScenarioWorld>(scenario);
  impl_->options = options;
  impl_->methods = resolve_methods(scenario.methods);
  impl_->runs = static_cast<int>(impl_->methods.size() * scenario.seeds.size());
  impl_->add_pipelines = [this, place](const RunEvents& events, Impl::Pipelines& pipelines) {
    for (const uint64_t seed : place->scenario().seeds)
      add_seed_runs(place, impl_->options.out, impl_->methods, seed, events, pipelines);
  };
  place->world();
}

Runner::Runner(std::unique_ptr<MeasurementSource> source, const std::vector<Method>& methods,
               const RunOptions& options)
    : impl_(std::make_unique<Impl>()) {
  impl_->options = options;
  impl_->methods = methods;
  impl_->runs = static_cast<int>(methods.size());
  const auto shared = std::make_shared<std::unique_ptr<MeasurementSource>>(std::move(source));
  impl_->add_pipelines = [this, shared](const RunEvents& events, Impl::Pipelines& pipelines) {
    pipelines.push_back(std::make_unique<EstimationRun>(std::move(*shared), impl_->methods, events));
  };
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
  state.runs = impl_->runs;
  const RunEvents events = impl_->events(progress, state);
  Impl::Pipelines pipelines;
  impl_->add_pipelines(events, pipelines);
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

#include "scenarios/runner.h"

#include <algorithm>
#include <mutex>

#include "scenarios/pending_folder.h"
#include "scenarios/seed_run.h"

namespace vsslam {

bool FinishedRun::as_expected() const {
  return failure.empty() && std::all_of(metrics.expectations.begin(), metrics.expectations.end(),
                                        [](const ExpectationResult& e) { return e.pass; });
}

struct Runner::Impl {
  Scenario scenario;
  RunOptions options;
  std::vector<Method> methods;
  World world;
  std::once_flag surface_once;
  std::unique_ptr<SurfaceDistance> surface;
  std::vector<FinishedRun> finished;

  const SurfaceDistance& surface_distance() {
    std::call_once(surface_once, [this] { surface = std::make_unique<SurfaceDistance>(world); });
    return *surface;
  }
  RunContext context(Progress& progress, ProgressState& state);
  std::vector<std::unique_ptr<Pipeline>> pipelines(const RunContext& context) const;
};

Runner::Runner(const Scenario& scenario, const RunOptions& options) : impl_(std::make_unique<Impl>()) {
  impl_->scenario = scenario;
  impl_->options = options;
  impl_->methods = resolve_methods(scenario.methods);
  impl_->world = make_world(scenario.world);
}

Runner::~Runner() = default;

RunContext Runner::Impl::context(Progress& progress, ProgressState& state) {
  return {.scenario = scenario,
          .world = world,
          .options = options,
          .surface = [this]() -> const SurfaceDistance& { return surface_distance(); },
          .on_finished =
              [this, &progress, &state](FinishedRun run) {
                ++state.finished_runs;
                if (!run.failure.empty()) progress.note(run.failure);
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
              }};
}

std::vector<std::unique_ptr<Pipeline>> Runner::Impl::pipelines(const RunContext& context) const {
  std::vector<std::unique_ptr<Pipeline>> runs;
  for (const uint64_t seed : scenario.seeds) {
    if (scenario.closed_loop) {
      for (const Method method : methods)
        runs.push_back(std::make_unique<SeedRun>(context, std::vector{method}, seed));
    } else {
      runs.push_back(std::make_unique<SeedRun>(context, methods, seed));
    }
  }
  return runs;
}

void Runner::run(const std::atomic<bool>& stop, Progress& progress) {
  ProgressState state;
  state.runs = static_cast<int>(impl_->methods.size() * impl_->scenario.seeds.size());
  const RunContext context = impl_->context(progress, state);
  const auto link = [this] {
    if (!impl_->finished.empty()) link_latest(impl_->options.out, finished().back().folder);
  };
  try {
    run_pipelines(impl_->pipelines(context), impl_->options.threads, stop);
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

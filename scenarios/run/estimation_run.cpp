#include "scenarios/run/estimation_run.h"

#include <algorithm>
#include <new>
#include <utility>

#include "core/errors.h"
#include "scenarios/report/report.h"
#include "scenarios/results/results.h"
#include "scenarios/run/pending_folder.h"

namespace vsslam {

namespace {

// It bounds the memory: so many chunks that a method has yet to map.
constexpr size_t kQueueChunks = 16;

}  // namespace

EstimationRun::EstimationRun(std::unique_ptr<MeasurementSource> source, const std::vector<Method>& methods,
                             RunEvents events)
    : source_(std::move(source)), events_(std::move(events)) {
  for (const Method method : methods) {
    lanes_.push_back(std::make_unique<Lane>());
    lanes_.back()->method = method;
  }
}

bool EstimationRun::finished() const {
  return running_ == 0 &&
         std::all_of(lanes_.begin(), lanes_.end(), [](const auto& lane) { return lane->ended; });
}

Step EstimationRun::claim() {
  Step step = next_step();
  if (!step) return {};
  ++running_;
  const auto commit = std::move(step.commit);
  step.commit = [this, commit] {
    --running_;
    commit();
    if (!broken_) return;
    for (const auto& lane : lanes_)
      if (!lane->busy && !lane->ended) fail(*lane, *broken_);
  };
  return step;
}

Step EstimationRun::next_step() {
  if (broken_ || opening_) return {};
  if (!opened_) return contained(open(), nullptr);
  Lane* fullest = nullptr;
  bool open_lanes = false;
  for (const auto& lane : lanes_) {
    open_lanes |= !lane->ended;
    if (lane->busy || lane->ended) continue;
    if (lane->queue.empty() && judged_) return contained(write(*lane), lane.get());
    if (!lane->queue.empty() && (fullest == nullptr || lane->queue.size() > fullest->queue.size()))
      fullest = lane.get();
  }
  if (fullest != nullptr) return contained(map(*fullest), fullest);
  if (!open_lanes || judged_) return {};
  if (all_located()) return judging_ ? Step{} : contained(judge(), nullptr);
  if (may_locate()) return contained(locate(), nullptr);
  Step step = source_->claim(*this);
  return step ? contained(std::move(step), nullptr) : Step{};
}

// What the step throws ends the run of its lane, or of all lanes, not the whole program.
Step EstimationRun::contained(Step step, Lane* lane) {
  if (!events_.on_failed) return step;
  const auto why = std::make_shared<std::optional<std::string>>();
  return {.work =
              [work = std::move(step.work), why] {
                try {
                  work();
                } catch (const ResourceError&) {
                  throw;
                } catch (const std::bad_alloc&) {
                  throw;
                } catch (const std::exception& e) {
                  *why = e.what();
                }
              },
          .commit =
              [this, commit = std::move(step.commit), why, lane] {
                if (!*why) return commit();
                if (lane == nullptr) {
                  broken_ = why->value();
                } else {
                  fail(*lane, why->value());
                }
              }};
}

void EstimationRun::fail(Lane& lane, const std::string& why) {
  lane.estimation.reset();
  lane.queue.clear();
  lane.busy = false;
  lane.ended = true;
  events_.on_failed(lane.method, why);
}

Step EstimationRun::open() {
  opening_ = true;
  return {.work =
              [this] {
                start_ns_ = odometry_clock_.now_ns();
                source_->open();
                for (const auto& lane : lanes_)
                  lane->estimation =
                      std::make_unique<MappingRun>(source_->setup(), lane->method, &lane->clock);
                odometry_ = std::make_unique<OdometryRun>(source_->setup(), &odometry_clock_);
              },
          .commit =
              [this] {
                opening_ = false;
                opened_ = true;
                events_.on_expected(source_->expected_duration_s());
              }};
}

bool EstimationRun::may_locate() const {
  if (odometry_busy_ || source_->chunks().empty()) return false;
  return std::all_of(lanes_.begin(), lanes_.end(),
                     [&](const auto& lane) { return lane->ended || lane->queue.size() < kQueueChunks; });
}

bool EstimationRun::all_located() const {
  return source_->ended() && source_->chunks().empty() && !odometry_busy_;
}

bool EstimationRun::known(Time due) const {
  return std::all_of(lanes_.begin(), lanes_.end(), [&](const auto& lane) { return lane->consumed >= due; });
}

std::optional<Belief> EstimationRun::newest(Time due) {
  std::deque<Belief>& beliefs = lanes_.front()->beliefs;
  const auto usable = [&](const Belief& b) { return b.available <= due; };
  while (beliefs.size() > 1 && usable(beliefs[1])) beliefs.pop_front();
  return !beliefs.empty() && usable(beliefs.front()) ? std::optional(beliefs.front()) : std::nullopt;
}

Step EstimationRun::locate() {
  odometry_busy_ = true;
  auto located = std::make_shared<OdometryChunk>();
  return {.work = [this, located, chunk = source_->chunks().front()] { *located = odometry_->add(chunk); },
          .commit =
              [this, located] {
                for (const auto& lane : lanes_)
                  if (!lane->ended) lane->queue.push_back(located);
                source_->chunks().pop_front();
                odometry_busy_ = false;
              }};
}

Step EstimationRun::map(Lane& lane) {
  lane.busy = true;
  const std::shared_ptr<const OdometryChunk> located = lane.queue.front();
  auto beliefs = std::make_shared<std::vector<Belief>>();
  return {.work = [&lane, located, beliefs] { *beliefs = lane.estimation->add(*located); },
          .commit =
              [this, &lane, located, beliefs] {
                lane.queue.pop_front();
                if (source_->drives_on_beliefs())
                  lane.beliefs.insert(lane.beliefs.end(), beliefs->begin(), beliefs->end());
                const Time until = located->chunk->until;
                events_.on_progress((until - lane.consumed).seconds(), static_cast<int64_t>(beliefs->size()));
                lane.consumed = until;
                lane.busy = false;
              }};
}

Step EstimationRun::judge() {
  judging_ = true;
  return {.work =
              [this] {
                const StageTimer timer(&odometry_clock_, "judge");
                source_->judge(*odometry_);
              },
          .commit =
              [this] {
                judging_ = false;
                judged_ = true;
              }};
}

Step EstimationRun::write(Lane& lane) {
  lane.busy = true;
  auto result = std::make_shared<FinishedRun>();
  return {.work = [this, &lane, result] { *result = write_result(lane); },
          .commit =
              [this, &lane, result] {
                events_.on_finished(std::move(*result));
                lane.estimation.reset();
                lane.busy = false;
                lane.ended = true;
              }};
}

FinishedRun EstimationRun::write_result(Lane& lane) {
  lane.estimation->finish();
  FinishedRun run{.method = lane.method};
  run.folder = source_->result_folder(lane.method);
  PendingFolder folder(run.folder);
  {
    StageTimer timer(&lane.clock, "score_and_write");
    RunRecord record = source_->record(*lane.estimation);
    record.health = odometry_->health(record.source_health);
    run.seed = record.seed.value_or(0);
    run.metrics = score_run(record);
    write_results(folder.path(), record, run.metrics);
  }
  WallClock clock = lane.clock;
  clock.add(odometry_clock_);
  source_->add_times(clock);
  const double wall_s = static_cast<double>(clock.now_ns() - start_ns_) * 1e-9;
  run.real_time_factor = run.metrics.duration_s / wall_s;
  write_timing(folder.path(),
               {.wall_s = wall_s, .real_time_factor = run.real_time_factor, .made_by = source_->made_by()},
               clock);
  write_report(folder.path());
  folder.commit();
  return run;
}

}  // namespace vsslam

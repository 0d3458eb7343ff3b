#include "scenarios/seed_run.h"

#include <algorithm>
#include <new>
#include <utility>

#include "core/errors.h"
#include "scenarios/fingerprint.h"
#include "scenarios/pending_folder.h"
#include "scenarios/report/report.h"
#include "scenarios/results.h"

namespace vsslam {

namespace {

// They bound the memory: so many stretches of 0.1 s.
constexpr size_t kQueueScans = 16, kQueueChunks = 4, kQueueMotions = 4;

}  // namespace

SeedRun::SeedRun(RunContext context, const std::vector<Method>& methods, uint64_t seed)
    : context_(std::move(context)), seed_(seed) {
  for (const Method method : methods) {
    lanes_.push_back(std::make_unique<Lane>());
    lanes_.back()->method = method;
  }
}

bool SeedRun::finished() const {
  return running_ == 0 &&
         std::all_of(lanes_.begin(), lanes_.end(), [](const auto& lane) { return lane->ended; });
}

Step SeedRun::claim() {
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

Step SeedRun::next_step() {
  if (broken_ || opening_) return {};
  if (!sensing_) return contained(open(), nullptr);
  Lane* fullest = nullptr;
  bool open_lanes = false;
  for (const auto& lane : lanes_) {
    open_lanes |= !lane->ended;
    if (lane->busy || lane->ended) continue;
    if (lane->queue.empty() && facts_) return contained(write(*lane), lane.get());
    if (!lane->queue.empty() && (fullest == nullptr || lane->queue.size() > fullest->queue.size()))
      fullest = lane.get();
  }
  if (fullest != nullptr) return contained(map(*fullest), fullest);
  if (!open_lanes || facts_) return {};
  if (all_located()) return judging_ ? Step{} : contained(judge(), nullptr);
  if (may_locate()) return contained(locate(), nullptr);
  if (may_sense()) return contained(sense(), nullptr);
  if (may_drive()) return contained(drive(), nullptr);
  return {};
}

// What the step throws ends the run of its lane, or of all lanes of the seed, not the whole program.
Step SeedRun::contained(Step step, Lane* lane) {
  if (!context_.on_failed) return step;
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

void SeedRun::fail(Lane& lane, const std::string& why) {
  lane.estimation.reset();
  lane.queue.clear();
  lane.busy = false;
  lane.ended = true;
  context_.on_failed(lane.method, seed_, why);
}

Step SeedRun::open() {
  opening_ = true;
  struct Made {
    std::unique_ptr<Driving> driving;
    std::unique_ptr<Sensing> sensing;
    std::unique_ptr<OdometryRun> odometry;
  };
  auto made = std::make_shared<Made>();
  return {.work =
              [this, made] {
                start_ns_ = sensing_clock_.now_ns();
                for (const auto& lane : lanes_)
                  lane->estimation = std::make_unique<MappingRun>(scenario(), lane->method, &lane->clock);
                made->odometry = std::make_unique<OdometryRun>(scenario(), &odometry_clock_);
                made->driving =
                    std::make_unique<Driving>(scenario(), context_.place->world(), &driving_clock_);
                made->sensing =
                    std::make_unique<Sensing>(scenario(), context_.place->world(), seed_, &sensing_clock_);
              },
          .commit =
              [this, made] {
                driving_ = std::move(made->driving);
                sensing_ = std::move(made->sensing);
                odometry_ = std::move(made->odometry);
                opening_ = false;
                context_.on_expected(driving_->expected_duration_s());
              }};
}

// Estimates older than the latency must have been made before the robot drives on.
Time SeedRun::belief_due() const {
  return driving_->until() - Duration::from_seconds(scenario().closed_loop_latency_s);
}

bool SeedRun::may_drive() const {
  if (driving_busy_ || driving_->ended() || motions_.size() >= kQueueMotions) return false;
  return !scenario().closed_loop || std::all_of(lanes_.begin(), lanes_.end(), [&](const auto& lane) {
    return lane->consumed >= belief_due();
  });
}

bool SeedRun::may_sense() const {
  return !sensing_busy_ && !motions_.empty() && chunks_.size() < kQueueChunks;
}

bool SeedRun::may_locate() const {
  if (odometry_busy_ || chunks_.empty()) return false;
  return std::all_of(lanes_.begin(), lanes_.end(),
                     [&](const auto& lane) { return lane->ended || lane->queue.size() < kQueueScans; });
}

bool SeedRun::all_located() const {
  // While a step of the driving runs, what it changes is not to be read.
  return !driving_busy_ && driving_->ended() && motions_.empty() && !sensing_busy_ && chunks_.empty() &&
         !odometry_busy_;
}

std::optional<Belief> SeedRun::belief() {
  if (!scenario().closed_loop) return std::nullopt;
  std::deque<Belief>& beliefs = lanes_.front()->beliefs;
  const auto usable = [&](const Belief& b) { return b.available <= belief_due(); };
  while (beliefs.size() > 1 && usable(beliefs[1])) beliefs.pop_front();
  return !beliefs.empty() && usable(beliefs.front()) ? std::optional(beliefs.front()) : std::nullopt;
}

Step SeedRun::drive() {
  driving_busy_ = true;
  auto motion = std::make_shared<std::shared_ptr<const Motion>>();
  return {.work =
              [this, motion, belief = belief(), from = needed_from_] {
                *motion = std::make_shared<const Motion>(driving_->next(belief, from));
              },
          .commit =
              [this, motion] {
                motions_.push_back(*motion);
                driving_busy_ = false;
              }};
}

Step SeedRun::sense() {
  sensing_busy_ = true;
  auto chunk = std::make_shared<Chunk>();
  return {.work = [this, chunk, motion = motions_.front()] { *chunk = sensing_->next(*motion); },
          .commit =
              [this, chunk] {
                chunks_.push_back(chunk);
                needed_from_ = std::min(sensing_->needed_from(), chunk->until);
                motions_.pop_front();
                sensing_busy_ = false;
              }};
}

Step SeedRun::locate() {
  odometry_busy_ = true;
  auto located = std::make_shared<OdometryChunk>();
  return {.work = [this, located, chunk = chunks_.front()] { *located = odometry_->add(chunk); },
          .commit =
              [this, located] {
                for (const auto& lane : lanes_)
                  if (!lane->ended) lane->queue.push_back(located);
                chunks_.pop_front();
                odometry_busy_ = false;
              }};
}

Step SeedRun::map(Lane& lane) {
  lane.busy = true;
  const std::shared_ptr<const OdometryChunk> located = lane.queue.front();
  auto beliefs = std::make_shared<std::vector<Belief>>();
  return {.work = [&lane, located, beliefs] { *beliefs = lane.estimation->add(*located); },
          .commit =
              [this, &lane, located, beliefs] {
                lane.queue.pop_front();
                if (scenario().closed_loop)
                  lane.beliefs.insert(lane.beliefs.end(), beliefs->begin(), beliefs->end());
                const Time until = located->chunk->until;
                context_.on_progress((until - lane.consumed).seconds(),
                                     static_cast<int64_t>(beliefs->size()));
                lane.consumed = until;
                lane.busy = false;
              }};
}

Step SeedRun::judge() {
  judging_ = true;
  auto facts = std::make_shared<std::unique_ptr<SeedFacts>>();
  return {.work =
              [this, facts] {
                const StageTimer timer(&odometry_clock_, "judge");
                *facts = std::make_unique<SeedFacts>(
                    seed_facts(scenario(), context_.place->world(), sensing_->raycaster(), *odometry_));
              },
          .commit =
              [this, facts] {
                facts_ = std::move(*facts);
                judging_ = false;
              }};
}

Step SeedRun::write(Lane& lane) {
  lane.busy = true;
  auto result = std::make_shared<FinishedRun>();
  return {.work = [this, &lane, result] { *result = write_result(lane); },
          .commit =
              [this, &lane, result] {
                context_.on_finished(std::move(*result));
                lane.estimation.reset();
                lane.busy = false;
                lane.ended = true;
              }};
}

FinishedRun SeedRun::write_result(Lane& lane) {
  lane.estimation->finish();
  const DriveOutcome outcome = driving_->outcome();
  const bool ended_early = outcome == DriveOutcome::stuck || outcome == DriveOutcome::collided;
  const RunRecord record{.scenario = scenario(),
                         .facts = *facts_,
                         .surface = context_.place->surface(),
                         .estimation = *lane.estimation,
                         .seed = seed_,
                         .duration_s = driving_->until().seconds(),
                         .failure = ended_early ? driving_->outcome_text() : ""};
  FinishedRun run{.method = lane.method, .seed = seed_};
  run.folder = result_path(context_.options.out, scenario().name, lane.method, seed_);
  PendingFolder folder(run.folder);
  {
    StageTimer timer(&lane.clock, "score_and_write");
    const ScoredRun scored = score_run(record);
    write_results(folder.path(), record, scored);
    run.metrics = scored.metrics;
  }
  WallClock clock = lane.clock;
  clock.add(driving_clock_);
  clock.add(sensing_clock_);
  clock.add(odometry_clock_);
  const double wall_s = static_cast<double>(clock.now_ns() - start_ns_) * 1e-9;
  run.real_time_factor = record.duration_s / wall_s;
  write_timing(
      folder.path(),
      {.wall_s = wall_s, .real_time_factor = run.real_time_factor, .made_by = fingerprint(scenario())},
      clock);
  write_report(folder.path());
  folder.commit();
  return run;
}

void add_seed_runs(const RunContext& context, const std::vector<Method>& methods, uint64_t seed,
                   std::vector<std::unique_ptr<Pipeline>>& pipelines) {
  if (!context.place->scenario().closed_loop) {
    pipelines.push_back(std::make_unique<SeedRun>(context, methods, seed));
    return;
  }
  for (const Method method : methods)
    pipelines.push_back(std::make_unique<SeedRun>(context, std::vector{method}, seed));
}

}  // namespace vsslam

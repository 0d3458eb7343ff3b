#include "scenarios/run/simulated_drive.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "scenarios/experiment/fingerprint.h"
#include "scenarios/oracles/aliases.h"

namespace vsslam {

namespace {

// They bound the memory: so many stretches of 0.1 s.
constexpr size_t kQueueChunks = 4, kQueueMotions = 4;

}  // namespace

Scenario scenario_of_run(Scenario scenario, Method method, uint64_t seed) {
  scenario.methods = {std::string(method_name(method))};
  scenario.seeds = {seed};
  return scenario;
}

std::filesystem::path result_path(const std::filesystem::path& out, const std::string& scenario,
                                  Method method, uint64_t seed) {
  return out / scenario / method_name(method) / fmt::format("seed_{}", seed);
}

SimulatedDrive::SimulatedDrive(std::shared_ptr<ScenarioWorld> place, uint64_t seed, std::filesystem::path out)
    : place_(std::move(place)),
      seed_(seed),
      out_(std::move(out)),
      setup_{scenario().slam, calibration_of(scenario()), scenario().map_voxel_m} {}

void SimulatedDrive::open() {
  driving_ = std::make_unique<Driving>(scenario(), place_->world(), &driving_clock_);
  sensing_ = std::make_unique<Sensing>(scenario(), place_->world(), seed_, &sensing_clock_);
}

Step SimulatedDrive::claim(Beliefs& beliefs) {
  if (!sensing_busy_ && !motions_.empty() && chunks().size() < kQueueChunks) return sense();
  if (may_drive(beliefs)) return drive(beliefs);
  return {};
}

// While a step of the driving runs, what it changes is not to be read.
bool SimulatedDrive::ended() const {
  return !driving_busy_ && driving_->ended() && motions_.empty() && !sensing_busy_;
}

// Estimates older than the latency must have been made before the robot drives on.
Time SimulatedDrive::belief_due() const {
  return driving_->until() - Duration::from_seconds(scenario().closed_loop_latency_s);
}

bool SimulatedDrive::may_drive(const Beliefs& beliefs) const {
  if (driving_busy_ || driving_->ended() || motions_.size() >= kQueueMotions) return false;
  return !scenario().closed_loop || beliefs.known(belief_due());
}

Step SimulatedDrive::drive(Beliefs& beliefs) {
  driving_busy_ = true;
  const std::optional<Belief> belief =
      scenario().closed_loop ? beliefs.newest(belief_due()) : std::nullopt;
  auto motion = std::make_shared<std::shared_ptr<const Motion>>();
  return {.work =
              [this, motion, belief, from = needed_from_] {
                *motion = std::make_shared<const Motion>(driving_->next(belief, from));
              },
          .commit =
              [this, motion] {
                motions_.push_back(*motion);
                driving_busy_ = false;
              }};
}

Step SimulatedDrive::sense() {
  sensing_busy_ = true;
  auto chunk = std::make_shared<Chunk>();
  return {.work = [this, chunk, motion = motions_.front()] { *chunk = sensing_->next(*motion); },
          .commit =
              [this, chunk] {
                chunks().push_back(chunk);
                needed_from_ = std::min(sensing_->needed_from(), chunk->until);
                motions_.pop_front();
                sensing_busy_ = false;
              }};
}

// An alias is nearer than the threshold of `vs-slam`, whatever the method of the run: it tells of the world.
void SimulatedDrive::judge(const OdometryRun& odometry) {
  LoopOracle oracle(place_->world(), sensing_->raycaster(), odometry.key_scan_truth());
  const auto aliases =
      find_aliases(oracle, odometry.true_descriptors(), scenario().slam.loop.vs_slam.max_distance).size();
  facts_ = std::make_unique<Facts>(
      Facts{std::move(oracle), static_cast<int64_t>(aliases), odometry.pictures().png()});
}

RunRecord SimulatedDrive::record(const MappingRun& estimation) const {
  const DriveOutcome outcome = driving_->outcome();
  const bool ended_early = outcome == DriveOutcome::stuck || outcome == DriveOutcome::collided;
  const Method method = estimation.method();
  return {.name = scenario().name,
          .seed = seed_,
          .setup = setup_,
          .estimation = estimation,
          .truth = Truth::world,
          .truth_world_base = estimation.truth_world_base(),
          .surface = &place_->surface(),
          .loops = facts_->oracle.score(estimation.mapping().loops()),
          .aliases = facts_->aliases,
          .bounds = bounds_for(scenario().expect, std::string(method_name(method))),
          .camera_png = facts_->camera_png,
          .saved = {{"scenario.yaml", save_config(scenario_of_run(scenario(), method, seed_))}},
          .duration_s = driving_->until().seconds(),
          .failure = ended_early ? driving_->outcome_text() : ""};
}

std::filesystem::path SimulatedDrive::result_folder(Method method) const {
  return result_path(out_, scenario().name, method, seed_);
}

std::string SimulatedDrive::made_by() const {
  return fingerprint(scenario());
}

void SimulatedDrive::add_times(WallClock& clock) const {
  clock.add(driving_clock_);
  clock.add(sensing_clock_);
}

void add_seed_runs(std::shared_ptr<ScenarioWorld> place, const std::filesystem::path& out,
                   const std::vector<Method>& methods, uint64_t seed, const RunEvents& events,
                   std::vector<std::unique_ptr<Pipeline>>& pipelines) {
  const auto add = [&](const std::vector<Method>& together) {
    pipelines.push_back(std::make_unique<EstimationRun>(std::make_unique<SimulatedDrive>(place, seed, out),
                                                        together, events));
  };
  if (!place->scenario().closed_loop) return add(methods);
  for (const Method method : methods) add({method});
}

}  // namespace vsslam

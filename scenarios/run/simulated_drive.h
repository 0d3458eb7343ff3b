// Measurements of one seed of a scenario: the robot drives, its sensors measure.
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <vector>

#include "scenarios/experiment/scenario_world.h"
#include "scenarios/oracles/loop_truth.h"
#include "scenarios/run/estimation_run.h"
#include "scenarios/run/measurement_source.h"
#include "scenarios/stages/driving.h"
#include "scenarios/stages/sensing.h"

namespace vsslam {

class SimulatedDrive final : public MeasurementSource {
 public:
  SimulatedDrive(std::shared_ptr<ScenarioWorld> place, uint64_t seed, std::filesystem::path out);

  void open() override;
  const EstimatorSetup& setup() const override { return setup_; }
  double expected_duration_s() const override { return driving_->expected_duration_s(); }
  bool drives_on_beliefs() const override { return scenario().closed_loop; }
  Step claim(Beliefs& beliefs) override;
  bool ended() const override;
  void judge(const OdometryRun& odometry) override;
  RunRecord record(const MappingRun& estimation) const override;
  std::filesystem::path result_folder(Method method) const override;
  std::string made_by() const override;
  void add_times(WallClock& clock) const override;

 private:
  // Of the world and the seed, not of the method.
  struct Facts {
    LoopOracle oracle;
    int64_t aliases = 0;
    std::string camera_png;
  };

  const Scenario& scenario() const { return place_->scenario(); }
  Time belief_due() const;
  bool may_drive(const Beliefs& beliefs) const;
  Step drive(Beliefs& beliefs);
  Step sense();

  std::shared_ptr<ScenarioWorld> place_;
  uint64_t seed_;
  std::filesystem::path out_;
  EstimatorSetup setup_;
  WallClock driving_clock_, sensing_clock_;
  std::unique_ptr<Driving> driving_;
  std::unique_ptr<Sensing> sensing_;
  std::deque<std::shared_ptr<const Motion>> motions_;  // driven, not yet sensed
  Time needed_from_{0};
  bool driving_busy_ = false, sensing_busy_ = false;
  std::unique_ptr<Facts> facts_;
};

/// What is saved beside the result of one method and seed.
Scenario scenario_of_run(Scenario scenario, Method method, uint64_t seed);

/// <out>/<scenario>/<method>/seed_<n>
std::filesystem::path result_path(const std::filesystem::path& out, const std::string& scenario,
                                  Method method, uint64_t seed);

/// The pipelines of one seed: one for all methods, or in closed loop one for each.
void add_seed_runs(std::shared_ptr<ScenarioWorld> place, const std::filesystem::path& out,
                   const std::vector<Method>& methods, uint64_t seed, const RunEvents& events,
                   std::vector<std::unique_ptr<Pipeline>>& pipelines);

}  // namespace vsslam

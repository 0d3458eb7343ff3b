// The figures of a suite's runs, read back, and their means over seeds.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "scenarios/suite/suite_plan.h"
#include "scenarios/suite/suite_runner.h"

namespace vsslam {

/// Of some values: mean, sample standard deviation (n - 1; 0 for a single value), extremes.
struct Spread {
  size_t count = 0;
  double mean = 0, deviation = 0, low = 0, high = 0;
};
/// Summed in order. nullopt without values.
std::optional<Spread> spread_of(std::span<const double> values);

/// What became of one run.
struct RunFigures {
  PlannedRun run;
  bool present = false;                            ///< there is a result
  std::string failure{};                           ///< why there is none, or why its drive ended early
  std::vector<std::optional<double>> values{};     ///< by metric_names(); empty without a result
  std::string worthless{};                         ///< why the result is worth nothing; empty: it is
  std::vector<std::string> failed_expectations{};  ///< of its scenario, as "ate_rmse_m = 0.3 (<= 0.05)"
  std::string made_by{};                           ///< fingerprint of the build

  std::optional<double> value(const std::string& metric) const;
  /// See Health::blind.
  bool blind() const;
};

class SuiteFigures {
 public:
  /// Only results of exactly the planned scenarios count, and unless `any_build` only those of this build. The
  /// others are named as missing, with the reason. Throws InputError for a broken metrics.json.
  SuiteFigures(const SuitePlan& plan, std::span<const SuiteFailure> failures, bool any_build = false);

  const SuitePlan& plan() const { return plan_; }
  const std::vector<RunFigures>& runs() const { return runs_; }  ///< in order of plan().runs()
  /// Over the seeds that have a value.
  std::optional<Spread> over_seeds(size_t scenario, Method method, const std::string& metric) const;
  /// Over all runs of a method that have a value.
  std::optional<Spread> over_runs(Method method, const std::string& metric) const;
  /// The suite's own expectations by method, each of the mean over all runs.
  struct Expected {
    Method method;
    ExpectationResult result;
  };
  std::vector<Expected> expected() const;

  size_t present() const;  ///< runs with a result
  size_t builds() const;   ///< different builds that made them
  /// Whether the LiDAR of some run of it was.
  bool blind(size_t scenario, Method method) const;
  /// Every run has a result that is worth something, whose drive ended well, and every expectation is met, the suite's and the scenarios'.
  bool as_expected() const;

 private:
  const SuitePlan& plan_;
  std::vector<RunFigures> runs_;
};

}  // namespace vsslam

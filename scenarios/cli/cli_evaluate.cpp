#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <nlohmann/json.hpp>

#include "core/errors.h"
#include "scenarios/cli/cli.h"
#include "scenarios/evaluation/score.h"
#include "scenarios/evaluation/trajectory_file.h"

namespace vsslam {

namespace {

struct EvaluateArguments {
  std::string estimate, truth;
  std::string alignment = "se3";
};

Alignment parse_alignment(const std::string& name) {
  if (name == "none") return Alignment::none;
  return name == "sim3" ? Alignment::sim3 : Alignment::se3;
}

std::string text_of(const TrajectoryScore& s) {
  const auto figure = [](const std::optional<double>& value) {
    return value ? fmt::format("{:.6f}", *value) : "-";
  };
  return fmt::format(
      "ATE RMSE {:.6f} m  mean {:.6f} m  max {:.6f} m\nRPE over 10 m {} %  {} deg\nend error {:.6f} m  path "
      "{:.3f} m  "
      "{} pairs  coverage {:.3f}\n",
      s.ate_rmse_m, s.ate_mean_m, s.ate_max_m, figure(s.rpe_10m_percent), figure(s.rpe_10m_deg),
      s.end_error_m, s.path_length_m, s.pairs, s.coverage);
}

int evaluate(const EvaluateArguments& arguments, const Console& console) {
  ScoreOptions options;
  options.alignment = parse_alignment(arguments.alignment);
  const PoseTrajectory estimate = read_trajectory(arguments.estimate),
                       truth = read_trajectory(arguments.truth);
  const TrajectoryScore s = score(estimate, truth, options, {arguments.estimate, arguments.truth});
  if (options.alignment != Alignment::none)
    if (const std::string why = why_alignment_open(estimate, truth, s); !why.empty())
      throw InputError(fmt::format("{}: {}; --align none compares without", arguments.estimate, why));
  if (s.coverage < kLeastCoverage)
    console.err << fmt::format(
        "warning: only {:.1f} % of the estimate has truth: the figures tell of that alone\n",
        100 * s.coverage);
  console.text() << text_of(s);
  if (!console.json) return kDone;
  const auto number = [](const std::optional<double>& value) {
    return value ? nlohmann::ordered_json(*value) : nlohmann::ordered_json(nullptr);
  };
  const nlohmann::ordered_json json = {{"ate_rmse_m", s.ate_rmse_m},
                                       {"ate_mean_m", s.ate_mean_m},
                                       {"ate_max_m", s.ate_max_m},
                                       {"rpe_10m_percent", number(s.rpe_10m_percent)},
                                       {"rpe_10m_deg", number(s.rpe_10m_deg)},
                                       {"pairs", s.pairs},
                                       {"coverage", s.coverage}};
  console.out << json.dump(2) << '\n';
  return kDone;
}

}  // namespace

void add_evaluate_command(CLI::App& app, Console& console, Command& command) {
  CLI::App* sub =
      app.add_subcommand("evaluate", "score a trajectory file against another (ATE, RPE; TUM or KITTI)");
  const auto arguments = std::make_shared<EvaluateArguments>();
  sub->add_option("estimate", arguments->estimate, "the estimated trajectory")->required();
  sub->add_option("truth", arguments->truth, "the true trajectory")->required();
  sub->add_option("--align", arguments->alignment, "none, se3 (default) or sim3")
      ->check(CLI::IsMember({"none", "se3", "sim3"}));
  add_common_options(*sub, console);
  sub->callback([&console, &command, arguments] {
    command = [&console, arguments] { return evaluate(*arguments, console); };
  });
}

}  // namespace vsslam

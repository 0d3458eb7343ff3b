#include "scenarios/cli/run_summary.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <vector>

#include "scenarios/run/interrupt.h"

namespace vsslam {

namespace {

using Row = std::vector<std::string>;

std::string number(const std::optional<double>& value, int decimals) {
  return value ? fmt::format("{:.{}f}", *value, decimals) : "-";
}

Row header() {
  return {"method", "seed",    "time s", "path m",         "ATE m", "max m",
          "RPE %",  "RPE deg", "end m",  "odometry ATE m", "map m", "loops true",
          "false",  "recall",  "stored", "x real time",    "health"};
}

Row row(const FinishedRun& run) {
  const Metrics& m = run.metrics;
  const bool closes_loops = m.truth != Truth::none && m.method != method_name(Method::lvi_sam_no_loop);
  return {m.method, m.seed ? fmt::format("{}", *m.seed) : "-", number(m.duration_s, 1),
          m.truth == Truth::none ? "-" : number(m.path_length_m, 1),
          // An error of what no LiDAR has seen must not look like one of this method.
          number(m.ate_rmse_m, 3) + (m.ate_rmse_m && m.health.blind() ? " !" : ""), number(m.ate_max_m, 3),
          number(m.rpe_10m_percent, 2), number(m.rpe_10m_deg, 2), number(m.end_error_m, 3),
          number(m.odometry_ate_rmse_m, 3), number(m.map_error_mean_m, 3),
          closes_loops ? fmt::format("{}", m.loops.true_loops) : "-",
          closes_loops ? fmt::format("{}", m.loops.false_loops) : "-", closes_loops ? number(m.loops.recall, 2) : "-",
          fmt::format("{}", m.descriptors.count), number(run.real_time_factor, 1), m.health.verdict()};
}

std::string table(const std::vector<Row>& rows) {
  std::vector<size_t> widths(rows.front().size(), 0);
  for (const Row& cells : rows)
    for (size_t i = 0; i < cells.size(); ++i) widths[i] = std::max(widths[i], cells[i].size());
  std::string text;
  for (const Row& cells : rows) {
    text += fmt::format("{:<{}}", cells[0], widths[0]);
    for (size_t i = 1; i < cells.size(); ++i) text += fmt::format("  {:>{}}", cells[i], widths[i]);
    text += '\n';
  }
  return text;
}

std::string expectations_of(const FinishedRun& run) {
  std::string text;
  for (const ExpectationResult& e : run.metrics.expectations)
    text += fmt::format("{}  {} = {} ({})  {} seed {}\n", e.pass ? "PASS" : "FAIL", e.metric,
                        e.value ? fmt::format("{:.6g}", *e.value) : "none", e.bound.text(),
                        run.metrics.method, run.seed);
  if (!run.metrics.failure.empty())
    text += fmt::format("FAIL  {}  {} seed {}\n", run.metrics.failure, run.metrics.method, run.seed);
  return text;
}

// The methods of a seed share sensors and odometry: what is the same is told once.
std::string healths_of(std::span<const FinishedRun> runs) {
  std::string text;
  std::set<std::string> told;
  const bool several = std::any_of(runs.begin(), runs.end(), [&](const FinishedRun& run) {
    return health_text(run.metrics.health) != health_text(runs.front().metrics.health);
  });
  for (const FinishedRun& run : runs) {
    const std::string lines = health_text(run.metrics.health);
    if (lines.empty() || !told.insert(lines).second) continue;
    if (several) text += fmt::format("{} seed {}:\n", run.metrics.method, run.seed);
    text += lines;
  }
  return text;
}

}  // namespace

std::string summary_text(std::span<const FinishedRun> runs) {
  if (runs.empty()) return "";
  std::vector<Row> rows = {header()};
  for (const FinishedRun& run : runs) rows.push_back(row(run));
  std::string text = table(rows);
  text += healths_of(runs);
  for (const FinishedRun& run : runs) text += expectations_of(run);
  for (const FinishedRun& run : runs)
    text += fmt::format("report: {}\n", (run.folder / "report.html").string());
  return text;
}

std::string finished_text(std::span<const FinishedRun> runs) {
  std::string text = runs.empty() ? "No result was finished.\n" : "Finished and kept:\n";
  for (const FinishedRun& run : runs) text += fmt::format("  {}\n", run.folder.string());
  return text;
}

std::string summary_json(std::span<const FinishedRun> runs) {
  std::string text = "[";
  for (const FinishedRun& run : runs) {
    if (text.size() > 1) text += ",";
    text += "\n" + run.metrics.json();
  }
  return text + "]\n";
}

std::vector<FinishedRun> run_and_summarize(Runner& runner, std::unique_ptr<Progress> progress,
                                           const Console& console) {
  try {
    runner.run(interrupt_flag(), *progress);
  } catch (...) {
    progress.reset();  // its bar goes first
    console.err << finished_text(runner.finished());
    throw;
  }
  progress.reset();
  const std::vector<FinishedRun> runs = runner.finished();
  console.text() << summary_text(runs);
  if (console.json) console.out << summary_json(runs);
  return runs;
}

}  // namespace vsslam

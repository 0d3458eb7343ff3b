// What a suite writes beside the results of its runs.
#pragma once

#include <string>

#include "scenarios/suite/suite_figures.h"

namespace vsslam {

/// One line per run: why it failed, how many expectations of its scenario, and all metrics.
std::string summary_csv(const SuiteFigures& figures);
/// One line per scenario, method and metric: mean, sample standard deviation and extremes over seeds, reference.
std::string tables_csv(const SuiteFigures& figures);
/// The tables of suite_tables(), where the method in focus is behind, expectations and failures.
std::string tables_markdown(const SuiteFigures& figures);
/// One line per run: wall clock, memory and stages. The one file of a suite that differs from time to time.
std::string timing_csv(const SuiteFigures& figures);

/// suite.yaml, summary.csv, tables.csv, tables.md, offsets.csv, timing.csv and report.html in the suite's folder.
/// All but timing.csv, and the report's timing panel, are the same bytes for the same results.
void write_suite_files(const SuiteFigures& figures);
/// Those files, of an earlier state of the results.
void remove_suite_files(const SuitePlan& plan);

}  // namespace vsslam

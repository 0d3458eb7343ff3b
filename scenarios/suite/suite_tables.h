// A suite's figures as tables in the form of Song et al. 2025, with what their tables lack: means over seeds, the
// sample standard deviation, and a publication's figures beside ours.
#pragma once

#include <string>
#include <vector>

#include "scenarios/suite/suite_figures.h"

namespace vsslam {

struct TableCell {
  std::string value;      ///< mean, or two of them with a slash between; " !" after one that is worthless
  std::string deviation;  ///< empty: a single seed, or none
  std::string reference;  ///< empty: the publication has none
  bool best = false;      ///< of its row
};

/// One row per scenario.
struct SuiteTable {
  std::string id, title, note;
  std::vector<std::string> columns;  ///< without that of the scenario
  struct Row {
    std::string scenario;
    std::vector<TableCell> cells;
  };
  std::vector<Row> rows;
};

/// Errors, stored descriptors, bytes, loops, precision, recall, health, and what the sequences are.
std::vector<SuiteTable> suite_tables(const SuiteFigures& figures);

/// Whether the method in focus is among those of the suite.
bool has_focus(const SuiteFigures& figures);
/// Where the method in focus is worse than another by more than the digits shown, one sentence for each scenario
/// and figure.
std::vector<std::string> losses(const SuiteFigures& figures);

/// Lengths in m with three significant decimals below 10 m, fewer above.
std::string metres_text(double value);
/// 1048 B, 5.5 kB, 1.2 MB.
std::string bytes_text(double value);

}  // namespace vsslam

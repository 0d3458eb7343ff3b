#include "scenarios/suite/suite_tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

namespace vsslam {

namespace {

using Text = std::string (*)(double);
enum class Better { none, low, high };

std::string count_text(double value) {
  return value == std::round(value) ? fmt::format("{:.0f}", value) : fmt::format("{:.1f}", value);
}
std::string share_text(double value) {
  return fmt::format("{:.2f}", value);
}

struct Column {
  std::string metric;
  Text text;
};

std::string reference_text(const SuiteFigures& figures, size_t scenario, Method method,
                           const std::string& metric) {
  const SuitePlan& plan = figures.plan();
  const auto value =
      plan.suite.reference.find(plan.scenarios[scenario].name, std::string(method_name(method)), metric);
  return value ? fmt::format("{}", *value) : "";
}

std::string joined(const std::string& a, const std::string& b) {
  return a.empty() && b.empty() ? "" : fmt::format("{} / {}", a.empty() ? "–" : a, b.empty() ? "–" : b);
}

TableCell one(const SuiteFigures& figures, size_t scenario, Method method, const Column& column) {
  TableCell cell;
  cell.reference = reference_text(figures, scenario, method, column.metric);
  const auto spread = figures.over_seeds(scenario, method, column.metric);
  if (!spread) return cell;
  cell.value = column.text(spread->mean);
  if (spread->count > 1) cell.deviation = column.text(spread->deviation);
  return cell;
}

TableCell two(const SuiteFigures& figures, size_t scenario, Method method, const Column& a, const Column& b) {
  const TableCell first = one(figures, scenario, method, a), second = one(figures, scenario, method, b);
  return {joined(first.value, second.value), "", joined(first.reference, second.reference)};
}

/// A table with one column per method that `has` something to show.
SuiteTable by_method(const SuiteFigures& figures, SuiteTable table,
                     const std::function<TableCell(size_t, Method)>& cell,
                     const std::function<bool(Method)>& has) {
  std::vector<Method> methods;
  std::copy_if(figures.plan().methods.begin(), figures.plan().methods.end(), std::back_inserter(methods),
               has);
  for (const Method method : methods) table.columns.emplace_back(method_name(method));
  for (size_t i = 0; i < figures.plan().scenarios.size(); ++i) {
    table.rows.push_back({figures.plan().scenarios[i].name, {}});
    for (const Method method : methods) table.rows.back().cells.push_back(cell(i, method));
  }
  return table;
}

/// Marks the best of each row, by the means and as far as the digits shown tell them apart.
void mark_best(const SuiteFigures& figures, SuiteTable& table, Better better,
               const std::function<std::string(size_t)>& metric) {
  for (size_t i = 0; i < table.rows.size(); ++i) {
    std::optional<double> best;
    std::string best_text;
    for (size_t k = 0; k < table.columns.size(); ++k) {
      const auto spread = figures.over_seeds(i, parse_method(table.columns[k]), metric(i));
      if (!spread || (best && (better == Better::low ? spread->mean >= *best : spread->mean <= *best)))
        continue;
      best = spread->mean;
      best_text = table.rows[i].cells[k].value;
    }
    const auto is_best = [&](const TableCell& cell) { return !best_text.empty() && cell.value == best_text; };
    std::vector<TableCell>& cells = table.rows[i].cells;
    if (std::all_of(cells.begin(), cells.end(), is_best)) continue;  // nothing stands out
    for (TableCell& cell : cells) cell.best = is_best(cell) && !cell.value.ends_with('!');
  }
}

std::string error_metric(const SuiteFigures& figures, size_t scenario) {
  return figures.plan().suite.error_metric_of(figures.plan().scenarios[scenario].name);
}

bool stores(const SuiteFigures& figures, Method method) {
  const auto count = figures.over_runs(method, "descriptors.count");
  return count && count->high > 0;
}
bool closes(const SuiteFigures& figures, Method method) {
  const auto candidates = figures.over_runs(method, "loops.candidates");
  return candidates && candidates->high > 0;
}

SuiteTable error_table(const SuiteFigures& figures) {
  SuiteTable table{"error", "Error (m)", "", {}, {}};
  table.note = "ATE RMSE after alignment (SE(3), all poses)";
  std::string others;
  for (const auto& [scenario, metric] : figures.plan().suite.error_metric)
    others += fmt::format("{}{}: {}", others.empty() ? "; " : ", ", scenario, metric);
  table.note += others + ".";
  const auto metric = [&](size_t scenario) { return error_metric(figures, scenario); };
  table = by_method(
      figures, std::move(table),
      [&](size_t scenario, Method method) {
        TableCell cell = one(figures, scenario, method, {metric(scenario), metres_text});
        if (!cell.value.empty() && figures.blind(scenario, method)) cell.value += " !";
        return cell;
      },
      [](Method) { return true; });
  mark_best(figures, table, Better::low, metric);
  return table;
}

SuiteTable memory_table(const SuiteFigures& figures) {
  return by_method(
      figures,
      {"memory",
       "Stored descriptors / bytes of their index",
       "The index is a vector of four-byte ids with doubling capacity: 24 + 4 · 2^ceil(log2 n) bytes.",
       {},
       {}},
      [&](size_t scenario, Method method) {
        return two(figures, scenario, method, {"descriptors.count", count_text},
                   {"descriptors.index_bytes", count_text});
      },
      [&](Method method) { return stores(figures, method); });
}

SuiteTable database_table(const SuiteFigures& figures) {
  return by_method(
      figures,
      {"database",
       "Bytes of the descriptors / of the whole loop database",
       "The whole database counts the clouds that verifying its loops needs.",
       {},
       {}},
      [&](size_t scenario, Method method) {
        return two(figures, scenario, method, {"descriptors.descriptor_bytes", bytes_text},
                   {"descriptors.database_bytes", bytes_text});
      },
      [&](Method method) { return stores(figures, method); });
}

SuiteTable loops_table(const SuiteFigures& figures) {
  return by_method(
      figures,
      {"loops",
       "Loops: true / false",
       "Accepted loop edges within 0.5 m and 5° of the truth, and others.",
       {},
       {}},
      [&](size_t scenario, Method method) {
        return two(figures, scenario, method, {"loops.true", count_text}, {"loops.false", count_text});
      },
      [&](Method method) { return closes(figures, method); });
}

SuiteTable share_table(const SuiteFigures& figures, SuiteTable table, const std::string& metric) {
  table = by_method(
      figures, std::move(table),
      [&](size_t scenario, Method method) {
        return one(figures, scenario, method, {metric, share_text});
      },
      [&](Method method) { return closes(figures, method); });
  mark_best(figures, table, Better::high, [&](size_t) { return metric; });
  return table;
}

SuiteTable health_table(const SuiteFigures& figures) {
  return by_method(
      figures,
      {"health",
       "Scans in which the LiDAR gave nothing / warnings",
       "There the prior alone is the pose; an error is marked with ! where that is more than one scan in "
       "twenty, or the "
       "result is worthless. The warnings stand in metrics.json and on the page of the run.",
       {},
       {}},
      [&](size_t scenario, Method method) {
        return two(figures, scenario, method, {"health.scans_prior_only", count_text},
                   {"health.warnings", count_text});
      },
      [](Method) { return true; });
}

SuiteTable sequence_table(const SuiteFigures& figures) {
  SuiteTable table{"sequences",
                   "The sequences",
                   "Revisits: key scans at a place where the robot was more than 30 s before. Aliases: pairs "
                   "of key scans that "
                   "share nothing but whose noise-free descriptors are nearer than the loop threshold.",
                   {"duration (s)", "path (m)", "scans", "images", "revisits", "aliases"},
                   {}};
  const std::vector<Column> columns = {{"duration_s", count_text},     {"path_length_m", count_text},
                                       {"scans", count_text},          {"images", count_text},
                                       {"loops.revisits", count_text}, {"loops.aliases", count_text}};
  for (size_t i = 0; i < figures.plan().scenarios.size(); ++i) {
    table.rows.push_back({figures.plan().scenarios[i].name, {}});
    for (const Column& column : columns) {
      table.rows.back().cells.push_back(one(figures, i, figures.plan().methods.front(), column));
      table.rows.back().cells.back().deviation.clear();  // the world's and the drive's, not the noise's
    }
  }
  return table;
}

struct Rivalry {
  std::string metric, name, unit;
  Text text;
  Better better;
};

// "sc-lvi-sam (0.025 m)", or nothing if the focus is not behind it.
std::string behind(const Spread& focus, const Spread& rival, Method method, const Rivalry& r) {
  const double gap = r.better == Better::low ? focus.mean - rival.mean : rival.mean - focus.mean;
  if (gap <= 0 || r.text(focus.mean) == r.text(rival.mean)) return "";
  const bool within =
      std::min(focus.count, rival.count) > 1 && gap <= std::max(focus.deviation, rival.deviation);
  return fmt::format("{} ({}{}{})", method_name(method), r.text(rival.mean), r.unit,
                     within ? ", within the spread over seeds" : "");
}

std::string loss(const SuiteFigures& figures, size_t scenario, Method focus, const Rivalry& r) {
  const auto ours = figures.over_seeds(scenario, focus, r.metric);
  if (!ours) return "";
  std::string rivals;
  for (const Method method : figures.plan().methods) {
    const auto theirs = figures.over_seeds(scenario, method, r.metric);
    if (method == focus || !theirs || (r.metric == "descriptors.count" && !stores(figures, method))) continue;
    if (const std::string text = behind(*ours, *theirs, method, r); !text.empty())
      rivals += (rivals.empty() ? "" : ", ") + text;
  }
  if (rivals.empty()) return "";
  return fmt::format("{}: {} of {} ({}{}) is behind {}.", figures.plan().scenarios[scenario].name, r.name,
                     method_name(focus), r.text(ours->mean), r.unit, rivals);
}

}  // namespace

std::string metres_text(double value) {
  const double size = std::abs(value);
  return fmt::format("{:.{}f}", value, size < 10 ? 3 : size < 100 ? 2 : 1);
}

std::string bytes_text(double value) {
  if (value < 2000) return fmt::format("{:.0f} B", value);
  return value < 2e6 ? fmt::format("{:.1f} kB", value / 1e3) : fmt::format("{:.1f} MB", value / 1e6);
}

std::vector<SuiteTable> suite_tables(const SuiteFigures& figures) {
  std::vector<SuiteTable> tables = {error_table(figures), memory_table(figures), database_table(figures),
                                    loops_table(figures)};
  tables.push_back(share_table(
      figures,
      {"recall", "Recall of loops", "Revisits with a true edge within 4 m of them, of all revisits.", {}, {}},
      "loops.recall"));
  tables.push_back(
      share_table(figures, {"precision", "Precision of loops", "True edges of all accepted ones.", {}, {}},
                  "loops.precision"));
  tables.push_back(health_table(figures));
  tables.push_back(sequence_table(figures));
  std::erase_if(tables, [](const SuiteTable& table) { return table.columns.empty(); });
  return tables;
}

bool has_focus(const SuiteFigures& figures) {
  const std::vector<Method>& methods = figures.plan().methods;
  return std::find(methods.begin(), methods.end(), parse_method(figures.plan().suite.focus)) != methods.end();
}

std::vector<std::string> losses(const SuiteFigures& figures) {
  const Method focus = parse_method(figures.plan().suite.focus);
  std::vector<std::string> sentences;
  for (size_t i = 0; i < figures.plan().scenarios.size(); ++i) {
    const std::vector<Rivalry> rivalries = {
        {error_metric(figures, i), "the error", " m", metres_text, Better::low},
        {"loops.recall", "the recall", "", share_text, Better::high},
        {"loops.precision", "the precision", "", share_text, Better::high},
        {"descriptors.count", "the number of descriptors", "", count_text, Better::low}};
    for (const Rivalry& r : rivalries)
      if (std::string sentence = loss(figures, i, focus, r); !sentence.empty())
        sentences.push_back(std::move(sentence));
  }
  return sentences;
}

}  // namespace vsslam

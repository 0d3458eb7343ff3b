// A suite: scenarios x methods x seeds in one YAML file, with what is expected of the whole and figures from
// elsewhere to stand beside ours.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "core/config.h"
#include "scenarios/experiment/expectations.h"

namespace vsslam {

/// Figures of a publication.
struct ReferenceFigures {
  std::string source;
  /// By scenario, method and metric.
  std::map<std::string, std::map<std::string, std::map<std::string, double>>> figures;

  void fields(Fields& f);
  std::optional<double> find(const std::string& scenario, const std::string& method,
                             const std::string& metric) const;
};

struct Suite {
  std::string name;         ///< names the folder; default: the file's name without .yaml
  std::string description;  ///< one line, for `list`
  /// Names from the library, or paths that end in .yaml, relative to the suite's file.
  std::vector<std::string> scenarios;
  std::vector<std::string> methods{"all"};
  std::vector<uint64_t> seeds{1};
  /// Settings of every scenario: key.path -> value, as --set takes them.
  std::map<std::string, std::string> settings;
  std::string focus = "vs-slam";  ///< the method of whose losses the tables tell in words
  /// By scenario: the metric in the table of errors where it is not ate_rmse_m.
  std::map<std::string, std::string> error_metric;
  ReferenceFigures reference;
  Expectations expect;  ///< of the mean over all runs of a method

  void fields(Fields& f);
  const std::string& error_metric_of(const std::string& scenario) const;
};

/// A name from the library or a path. Throws InputError.
Suite load_suite(const std::string& name_or_path);

}  // namespace vsslam

// What a scenario expects of its results: bounds on any metric, for all methods or for one.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/config.h"

namespace vsslam {

struct Bound {
  std::optional<double> min, max;
  void fields(Fields& f);
  bool holds(double value) const;  ///< false for NaN
  std::string text() const;        ///< "<= 0.05", ">= 1", "1 to 3"
};

/// Metrics by their names in metrics.json; those inside a group with a dot: loops.false. A list counts as its length.
using MetricBounds = std::map<std::string, Bound>;

/// The `expect` section: by method name, or "all". A method's own bound replaces that of "all".
using Expectations = std::map<std::string, MetricBounds>;

/// Adds the section `expect` with its checks.
void expectation_fields(Fields& f, Expectations& expect);

/// The bounds that apply to a method.
MetricBounds bounds_for(const Expectations& expect, const std::string& method);

/// Every metric that can be bounded.
const std::vector<std::string>& metric_names();

/// One expectation after a run. A metric without a value (no loop was accepted: no precision) fails.
struct ExpectationResult {
  std::string metric;
  std::optional<double> value;
  Bound bound;
  bool pass = false;
};

}  // namespace vsslam

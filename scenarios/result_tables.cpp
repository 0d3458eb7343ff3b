#include "scenarios/result_tables.h"

#include <map>

#include "scenarios/evaluation/csv.h"
#include "scenarios/results_columns.h"

namespace vsslam {

namespace {

void put_block(CsvWriter& csv, const InformationBlock& block) {
  csv(block.eigenvalues)(Vec3(block.eigenvectors.col(0)));
}

void put_estimate(CsvWriter& csv, const ScanReport& report) {
  const Information& information = report.information;
  csv(information.translation.alpha())(information.rotation.alpha());
  put_block(csv, information.translation);
  put_block(csv, information.rotation);
}

void put_memory(CsvWriter& csv, const std::optional<MemoryDecision>& memory) {
  if (memory) {
    csv(int{memory->distinct})(int{memory->novel})(int{memory->stored()});
  } else {
    csv.empty(3);
  }
}

void put_truth(CsvWriter& csv, const DegeneracyTruth& truth) {
  csv(truth.information.translation.alpha())(truth.information.rotation.alpha());
  put_block(csv, truth.information.translation);
  put_block(csv, truth.information.rotation);
  csv(truth.points);
}

// A negative figure stands for none.
void put_or_empty(CsvWriter& csv, double value) {
  if (value < 0) {
    csv.empty();
  } else {
    csv(value);
  }
}

}  // namespace

std::string scans_csv(const MappingRun& estimation, const LoopScore& loops) {
  std::map<int, Revisit> revisits;
  for (const Revisit& revisit : loops.revisits) revisits[revisit.key] = revisit;
  CsvWriter csv(kScanColumns);
  for (size_t i = 0; i < estimation.reports().size(); ++i) {
    const ScanReport& report = estimation.reports()[i];
    const DegeneracyTruth& truth = estimation.degeneracy_truth()[i];
    csv(report.scan)(report.stamp)(report.key);
    put_memory(csv, report.memory);
    put_estimate(csv, report);
    put_truth(csv, truth);
    csv(report.correspondences)(report.iterations)(int{report.converged})(int{report.used_prior_only});
    csv(report.degenerate_directions)(truth.degenerate_directions());
    const auto revisit = revisits.find(report.key);
    if (revisit == revisits.end()) {
      csv.empty(2);
    } else {
      csv(revisit->second.of)(int{revisit->second.closed});
    }
    csv.end_row();
  }
  return csv.text();
}

std::string loops_csv(std::span<const LoopRecord> records, const LoopScore& loops) {
  CsvWriter csv(kLoopColumns);
  for (size_t i = 0; i < records.size(); ++i) {
    const LoopRecord& r = records[i];
    const LoopJudgement& truth = loops.judgements[i];
    csv(r.query)(r.match)(r.query_stamp)(r.match_stamp);
    put_or_empty(csv, r.descriptor_distance);
    put_or_empty(csv, r.runner_up_distance);
    csv(r.virtual_id)(r.virtual_offset_m.x())(r.virtual_offset_m.y())(r.yaw_rad);
    csv(int{r.icp_run})(int{r.icp_converged})(r.icp_iterations);
    put_or_empty(csv, r.fitness_m2);
    csv(r.inlier_ratio)(r.overlap)(int{r.accepted})(r.why);
    csv(r.T_match_query)(r.T_match_query_predicted);
    csv(truth.error_m)(truth.error_deg)(truth.overlap)(verdict_name(truth.verdict));
    csv.end_row();
  }
  return csv.text();
}

std::string descriptors_csv(const Mapping& mapping) {
  CsvWriter csv(kDescriptorColumns);
  for (const StoredDescriptor& descriptor : mapping.loop_closer().stored()) {
    const KeyScan& key = mapping.key_scans()[static_cast<size_t>(descriptor.key)];
    csv(key.id)(key.scan)(key.stamp)(key.T_map_base)(descriptor.bytes);
    csv.end_row();
  }
  return csv.text();
}

}  // namespace vsslam

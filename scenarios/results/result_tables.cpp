#include "scenarios/results/result_tables.h"

#include <map>

#include "scenarios/evaluation/csv.h"
#include "scenarios/results/results_columns.h"

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

constexpr size_t kTruthFields = 15;

void put_truth(CsvWriter& csv, const DegeneracyTruth* truth_or_null) {
  if (truth_or_null == nullptr) {
    csv.empty(kTruthFields);
    return;
  }
  const DegeneracyTruth& truth = *truth_or_null;
  csv(truth.information.translation.alpha())(truth.information.rotation.alpha());
  put_block(csv, truth.information.translation);
  put_block(csv, truth.information.rotation);
  csv(truth.points);
}

// A negative figure stands for none.
void put_or_empty(CsvWriter& csv, std::optional<double> value) {
  if (!value || *value < 0) {
    csv.empty();
  } else {
    csv(*value);
  }
}

}  // namespace

std::string scans_csv(const RunRecord& record) {
  std::map<int, Revisit> revisits;
  for (const Revisit& revisit : record.loops.revisits) revisits[revisit.key] = revisit;
  const std::vector<ScanReport>& reports = record.estimation.reports();
  const std::vector<DegeneracyTruth>& truths = record.estimation.degeneracy_truth();
  CsvWriter csv(kScanColumns);
  for (size_t i = 0; i < reports.size(); ++i) {
    const ScanReport& report = reports[i];
    const DegeneracyTruth* truth = truths.empty() ? nullptr : &truths[i];
    csv(report.scan)(report.stamp + record.stamp_offset)(report.key);
    put_memory(csv, report.memory);
    put_estimate(csv, report);
    put_truth(csv, truth);
    csv(report.correspondences)(report.iterations)(int{report.converged})(int{report.used_prior_only});
    csv(report.degenerate_directions);
    put_or_empty(csv, truth ? std::optional<double>(truth->degenerate_directions()) : std::nullopt);
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

std::string loops_csv(const RunRecord& record) {
  const std::vector<LoopRecord>& records = record.estimation.mapping().loops();
  CsvWriter csv(kLoopColumns);
  for (size_t i = 0; i < records.size(); ++i) {
    const LoopRecord& r = records[i];
    const LoopJudgement& truth = record.loops.judgements[i];
    csv(r.query)(r.match)(r.query_stamp + record.stamp_offset)(r.match_stamp + record.stamp_offset);
    put_or_empty(csv, r.descriptor_distance);
    put_or_empty(csv, r.runner_up_distance);
    csv(r.virtual_id)(r.virtual_offset_m.x())(r.virtual_offset_m.y())(r.yaw_rad);
    csv(int{r.icp_run})(int{r.icp_converged})(r.icp_iterations);
    put_or_empty(csv, r.fitness_m2);
    csv(r.inlier_ratio)(r.overlap)(int{r.accepted})(r.why);
    csv(r.T_match_query)(r.T_match_query_predicted);
    put_or_empty(csv, truth.error_m);
    put_or_empty(csv, truth.error_deg);
    put_or_empty(csv, truth.overlap);
    csv(verdict_name(truth.verdict));
    csv.end_row();
  }
  return csv.text();
}

std::string descriptors_csv(const RunRecord& record) {
  const Mapping& mapping = record.estimation.mapping();
  CsvWriter csv(kDescriptorColumns);
  for (const StoredDescriptor& descriptor : mapping.loop_closer().stored()) {
    const KeyScan& key = mapping.key_scans()[static_cast<size_t>(descriptor.key)];
    csv(key.id)(key.scan)(key.stamp + record.stamp_offset)(key.T_map_base)(descriptor.bytes);
    csv.end_row();
  }
  return csv.text();
}

}  // namespace vsslam

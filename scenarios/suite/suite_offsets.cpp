#include "scenarios/suite/suite_offsets.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <map>

#include "core/errors.h"
#include "core/ordered_parallel.h"
#include "scenarios/evaluation/csv.h"
#include "scenarios/evaluation/trajectory_file.h"

namespace vsslam {

namespace {

constexpr std::array kEdges_m = {0.0, 0.5, 1.5, 2.5, 3.5, 4.0};

std::vector<OffsetBin> empty_bins() {
  std::vector<OffsetBin> bins;
  for (size_t i = 0; i + 1 < kEdges_m.size(); ++i) bins.push_back({kEdges_m[i], kEdges_m[i + 1]});
  return bins;
}

void count(std::vector<OffsetBin>& bins, double offset_m, bool closed) {
  for (OffsetBin& bin : bins)
    if (offset_m >= bin.low_m && (offset_m < bin.high_m || &bin == &bins.back())) {
      ++bin.revisits;
      bin.closed += closed;
      return;
    }
}

/// Row i of scans.csv and pose i of truth.tum are of the same scan.
std::vector<OffsetBin> bins_of(const std::filesystem::path& folder) {
  std::vector<OffsetBin> bins = empty_bins();
  const CsvTable scans = CsvTable::read(folder / "scans.csv");
  const PoseTrajectory truth = read_tum(folder / "truth.tum");
  if (scans.rows() != truth.size())
    throw InputError(fmt::format("{}: {} scans, but {} poses in truth.tum", (folder / "scans.csv").string(),
                                 scans.rows(), truth.size()));
  std::map<int64_t, size_t> row_of_key;
  for (size_t row = 0; row < scans.rows(); ++row) {
    const int64_t key = scans.integer(row, "key");
    if (key < 0) continue;
    row_of_key[key] = row;
    if (scans.empty(row, "revisit_of")) continue;
    const auto older = row_of_key.find(scans.integer(row, "revisit_of"));
    if (older == row_of_key.end())
      throw InputError(fmt::format("{}: row {}: revisit_of is no earlier key scan",
                                   (folder / "scans.csv").string(), row + 1));
    const SE3 T_older_base = truth[older->second].pose.inverse() * truth[row].pose;
    count(bins, std::abs(T_older_base.translation.y()), scans.integer(row, "revisit_closed") != 0);
  }
  return bins;
}

bool looks_for_loops(const RunFigures& run) {
  return run.present && run.value("loops.candidates").value_or(0) > 0 &&
         run.value("loops.revisits").value_or(0) > 0;
}

}  // namespace

std::vector<MethodOffsets> recall_over_offset(const SuiteFigures& figures) {
  const std::vector<RunFigures>& runs = figures.runs();
  std::vector<std::vector<OffsetBin>> of_run(runs.size());
  parallel_pieces(runs.size(), 1, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i)
      if (looks_for_loops(runs[i])) of_run[i] = bins_of(runs[i].run.folder);
  });
  std::vector<MethodOffsets> offsets;
  for (const Method method : figures.plan().methods) {
    MethodOffsets sum{method, empty_bins()};
    bool any = false;
    for (size_t i = 0; i < runs.size(); ++i) {
      if (runs[i].run.method != method || of_run[i].empty()) continue;
      any = true;
      for (size_t b = 0; b < sum.bins.size(); ++b) {
        sum.bins[b].revisits += of_run[i][b].revisits;
        sum.bins[b].closed += of_run[i][b].closed;
      }
    }
    if (any) offsets.push_back(std::move(sum));
  }
  return offsets;
}

std::string offsets_csv(const std::vector<MethodOffsets>& offsets) {
  constexpr std::array kColumns = {"method", "offset_from_m", "offset_to_m", "revisits", "closed", "recall"};
  CsvWriter csv(kColumns);
  for (const MethodOffsets& of : offsets)
    for (const OffsetBin& bin : of.bins) {
      csv(method_name(of.method))(bin.low_m)(bin.high_m)(bin.revisits)(bin.closed);
      if (bin.revisits > 0) {
        csv(static_cast<double>(bin.closed) / bin.revisits);
      } else {
        csv.empty();
      }
      csv.end_row();
    }
  return csv.text();
}

}  // namespace vsslam

// The page to look at: one self-contained HTML file made from nothing but the files of the result folder(s).
//
// Needed: metrics.json, estimate.tum, and of a simulated run (its metrics.json has a seed) truth.tum. Without truth
// the page shows no errors. Shown if there: truth.tum, odometry.tum, scans.csv, loops.csv,
// descriptors.csv, map.ply, timing.json. A file that is there but broken is an InputError that names it.
// Everything but the part between `<!-- timing begin -->` and `<!-- timing end -->` is the same, byte for
// byte, for the same files; that part is fed from timing.json alone.
//
// timing.json: {"real_time_factor": x, "peak_rss_mib": x, "cores": n,
//               "stages": {name: {"median_ms": x, "p99_ms": x, "count": n}}}
#pragma once

#include <filesystem>
#include <span>

namespace vsslam {

/// Writes report.html into the folder.
void write_report(const std::filesystem::path& result_dir);
/// Several results side by side, in the given order.
void write_comparison(std::span<const std::filesystem::path> result_dirs, const std::filesystem::path& html);

}  // namespace vsslam

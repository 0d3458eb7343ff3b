// Names of the columns of the CSV files of a result, in order: the contract between the runner, which
// writes them, and everything that reads results. A value that a method does not have is an empty field.
// Stamps are seconds with nine decimals, booleans 0 or 1, poses x y z qx qy qz qw.
#pragma once

#include <array>

namespace vsslam {

/// One row per scan. A recording has no truth of the world: its columns true_* and revisit_* are empty. Eigenvalues ascend; `weak` is the eigenvector of the smallest one, in the lidar frame.
/// Blocks: r rotation, t translation. The columns true_* are the same from noise-free points with true normals.
inline constexpr std::array kScanColumns = {
    "scan", "stamp", "key",  // key: id of the key scan made from this scan, -1: none
    "s",                     // 1: structurally distinct, 0: similar (scene recognition)
    "m", "tau",              // key descriptor and storage decision; empty unless the method selects
    "alpha_t", "alpha_r",    // oblateness of the estimator's blocks
    "eigen_t_0", "eigen_t_1", "eigen_t_2", "weak_t_x", "weak_t_y", "weak_t_z",
    "eigen_r_0", "eigen_r_1", "eigen_r_2", "weak_r_x", "weak_r_y", "weak_r_z",
    "true_alpha_t", "true_alpha_r",
    "true_eigen_t_0", "true_eigen_t_1", "true_eigen_t_2", "true_weak_t_x", "true_weak_t_y", "true_weak_t_z",
    "true_eigen_r_0", "true_eigen_r_1", "true_eigen_r_2", "true_weak_r_x", "true_weak_r_y", "true_weak_r_z",
    "true_points",           // points behind the true_* columns; divide by it to compare with the estimator
    "correspondences", "iterations", "converged", "used_prior_only",
    "degenerate_directions", "true_degenerate_directions",
    "revisit_of",            // key scans only: id of the older key scan that this place shows again; empty: new place
    "revisit_closed",        // 1: a true loop edge was accepted nearby, 0: missed; empty where revisit_of is
};

/// One row per loop candidate.
inline constexpr std::array kLoopColumns = {
    "query", "match", "query_stamp", "match_stamp",
    "descriptor_distance", "runner_up_distance",     // empty: none
    "virtual_id", "virtual_x_m", "virtual_y_m", "yaw_rad",
    "icp_run", "icp_converged", "icp_iterations", "fitness_m2", "inlier_ratio", "overlap",
    "accepted", "why",
    "x", "y", "z", "qx", "qy", "qz", "qw",           // T_match_query, base frames
    "predicted_x", "predicted_y", "predicted_z", "predicted_qx", "predicted_qy", "predicted_qz", "predicted_qw",
    "true_error_m", "true_error_deg",                // empty without truth
    "true_overlap",                                  // empty without truth of the world
    "verdict",               // accepted: "true" or "false", empty without truth; not accepted: "rejected"
};

/// One row per stored descriptor; the pose is T_map_base of its key scan in the final estimate.
inline constexpr std::array kDescriptorColumns = {
    "key", "scan", "stamp", "x", "y", "z", "qx", "qy", "qz", "qw", "bytes",
};

}  // namespace vsslam

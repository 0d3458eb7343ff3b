// Settings of loop closing, and the methods to compare (reference: Song et al. 2025, section 5).
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/config.h"

namespace vsslam {

enum class Method { lvi_sam_no_loop, lvi_sam, sc_lvi_sam, vs_slam_no_vd, vs_slam_no_st, vs_slam };

/// "lvi-sam-no-loop", "lvi-sam", "sc-lvi-sam", "vs-slam-no-vd", "vs-slam-no-st", "vs-slam".
std::string_view method_name(Method method);
/// Throws InputError with the nearest name.
Method parse_method(std::string_view name);
const std::vector<Method>& all_methods();

/// Grid of a Scan Context; rings and sectors are 20 x 60.
struct ScanContextConfig {
  double max_range_m = 40.0;  ///< points beyond are left out; 40 indoors, 80 outdoors
  void fields(Fields& f);
};

/// The target of verification: key scans around the match, in their own poses, one point per voxel.
struct LocalMapConfig {
  int half_width_scans = 25;
  double voxel_m = 0.2;
  void fields(Fields& f);
};

/// Point-to-point ICP. It has converged when a step is small, when the mean squared distance stands still, or
/// when the iterations are used up (as in PCL).
struct IcpConfig {
  double max_correspondence_m = 2.0;
  int max_iterations = 100;  ///< of both passes together
  /// A first pass moves every n-th source point only; the second, with all of them, begins where it ends.
  /// 1: one pass, as PCL does it.
  int coarse_stride = 4;
  double step_translation_m = 1e-3;
  double step_rotation_rad = 1.414e-3;
  double relative_mse_change = 1e-6;
  void fields(Fields& f);
};

struct VerificationConfig {
  IcpConfig icp;
  double max_fitness_m2 = 0.3;      ///< mean squared distance of the correspondences
  double overlap_distance_m = 0.5;  ///< a source point overlaps if a target point is this near
  double min_overlap = 0;           ///< share of source points; 0: not asked for
  int min_source_points = 50, min_target_points = 500;
  /// Clouds whose centroids are at least this far apart at the guess are first moved onto each other; 0:
  /// never.
  double centroid_guess_m = 0;
  /// ICP also starts where odometry expects the loop. That fit is taken if it is about as good: fitness at most so many
  /// times that of the first, overlap at least the inverse share. 0: not tried.
  double prediction_ratio = 0;
  /// The fit is refined point to plane; directions that a smaller share of the planes sees (DegeneracyConfig) take
  /// what odometry expects, since point-to-point ICP slides along them to where the map has more points. 0: not
  /// refined.
  double min_plane_share = 0;
  /// How far the loop may be from where odometry expects it: so much, and so much of the way since the match;
  /// 0 and 0: any.
  double max_gap_m = 0, max_gap_share = 0;
  double max_gap_rad = 0;  ///< likewise its rotation; 0: any
  /// How far odometry can have drifted on this way; infinity if any gap is allowed.
  double allowed_gap_m(double way_m) const;
  void fields(Fields& f);
};

/// `lvi-sam`: the nearest old key pose is the candidate. Edge variance = fitness, no robust kernel.
struct LviSamLoopConfig {
  double period_s = 2.0;
  double search_radius_m = 20.0;
  double min_age_s = 30.0;
  VerificationConfig verification{.icp = {.max_correspondence_m = 40.0}, .centroid_guess_m = 20.0};
  void fields(Fields& f);
};

/// `sc-lvi-sam`: the most similar Scan Context of all key scans is the candidate.
struct ScLviSamLoopConfig {
  /// as_published: ICP from identity, as the public code does; repaired: from the yaw of the winning shift.
  enum class Verification { as_published, repaired };
  double period_s = 1.0;
  double max_distance = 0.3;  ///< of descriptors; the candidate's must be smaller
  int exclude_recent_scans = 30;
  Verification verification = Verification::repaired;
  VerificationConfig as_published{.icp = {.max_correspondence_m = 150.0}};
  VerificationConfig repaired;
  double edge_variance = 0.5;  ///< rad^2 and m^2
  double cauchy_scale = 1.0;   ///< of the edge's robust kernel; 0: quadratic
  void fields(Fields& f);
};

/// 8 N virtual sensor positions around the query, at the distances M, 2 M, ... N M.
struct VirtualDescriptorConfig {
  int distances = 2;       ///< N; 0: none
  double spacing_m = 1.5;  ///< M
  void fields(Fields& f);
};

/// Which key scans are searched for and stored.
struct SelectiveMemoryConfig {
  /// What a descriptor must differ from to be novel: the last one stored, as published; or all that are stored where a
  /// search from here looks, recent ones too: so a place passed again is not stored again, and from each place that is
  /// not stored a search finds one that is like it.
  enum class NovelTo { last, search };
  bool scene_recognition = true;  ///< off: every scene counts as distinct
  bool key_descriptors = true;    ///< off: every descriptor counts as novel
  /// Oblateness from which on a scene is structurally similar; 1 - 1 / the condition number of the block.
  double alpha_t_th = 0.99, alpha_r_th = 0.99;
  NovelTo novel_to = NovelTo::search;
  /// d_th: a descriptor further from these is novel. Above max_distance, some would be neither stored nor found.
  double key_distance = 0.3;
  void fields(Fields& f);
};

/// `vs-slam` and its ablations: `vs-slam-no-vd` has no virtual descriptors, `vs-slam-no-st` stores and searches
/// every key scan.
struct VsSlamLoopConfig {
  double period_s = 1.0;
  double max_distance = 0.3;  ///< of descriptors; the candidate's must be smaller
  double exclude_recent_s = 30.0;
  int exclude_recent_scans = 30;
  /// Only places are searched from which odometry can have drifted to within this distance of the query (see
  /// verification.max_gap_m): a look-alike across the building must not outbid the place itself. Not less than the
  /// reach of the virtual descriptors, N M, and the 2-3 m that a descriptor bears. 0: all.
  double search_reach_m = 10.0;
  VirtualDescriptorConfig virtual_descriptors;
  SelectiveMemoryConfig memory;
  /// ICP's fitness is a weak test in corridors, which fit each other: the scan must also overlap with the map,
  /// and lie where odometry can have drifted to: 1 % of the way is what VIO alone is held to. Along a street it
  /// fits as well a metre further on: of fits alike, the one that needs no drift.
  VerificationConfig verification{.icp = {},
                                  .min_overlap = 0.6,
                                  .prediction_ratio = 1.25,
                                  .min_plane_share = 0.01,
                                  .max_gap_m = 1.0,
                                  .max_gap_share = 0.01,
                                  .max_gap_rad = 0.35};
  double edge_variance = 0.5;  ///< rad^2 and m^2
  double cauchy_scale = 1.0;   ///< of the edge's robust kernel; 0: quadratic
  /// The settings of one of the three methods.
  VsSlamLoopConfig variant(Method method) const;
  void fields(Fields& f);
};

struct LoopConfig {
  ScanContextConfig scan_context;
  LocalMapConfig local_map;
  /// Up to this many descriptor pairs a query compares all; above, the 10 nearest ring keys of each
  /// descriptor.
  int exhaustive_pairs = 2000;
  LviSamLoopConfig lvi_sam;
  ScLviSamLoopConfig sc_lvi_sam;
  VsSlamLoopConfig vs_slam;
  void fields(Fields& f);
};

}  // namespace vsslam

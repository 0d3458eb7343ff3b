#include "slam/odometry.h"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "slam/inertial/fix_history.h"
#include "slam/inertial/imu_track.h"
#include "slam/inertial/imu_units.h"
#include "slam/inertial/pose_covariance.h"
#include "slam/inertial/prior_trust.h"
#include "slam/inertial/rest_alignment.h"
#include "slam/lidar/ring_bands.h"
#include "slam/lidar/surface_features.h"
#include "slam/map/map_cloud.h"
#include "slam/step_covariance.h"
#include "slam/undistort.h"
#include "slam/vio_prior.h"

namespace vsslam {

namespace {

std::unique_ptr<MotionPrior> make_prior(const SlamConfig& config, const RigCalibration& rig,
                                        StageClock* clock) {
  if (config.prior == PriorKind::vio)
    return std::make_unique<VioPrior>(config.vision, config.inertial, rig, clock);
  return make_motion_prior(config.prior, config.inertial, rig);
}

// Whether its points were fired at different times.
bool rolls(const LidarScan& scan) {
  return !scan.points.empty() && scan.points.back().time_s > 0;
}

MotionPath steady_motion(const Vec6& twist, Time begin, Time end) {
  MotionPath path(begin);
  path.append(end, SE3::exp(twist * seconds_between(begin, end)));
  return path;
}

// What is made of a scan, given how the robot moved while it was taken.
struct ScanView {
  Cloud points_lidar;
  std::optional<RingOrder> order;  // of a scan with rings
  std::vector<Feature> thin;
};

}  // namespace

struct Odometry::Impl {
  SlamConfig config;
  RigCalibration rig;
  StageClock* clock;
  std::unique_ptr<MotionPrior> prior;
  FixHistory coasting;  // the prior of a robot without other sensors
  PriorTrust trust;
  ImuUnits imu_units;
  LidarOdometry lidar;
  RingBands ring_bands;
  ImuTrack imu_before_start;
  std::optional<StampedPose> last_odom_base;  // of the last scan
  StepCovariance step;                        // since the last key scan
  std::optional<LidarScan> first_scan;        // until it is known how the robot moved then
  bool lost = false;                          // at the last scan
  bool imu_refused = false;
  int64_t imu_samples = 0, wheel_samples = 0, images = 0;
  OdometryHealth health;

  Impl(const SlamConfig& slam_config, const RigCalibration& rig_calibration, StageClock* stage_clock)
      : config(slam_config),
        rig(rig_calibration),
        clock(stage_clock),
        prior(make_prior(config, rig, clock)),
        coasting(config.inertial),
        imu_units(rig.imu),
        lidar(config.odometry, rig.lidar.range_sigma_m),
        imu_before_start(track_limits(config.inertial)) {}

  // Where a prior says that the scan was taken, and how the robot moved until its end.
  struct Prediction {
    SE3 T_odom_base;
    Mat6 covariance = 1e-8 * Mat6::Identity();  // right perturbation
    Mat6 step_covariance = 1e-8 * Mat6::Identity();  // of the motion since the last scan alone
    MotionPath motion{Time{}};                  // since scan.stamp
  };
  SE3 start_pose();
  MotionPath believed_path(Time begin, Time end) const;
  Prediction predict(const LidarScan& scan, const MotionPath& path, const Mat6& covariance, const Mat6& step) const;
  Prediction predict(const LidarScan& scan);
  Mat6 known_step(const Prediction& prediction, const SE3& T_last_now) const;
  void note_step(const Mat6& covariance);
  std::optional<LidarScan> with_rings(const LidarScan& scan);
  ScanView view(const LidarScan& scan, const MotionPath& motion);
  Registration align(const ScanView& view, const Prediction& prediction);
  static bool jumps(const Prediction& prediction, const Prediction& steady);
  void try_last_velocity(const LidarScan& scan, Prediction& prediction, ScanView& view, Registration& registration);
  void settle_motion(const LidarScan& scan, const Prediction& prediction, ScanView& view, Registration& registration);
  void judge_prior(const LidarScan& scan, const SE3& T_odom_base, const Mat6& known,
                   const Registration& registration);
  void restart_prior();
  void warn_of_missing(OdometryHealth& said) const;
  void note_lost(Time stamp, const Registration& registration);
  void correct_prior(Time stamp, const SE3& T_odom_base, const Mat6& covariance, const Registration& registration);
  std::vector<Feature> features(const char* stage, const Cloud& points_lidar, std::optional<RingOrder>& order,
                                double voxel_m) const;
  Mat6 own_covariance(const Registration& registration, const ScanView& view) const;
  void make_key(ScanView& view, OdometryScan& result);
  OdometryScan add(const LidarScan& scan);
};

// The front end, one scan.
OdometryScan Odometry::Impl::add(const LidarScan& scan) {
  const StageTimer whole(clock, "odometry");
  // 1 prior: where the other sensors say the scan was taken, and how the robot moved during it
  Prediction prediction = predict(scan);
  // 2 undistort: all points to the scan's stamp; 3 features: planar points, thinned
  ScanView seen = view(scan, prediction.motion);
  // 4 register: point to plane against the local map, weighed against the prior
  Registration registration = align(seen, prediction);
  // ... and again if the prior leads nowhere: by the last velocity; or if the robot moved otherwise than thought, which
  // the points were undistorted by
  try_last_velocity(scan, prediction, seen, registration);
  settle_motion(scan, prediction, seen, registration);
  const SE3 T_odom_base = registration.T_odom_lidar * rig.lidar.T_base_lidar.inverse();
  const Mat6 covariance = moved_covariance(registration.covariance, rig.lidar.T_base_lidar.inverse());
  if (lidar.has_map()) lidar.fit_voxel(registration.correspondences);
  // 5 what the LiDAR has seen tells what the prior is worth, and corrects its biases and velocity
  if (!registration.used_prior_only) judge_prior(scan, T_odom_base, covariance, registration);
  correct_prior(scan.stamp, T_odom_base, covariance, registration);
  if (last_odom_base) {
    step.add_prediction(last_odom_base->pose.inverse() * prediction.T_odom_base,
                        known_step(prediction, last_odom_base->pose.inverse() * T_odom_base),
                        seconds_between(last_odom_base->stamp, scan.stamp), seconds_between(scan.stamp, scan.end),
                        trust.believed() && prior->imu_noise().has_value());
    if (!registration.used_prior_only)
      step.add_registration((prediction.T_odom_base.inverse() * T_odom_base).log(), prediction.covariance, covariance);
  }
  prior->add_scan(scan.stamp, seen.points_lidar, T_odom_base);

  OdometryScan result;
  result.end = scan.end;
  ScanReport& report = result.report;
  report.stamp = scan.stamp;
  report.scan = health.scans++;
  report.T_odom_base = T_odom_base;
  report.information = registration.information;
  report.correspondences = registration.correspondences;
  report.iterations = registration.iterations;
  report.converged = registration.converged;
  report.degenerate_directions = registration.degeneracy.directions;
  report.used_prior_only = registration.used_prior_only;
  if (report.used_prior_only) ++health.scans_prior_only;
  if (!report.converged) ++health.scans_unconverged;
  note_lost(scan.stamp, registration);
  last_odom_base = StampedPose{scan.stamp, T_odom_base};
  result.visual = prior->visual_report();
  // 6 far enough from the last key scan? then it enters the local map
  if (lidar.wants_key(T_odom_base)) {
    result.covariance_since_key = step.add_key(T_odom_base, own_covariance(registration, seen));
    if (lidar.has_map()) note_step(step.unseen());
    make_key(seen, result);
  } else if (!lidar.has_map()) {  // the scans so far held no planes: this one may
    lidar.insert_key(features("features_of_key", seen.points_lidar, seen.order, lidar.map_voxel_m()),
                     T_odom_base, rig.lidar.T_base_lidar);
  }
  return result;
}

// Covariance of the motion since the last scan, once it is known that the robot stood: then it errs by what it was thought
// to have moved.
Mat6 Odometry::Impl::known_step(const Prediction& prediction, const SE3& T_last_now) const {
  constexpr double kRest_m = 1e-4;
  if (!trust.believed() || !prior->stood()) return prediction.step_covariance;
  Mat6 step = Mat6::Zero();
  step.topLeftCorner<3, 3>() = prediction.step_covariance.topLeftCorner<3, 3>();
  step.bottomRightCorner<3, 3>() =
      T_last_now.translation * T_last_now.translation.transpose() + kRest_m * kRest_m * Mat3::Identity();
  return step;
}

// A step from key scan to key scan, by how far it was seen.
void Odometry::Impl::note_step(const Mat6& covariance) {
  constexpr double kUnsure_m = 0.1;  // of a step of about a meter: worse than any odometry that is of use
  const Eigen::SelfAdjointEigenSolver<Mat3> translation(covariance.bottomRightCorner<3, 3>(), Eigen::EigenvaluesOnly);
  const double sigma_m = std::sqrt(translation.eigenvalues()[2]);
  ++health.steps;
  if (!(sigma_m <= kUnsure_m)) ++health.steps_unsure;
  health.worst_step_sigma_m = std::max(health.worst_step_sigma_m, sigma_m);
}

// Base at the origin, yaw 0, gravity along -z.
SE3 Odometry::Impl::start_pose() {
  const RestAlignment rest = align_at_rest(imu_before_start.samples(), rig.imu, config.inertial);
  const InitialState state{SE3(rest.q_odom_base, Vec3::Zero()), rest.gyro_bias_radps, rest.gyro_bias_sigma_radps,
                           rest.at_rest, rest.accel_bias_mps2, !rest.no_gravity};
  prior->start(state);
  const bool by_force = config.prior == PriorKind::imu || config.prior == PriorKind::vio;
  const bool by_imu = by_force || config.prior == PriorKind::wheel_imu;
  if (by_imu && (rest.upside_down || (rest.no_gravity && by_force))) {
    trust.refuse();
    imu_refused = true;
    health.warnings.push_back(fmt::format("prior: the IMU {}: not believed, the LiDAR alone goes on",
                                          rest.no_gravity ? "does not feel gravity" : "is upside down by its mount"));
  } else if (by_imu && rest.no_gravity) {
    health.warnings.push_back("prior: the IMU does not feel gravity: its gyroscope and the wheels go on");
  }
  imu_before_start.clear();
  return state.T_odom_base;
}

MotionPath Odometry::Impl::believed_path(Time begin, Time end) const {
  return trust.believed() ? prior->path(begin, end) : steady_motion(coasting.twist(), begin, end);
}

// `path` goes from the last scan to the end of this one.
Odometry::Impl::Prediction Odometry::Impl::predict(const LidarScan& scan, const MotionPath& path,
                                                   const Mat6& covariance, const Mat6& step) const {
  const SE3 T_last_begin = path.at(scan.stamp);
  Prediction prediction{last_odom_base->pose * T_last_begin, covariance, step, MotionPath(scan.stamp)};
  const SE3 T_begin_last = T_last_begin.inverse();
  for (const StampedPose& knot : path.knots())
    prediction.motion.append(knot.stamp, T_begin_last * knot.pose);
  return prediction;
}

Odometry::Impl::Prediction Odometry::Impl::predict(const LidarScan& scan) {
  if (!last_odom_base) {
    Prediction prediction{.T_odom_base = start_pose()};
    prediction.motion = believed_path(scan.stamp, scan.end);
    return prediction;
  }
  const MotionPath path = believed_path(last_odom_base->stamp, scan.end);
  if (!trust.believed()) return predict(scan, path, coasting.covariance(scan.stamp), coasting.step_covariance(scan.stamp));
  return predict(scan, path, trust.inflation() * prior->covariance(scan.stamp),
                 trust.inflation() * prior->step_covariance(scan.stamp));
}

// A scan whose rings say nothing, with those that its elevations give; or none, if they do not gather. Nothing if there is
// nothing to repair.
std::optional<LidarScan> Odometry::Impl::with_rings(const LidarScan& scan) {
  if (!scan.rings_known || rings_tell(scan.points)) return std::nullopt;
  LidarScan repaired = scan;
  {
    const StageTimer timer(clock, "derive_rings");
    repaired.rings_known = ring_bands.fill(repaired.points);
  }
  if (health.scans_ringless++ == 0)
    health.repairs.push_back(
        repaired.rings_known
            ? fmt::format("lidar: all points are of one ring: {} rings derived from their elevations", ring_bands.rings())
            : std::string("lidar: all points are of one ring, and their elevations do not gather: surfaces from neighbours"));
  return repaired;
}

ScanView Odometry::Impl::view(const LidarScan& scan, const MotionPath& motion) {
  ScanView seen;
  {
    const StageTimer timer(clock, "undistort");
    seen.points_lidar = undistort(scan, motion, rig.lidar.T_base_lidar);
  }
  if (scan.rings_known) {
    seen.order.emplace(scan, seen.points_lidar, range_step_m(lidar.range_sigma_m(), config.odometry.features));
    if (lidar.listens()) lidar.listen(measured_range_sigma_m(*seen.order));
  } else if (lidar.listens()) {
    lidar.listen(measured_surface_sigma_m(seen.points_lidar, lidar.voxel_m(), config.odometry.features));
  }
  seen.thin = features("features", seen.points_lidar, seen.order, lidar.voxel_m());
  return seen;
}

Registration Odometry::Impl::align(const ScanView& seen, const Prediction& prediction) {
  const StageTimer timer(clock, "register");
  const PosePrior around{prediction.T_odom_base * rig.lidar.T_base_lidar,
                         moved_covariance(prediction.covariance, rig.lidar.T_base_lidar)};
  if (lidar.has_map()) return lidar.align(seen.thin, around);
  Registration first;  // the first scan defines the frame; without a map the others follow the prior
  first.used_prior_only = last_odom_base || seen.thin.empty();
  first.T_odom_lidar = around.T_odom_lidar;
  first.covariance = around.covariance;
  first.converged = true;
  return first;
}

// Whether a prior turns otherwise than the robot did until now, by more than robots can (three sigma).
bool Odometry::Impl::jumps(const Prediction& prediction, const Prediction& steady) {
  const Vec3 turn = so3_log(steady.T_odom_base.rotation.conjugate() * prediction.T_odom_base.rotation);
  const Mat3 covariance = steady.covariance.topLeftCorner<3, 3>();
  return turn.dot(covariance.ldlt().solve(turn)) > 9;
}

// A prior that is wrong beyond the reach of a registration (rates in degrees) would blind the LiDAR. Whichever the scan
// fits better is right.
void Odometry::Impl::try_last_velocity(const LidarScan& scan, Prediction& prediction, ScanView& seen,
                                       Registration& registration) {
  if (!last_odom_base || !trust.believed()) return;
  const Vec6 shift =
      (prediction.T_odom_base.inverse() * registration.T_odom_lidar * rig.lidar.T_base_lidar.inverse()).log();
  const double surprise = shift.dot(prediction.covariance.ldlt().solve(shift)) / 6;
  constexpr double kSurprising = 25;  // five sigma
  const Prediction other =
      predict(scan, steady_motion(coasting.twist(), last_odom_base->stamp, scan.end), coasting.covariance(scan.stamp),
              coasting.step_covariance(scan.stamp));
  if (!lidar.looks_lost(registration) && surprise < kSurprising && !jumps(prediction, other)) return;
  ScanView other_seen = view(scan, other.motion);
  const Registration other_registration = align(other_seen, other);
  if (other_registration.used_prior_only ||
      (other_registration.misfit >= registration.misfit && other_registration.cost >= registration.cost))
    return;
  prediction = other;
  seen = std::move(other_seen);
  registration = other_registration;
}

// A scan that was undistorted by a wrong motion is bent, and so registered a little off; where it was registered all the
// same tells more of the motion than the prior knew. By what the prior missed since the last scan, at a steady rate, it
// misses during this one. Repeated until the two agree. The first scan of all, taken when nothing was known of the
// motion, is set right together with the second. (As in MOLA, which estimates the twist with the pose.)
void Odometry::Impl::settle_motion(const LidarScan& scan, const Prediction& prediction, ScanView& seen,
                                   Registration& registration) {
  constexpr double kBent_m = 0.05, kBent_rad = 0.01;  // over a scan: what features and gates bear without notice
  constexpr int kRounds = 4;
  const std::optional<LidarScan> first = std::exchange(first_scan, std::nullopt);
  if (!last_odom_base && rolls(scan)) first_scan = scan;
  if (!last_odom_base || !rolls(scan)) return;
  const SE3 T_lidar_base = rig.lidar.T_base_lidar.inverse();
  const double dt_s = seconds_between(last_odom_base->stamp, scan.stamp);
  Vec6 corrected = Vec6::Zero();  // twist beside the prior's
  for (int round = 0; round < kRounds && !registration.used_prior_only; ++round) {
    const SE3 T_odom_base = registration.T_odom_lidar * T_lidar_base;
    const Vec6 missed = (prediction.T_odom_base.inverse() * T_odom_base).log() / dt_s;
    const Vec6 change = (missed - corrected) * seconds_between(scan.stamp, scan.end);
    if (change.tail<3>().norm() < kBent_m && change.head<3>().norm() < kBent_rad) return;
    corrected = missed;
    if (first) {
      const Vec6 twist = (last_odom_base->pose.inverse() * T_odom_base).log() / dt_s;
      ScanView again = view(*first, steady_motion(twist, first->stamp, first->end));
      lidar.replace_first_key(
          features("features_of_key", again.points_lidar, again.order, lidar.map_voxel_m()),
          last_odom_base->pose, rig.lidar.T_base_lidar);
    }
    MotionPath motion(scan.stamp);
    for (const StampedPose& knot : prediction.motion.knots())
      motion.append(knot.stamp, knot.pose * SE3::exp(corrected * seconds_between(scan.stamp, knot.stamp)));
    seen = view(scan, motion);
    registration = align(seen, prediction);
  }
}

void Odometry::Impl::judge_prior(const LidarScan& scan, const SE3& T_odom_base, const Mat6& known,
                                 const Registration& registration) {
  if (!last_odom_base) return;
  const Time last = last_odom_base->stamp;
  const auto step_from = [&](const SE3& predicted) { return Vec6((predicted.inverse() * T_odom_base).log()); };
  const SE3 by_prior = last_odom_base->pose * prior->path(last, scan.stamp).end_pose();
  const SE3 by_velocity =
      last_odom_base->pose * SE3::exp(coasting.twist() * seconds_between(last, scan.stamp));
  const bool before = trust.believed();
  constexpr double kBlind_m = 0.05;  // a scan that sees a direction worse does not judge in it
  const Eigen::SelfAdjointEigenSolver<Mat6> seen(registration.scan_information, Eigen::EigenvaluesOnly);
  const bool blind = seen.eigenvalues()[0] < 1 / (kBlind_m * kBlind_m);
  if (blind) ++health.scans_blind;
  trust.add(step_from(by_prior), prior->covariance(scan.stamp), known, step_from(by_velocity), blind);
  if (!trust.believed()) ++health.prior_refused;
  if (before && !trust.believed())
    health.warnings.push_back(fmt::format(
        "prior: from {:.1f} s on it contradicts the LiDAR, and is not believed", scan.stamp.seconds()));
  imu_units.compare(last, scan.stamp, last_odom_base->pose.inverse() * T_odom_base);
}

// Of scans that fit nowhere; those in a row are one span.
void Odometry::Impl::note_lost(Time stamp, const Registration& registration) {
  const bool was_lost = std::exchange(lost, lidar.has_map() && last_odom_base && lidar.looks_lost(registration));
  if (!lost) return;
  if (!was_lost)
    health.lost.push_back({stamp, stamp, 0, registration.used_prior_only ? "too few planes" : "fits badly"});
  health.lost.back().end = stamp;
  ++health.lost.back().scans;
}

// A prior whose sensors are not there is another prior.
void Odometry::Impl::warn_of_missing(OdometryHealth& said) const {
  const PriorKind kind = config.prior;
  const auto missing = [&](bool needed, int64_t samples, const char* sensor, const char* instead) {
    if (needed && samples == 0)
      said.warnings.push_back(fmt::format("prior: slam.prior asks for {}, and there is none: {}", sensor, instead));
  };
  missing(kind == PriorKind::vio, images, "a camera", "IMU and wheels go on without it");
  missing(kind == PriorKind::vio || kind == PriorKind::imu || kind == PriorKind::wheel_imu, imu_samples, "an IMU",
          wheel_samples > 0 && kind != PriorKind::imu ? "the wheels go on without it" : "the last velocity goes on");
  missing(kind == PriorKind::wheel || kind == PriorKind::wheel_imu, wheel_samples, "wheels",
          imu_samples > 0 && kind != PriorKind::wheel ? "the IMU goes on without them" : "the last velocity goes on");
}

// What it had learnt came from samples in the wrong unit.
void Odometry::Impl::restart_prior() {
  health.wheels_slipped += prior->slips();
  prior = make_prior(config, rig, clock);
  trust = PriorTrust();
  imu_before_start.clear();
  if (last_odom_base) {
    prior->start({.T_odom_base = last_odom_base->pose});
    prior->correct({.stamp = last_odom_base->stamp, .T_odom_base = last_odom_base->pose});
  }
  for (const ImuSample& sample : imu_units.recent()) {
    if (!last_odom_base) imu_before_start.add(sample);
    prior->add(sample);
  }
}

void Odometry::Impl::correct_prior(Time stamp, const SE3& T_odom_base, const Mat6& covariance,
                                   const Registration& registration) {
  OdometryFix fix{stamp, T_odom_base, covariance, Mat3::Zero(), Mat3::Zero()};
  if (!registration.used_prior_only) {
    const Mat3 R_base_lidar = rig.lidar.T_base_lidar.matrix3();
    fix.observed_rotation =
        R_base_lidar * registration.degeneracy.observed_rotation() * R_base_lidar.transpose();
    fix.observed_translation =
        R_base_lidar * registration.degeneracy.observed_translation() * R_base_lidar.transpose();
  }
  prior->correct(fix);
  coasting.add(fix);
}

std::vector<Feature> Odometry::Impl::features(const char* stage, const Cloud& points_lidar,
                                              std::optional<RingOrder>& order, double voxel_m) const {
  const StageTimer timer(clock, stage);
  const double sigma_m = lidar.range_sigma_m();
  if (order) return select_thin_features(*order, sigma_m, config.odometry.features, voxel_m);
  return select_surface_features(points_lidar, sigma_m, voxel_m, config.odometry.features);
}

// Of a registration beside others against nearly the same map.
Mat6 Odometry::Impl::own_covariance(const Registration& registration, const ScanView& seen) const {
  constexpr double kDefines = 1e-9;  // the first scan is the map
  if (registration.used_prior_only) return Mat6::Identity();
  if (!lidar.has_map()) return kDefines * Mat6::Identity();
  return moved_covariance(lidar.step_covariance(seen.thin, registration.T_odom_lidar),
                          rig.lidar.T_base_lidar.inverse());
}

void Odometry::Impl::make_key(ScanView& seen, OdometryScan& result) {
  const SE3& T_odom_base = result.report.T_odom_base;
  const bool first = !lidar.has_map();
  const auto dense = [&] { return features("features_of_key", seen.points_lidar, seen.order, lidar.map_voxel_m()); };
  const std::vector<Feature> dense_features = dense();
  const StageTimer timer(clock, "map");
  lidar.insert_key(dense_features, T_odom_base, rig.lidar.T_base_lidar);
  while (first && lidar.fit_voxel(lidar.matches(seen.thin, T_odom_base * rig.lidar.T_base_lidar))) {
    seen.thin = features("features", seen.points_lidar, seen.order, lidar.voxel_m());
    lidar.replace_first_key(dense(), T_odom_base, rig.lidar.T_base_lidar);
  }
  Cloud features_lidar;
  features_lidar.reserve(seen.thin.size());
  for (const Feature& feature : seen.thin) features_lidar.push_back(feature.point_lidar);
  result.is_key = true;
  result.features_lidar = share(std::move(features_lidar));
  result.map_points_lidar = share(thin_cloud(seen.points_lidar, 0.5 * lidar.voxel_m()));
  result.points_lidar = share(std::move(seen.points_lidar));
}

Odometry::Odometry(const SlamConfig& config, const RigCalibration& rig, StageClock* clock)
    : impl_(std::make_unique<Impl>(config, rig, clock)) {}
Odometry::~Odometry() = default;

void Odometry::add(const ImuSample& sample) {
  const ImuSample repaired = impl_->imu_units.repaired(sample);
  ++impl_->imu_samples;
  if (impl_->imu_units.repairs()) ++impl_->health.imu_repaired;
  if (impl_->imu_units.newly_in_degrees()) impl_->restart_prior();
  if (!impl_->last_odom_base) impl_->imu_before_start.add(repaired);
  impl_->prior->add(repaired);
}
void Odometry::add(const WheelSample& sample) {
  ++impl_->wheel_samples;
  impl_->prior->add(sample);
}
void Odometry::add(const CameraFrame& image) {
  ++impl_->images;
  impl_->prior->add(image);
}
OdometryScan Odometry::add(const LidarScan& scan) {
  const std::optional<LidarScan> repaired = impl_->with_rings(scan);
  return impl_->add(repaired ? *repaired : scan);
}

OdometryHealth Odometry::health() const {
  OdometryHealth health = impl_->health;
  health.range_sigma_m = impl_->lidar.range_sigma_m();
  health.voxel_m = impl_->lidar.voxel_m();
  health.wheels_slipped += impl_->prior->slips();
  health.imu_noise = impl_->prior->imu_noise();
  constexpr int64_t kOften = 10;  // one scan in so many: a wheel or a floor that is not as the sheet says
  if (!impl_->imu_refused && health.wheels_slipped * kOften > health.scans)
    health.warnings.push_back(
        fmt::format("wheels: in {} of {} scans their way is not the IMU's, and was not believed: slip, or a wrong "
                    "wheels.wheel_radius_m or imu.T_base_imu",
                    health.wheels_slipped, health.scans));
  impl_->warn_of_missing(health);
  const std::vector<std::string>& of_units = impl_->imu_units.repairs_said();
  health.repairs.insert(health.repairs.end(), of_units.begin(), of_units.end());
  return health;
}

}  // namespace vsslam

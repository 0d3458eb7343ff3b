#include "slam/vio/marginalization.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "tests/slam/vio/vio_world.h"

namespace vsslam {
namespace {

// Residual A_1 x_1 + A_2 x_2 + ... + a rho - c.
class LinearFactor final : public ceres::CostFunction {
 public:
  LinearFactor(int rows, const std::vector<int>& sizes, uint64_t seed) : c_(rows) {
    const RandomStream random(seed, "linear");
    uint64_t k = 0;
    for (const int size : sizes) {
      mutable_parameter_block_sizes()->push_back(size);
      A_.push_back(Eigen::MatrixXd::NullaryExpr(rows, size, [&] { return random.normal(k++); }));
    }
    for (double& value : c_) value = random.normal(k++);
    set_num_residuals(rows);
  }
  bool Evaluate(double const* const* x, double* residuals, double** jacobians) const override {
    Eigen::Map<Eigen::VectorXd> r(residuals, c_.size());
    r = -c_;
    for (size_t b = 0; b < A_.size(); ++b) {
      r += A_[b] * Eigen::Map<const Eigen::VectorXd>(x[b], A_[b].cols());
      if (!jacobians || !jacobians[b]) continue;
      using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
      Eigen::Map<RowMajor>(jacobians[b], c_.size(), A_[b].cols()) = A_[b];
    }
    return true;
  }

 private:
  std::vector<Eigen::MatrixXd> A_;
  Eigen::VectorXd c_;
};

Variable motion(int frame) {
  return {VariableKind::motion, frame};
}
Variable point(int index) {
  return {VariableKind::point, index};
}

Linearization at_zero(int frames, int features) {
  Linearization at;
  for (int i = 0; i < frames; ++i) at.frames.push_back(100 + i);
  at.now.frames.resize(static_cast<size_t>(frames));
  for (FrameBlocks& blocks : at.now.frames) blocks = frame_blocks(VioState{});
  at.now.points.assign(static_cast<size_t>(features), Vec3::Zero());
  at.first = at.now;
  return at;
}

NormalEquations normal_equations(const std::vector<WindowFactor>& factors, const Linearization& at) {
  WindowEquations equations(factors, at.now.points.size());
  equations.linearize(at.now, at.first);
  return equations.without_points();
}

std::vector<WindowFactor> chain(int from, int to) {
  std::vector<WindowFactor> factors;
  for (int i = from; i < to; ++i)
    factors.push_back({std::make_unique<LinearFactor>(12, std::vector<int>{9, 9}, static_cast<uint64_t>(i)),
                       false,
                       {motion(i), motion(i + 1)}});
  return factors;
}

TEST(Marginalization, OfALinearChainLosesNothing) {
  const Linearization at = at_zero(4, 0);
  const NormalEquations all = normal_equations(chain(0, 3), at);
  const Eigen::VectorXd batch = -all.H.ldlt().solve(all.b);

  const LinearPrior prior = marginalize(chain(0, 1), at, 0);
  ASSERT_EQ(prior.parts.size(), 1u);
  EXPECT_EQ(prior.parts[0].frame, 101);
  std::vector<WindowFactor> rest = chain(1, 3);
  rest.push_back({std::make_unique<PriorFactor>(prior), false, {motion(1)}});
  const NormalEquations reduced = normal_equations(rest, at);
  const Eigen::VectorXd sliding = -reduced.H.ldlt().solve(reduced.b);
  EXPECT_LT((sliding - batch.tail(27)).norm(), 1e-9);
  EXPECT_LT((reduced.H.inverse() - all.H.inverse().bottomRightCorner(27, 27)).norm(), 1e-9);
}

TEST(Marginalization, KeepsFirstEstimatesButMeansTheSame) {
  // The same chain, evaluated elsewhere than where its prior was made: linear, so the solution is the same.
  const Linearization zero = at_zero(4, 0);
  const LinearPrior prior = marginalize(chain(0, 1), zero, 0);
  std::vector<WindowFactor> rest = chain(1, 3);
  rest.push_back({std::make_unique<PriorFactor>(prior), false, {motion(1)}});
  const NormalEquations here = normal_equations(rest, zero);
  Linearization moved = zero;
  for (int i = 1; i < 4; ++i) moved.now.data(motion(i))[2] = 0.7 * i;
  const NormalEquations there = normal_equations(rest, moved);  // slopes and origin at `first`
  EXPECT_LT((here.H - there.H).norm(), 1e-9);
  EXPECT_LT((here.b - there.b).norm(), 1e-9);
}

TEST(Marginalization, FeaturesAreEliminatedExactly) {
  std::vector<WindowFactor> factors = chain(0, 2);
  for (int f = 0; f < 3; ++f)
    for (int i = 0; i < 3; ++i)
      factors.push_back(
          {std::make_unique<LinearFactor>(2, std::vector<int>{9, 3}, static_cast<uint64_t>(50 + 10 * f + i)),
           false,
           {motion(i), point(f)}});
  const NormalEquations reduced = normal_equations(factors, at_zero(3, 3));
  // All in one: 27 + 9 unknowns, by rows.
  Eigen::MatrixXd J = Eigen::MatrixXd::Zero(24 + 18, 36);
  Eigen::VectorXd r(J.rows());
  Eigen::Index row = 0;
  const Linearization at = at_zero(3, 3);
  for (const WindowFactor& factor : factors) {
    const int rows = factor.cost->num_residuals();
    using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    RowMajor a(rows, 9), b(rows, factor.cost->parameter_block_sizes()[1]);
    const double* x[] = {at.now.data(factor.variables[0]), at.now.data(factor.variables[1])};
    double* out[] = {a.data(), b.data()};
    factor.cost->Evaluate(x, r.segment(row, rows).data(), out);
    J.block(row, 9 * factor.variables[0].index, rows, 9) = a;
    const Variable second = factor.variables[1];
    J.block(row, second.kind == VariableKind::motion ? 9 * second.index : 27 + 3 * second.index, rows,
            b.cols()) = b;
    row += rows;
  }
  const Eigen::VectorXd whole = -(J.transpose() * J).ldlt().solve(J.transpose() * r);
  EXPECT_LT((-reduced.H.ldlt().solve(reduced.b) - whole.head(27)).norm(), 1e-8);
}

TEST(Marginalization, UnknownDirectionsStayUnknown) {
  // Five equations tie frame 0 to frame 1: what remains on frame 1 alone is nothing.
  std::vector<WindowFactor> factors;
  factors.push_back(
      {std::make_unique<LinearFactor>(5, std::vector<int>{9, 9}, 3), false, {motion(0), motion(1)}});
  EXPECT_EQ(marginalize(factors, at_zero(2, 0), 0).offset.size(), 0);
  factors.push_back(
      {std::make_unique<LinearFactor>(4, std::vector<int>{9, 9}, 4), false, {motion(0), motion(1)}});
  factors.push_back(
      {std::make_unique<LinearFactor>(3, std::vector<int>{9, 9}, 5), false, {motion(0), motion(1)}});
  EXPECT_EQ(marginalize(factors, at_zero(2, 0), 0).offset.size(), 3);  // 12 equations less 9 unknowns
}

using namespace vio_world;

// A ride that begins in motion with an aid as uncertain as the settings say. Its velocity is known well: what follows
// compares with first-order statistics, and a scale that is 10 % off at first is beyond first order.
struct AidedRide {
  Drive drive;
  RideOptions options;
  bool aided = false;

  AidedRide(uint64_t seed, double duration_s) : drive(settings(duration_s)) {
    const RandomStream random(seed, "aid");
    const auto normals = [random](uint64_t k) {
      return Vec3(random.normal(k), random.normal(k + 1), random.normal(k + 2));
    };
    options.config.feature_sigma_px = 0.5;
    options.config.max_features = 60;
    options.config.start.aid_velocity_sigma_mps = 0.02;
    const VioStartConfig& start = options.config.start;
    options.noise.imu = true;
    options.noise.seed = seed;
    options.noise.feature_px = 0.5 * 384.2 / 460;
    options.noise.gyro_bias_radps = start.gyro_bias_sigma_radps * normals(0);
    options.noise.accel_bias_mps2 = start.accel_bias_sigma_mps2 * normals(3);
    options.before_frame = [this, start, normals](VisualInertialOdometry& vio, Time now,
                                                  const VioState& truth) {
      if (!aided && now.seconds() > 0.5)
        vio.add(VioAid{truth.stamp,
                       truth.T_vio_imu *
                           SE3(so3_exp(start.aid_tilt_sigma_rad * (truth.T_vio_imu.rotation.conjugate() *
                                                                   Vec3(normals(6).x(), normals(6).y(), 0))),
                               Vec3::Zero()),
                       truth.v_vio_mps + start.aid_velocity_sigma_mps * normals(9),
                       {}});
      aided |= now.seconds() > 0.5;
    };
  }
  static Drive::Options settings(double duration_s) {
    Drive::Options options;
    options.rest_s = 1;
    options.warm_s = 6;
    options.speed_change = 0.3;
    options.duration_s = duration_s;
    return options;
  }
};

// Not exactly: the window forgets the oldest sightings of tracks that live on, and the batch keeps them. Of two
// consistent estimates, one of which knows all that the other knows, the difference has the covariance P_less - P_more.
TEST(Marginalization, SlidingWindowAgreesWithBatch) {
  VioState states[2];
  Eigen::Matrix<double, 15, 15> covariances[2];
  for (const bool batch : {true, false}) {
    AidedRide ride_of(11, 4.0);
    ride_of.options.config.window = batch ? 60 : 8;
    ride_of.options.config.max_features = 1000;
    ride_of.options.config.max_iterations = 20;
    ride_of.options.after_frame = [&](const VisualInertialOdometry& vio, Time now) {
      if (vio.status() != VioStatus::tracking || now.seconds() < 3.9) return;
      states[batch] = vio.state();
      covariances[batch] = vio.covariance();
    };
    ride(ride_of.drive, ride_of.options);
  }
  ASSERT_EQ(states[0].stamp, states[1].stamp);
  Eigen::Matrix<double, 15, 1> e;
  e << (states[1].T_vio_imu.inverse() * states[0].T_vio_imu).log(), states[0].v_vio_mps - states[1].v_vio_mps,
      states[0].bias.gyro_radps - states[1].bias.gyro_radps,
      states[0].bias.accel_mps2 - states[1].bias.accel_mps2;
  for (int k = 0; k < 15; ++k) {
    const double forgotten = covariances[0](k, k) - covariances[1](k, k);
    EXPECT_GT(forgotten, 0) << k;
    EXPECT_LT(std::abs(e[k]), 3 * std::sqrt(forgotten)) << k;
  }
}

// Normalised estimation error squared of pose and velocity (9 degrees of freedom), after several times the window's
// length, by the camera alone and with depths of the LiDAR. A consistent estimator has 9 on average; over 8 runs 95 %
// lie between 6.3 and 12.2. Below is allowed: the robust loss also discounts what fits.
TEST(Marginalization, EstimateIsConsistent) {
  constexpr int kRuns = 8;
  for (const double depth_share : {0.0, 0.6}) {
    double sum = 0;
    for (uint64_t seed = 0; seed < kRuns; ++seed) {
      AidedRide ride_of(seed, 6.0);
      ride_of.options.config.window = 6;
      ride_of.options.depth_share = depth_share;
      ride_of.options.noise.depth_ratio = ride_of.options.config.depth_sigma_ratio;
      Eigen::Matrix<double, 15, 15> covariance;
      VioState last;
      ride_of.options.after_frame = [&](const VisualInertialOdometry& vio, Time now) {
        if (vio.status() != VioStatus::tracking || now.seconds() < 5.9) return;
        covariance = vio.covariance();
        last = vio.state();
      };
      const Ride ridden = ride(ride_of.drive, ride_of.options);
      EXPECT_EQ(ridden.restarts, 0);
      const VioState truth = true_state(ride_of.drive, rig(), last.stamp, {});
      Eigen::Matrix<double, 9, 1> e;
      e << (last.T_vio_imu.inverse() * truth.T_vio_imu).log(), truth.v_vio_mps - last.v_vio_mps;
      sum += e.dot(covariance.topLeftCorner<9, 9>().ldlt().solve(e));
    }
    EXPECT_GT(sum / kRuns, 4.0) << depth_share;
    EXPECT_LT(sum / kRuns, 12.2) << depth_share;
  }
}

}  // namespace
}  // namespace vsslam

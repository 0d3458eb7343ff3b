#include "sensors/lidar/lidar.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/ordered_parallel.h"
#include "sensors/lidar/lidar_beams.h"
#include "sensors/lidar/lidar_echo.h"
#include "sensors/lidar/lidar_errors.h"

namespace vsslam {

namespace {

constexpr size_t kBlocksPerPiece = 8;  ///< of parallel work

/// Returns of a block before they are put in order of firing.
struct BlockReturns {
  std::array<EchoPacket, kMaxLasers> echoes;
  std::array<ReportedPacket, kMaxLasers> reported;
  std::array<PointPacket, kMaxLasers> points;
};

/// Output of one piece of parallel work, in order of firing. Kept from scan to scan.
struct Piece {
  std::vector<LidarPoint> points;
  std::vector<PointTruth> truth;
  size_t size = 0;
};

/// From the world to the LiDAR frame at the scan's stamp: points and normals of an echo.
class ScanFrame {
 public:
  explicit ScanFrame(const SE3& T_world_lidar)
      : R_lidar_world_(T_world_lidar.matrix3().transpose()), origin_world_(T_world_lidar.translation) {}
  void enter(EchoPacket& echo) const {
    const Vec3 o = origin_world_;
    const Mat3 R = R_lidar_world_;
    turn(R.cast<float>(), echo.normal_x, echo.normal_y, echo.normal_z);
    for (int i = 0; i < kLanes; ++i) {
      echo.x[i] = static_cast<float>(echo.x[i] - o.x());
      echo.y[i] = static_cast<float>(echo.y[i] - o.y());
      echo.z[i] = static_cast<float>(echo.z[i] - o.z());
    }
    turn(R.cast<float>(), echo.x, echo.y, echo.z);
  }

 private:
  static void turn(const Eigen::Matrix3f& R, float (&x)[kLanes], float (&y)[kLanes], float (&z)[kLanes]) {
    const float r00 = R(0, 0), r01 = R(0, 1), r02 = R(0, 2), r10 = R(1, 0), r11 = R(1, 1), r12 = R(1, 2),
                r20 = R(2, 0), r21 = R(2, 1), r22 = R(2, 2);
#pragma GCC ivdep
    for (int i = 0; i < kLanes; ++i) {
      const float a = x[i], b = y[i], c = z[i];
      x[i] = r00 * a + r01 * b + r02 * c;
      y[i] = r10 * a + r11 * b + r12 * c;
      z[i] = r20 * a + r21 * b + r22 * c;
    }
  }
  Mat3 R_lidar_world_;
  Vec3 origin_world_;
};

}  // namespace

struct Lidar::Impl {
  Impl(const LidarConfig& c, const SensorEvents& e, uint64_t seed, const Raycaster& r)
      : config(c),
        events(e),
        table(laser_table(c.model)),
        raycaster(r),
        rotation(c, seed),
        beams(c, table),
        receiver(c, r.world()),
        errors(c, table.lasers.size(), seed),
        lost_packets(seed, "events.lidar_lost_packets") {}

  LidarConfig config;
  SensorEvents events;
  const LaserTable& table;
  const Raycaster& raycaster;
  LidarRotation rotation;
  Beams beams;
  EchoReceiver receiver;
  LidarErrors errors;
  RandomStream lost_packets;

  bool wants_truth = true;  ///< of points
  CycleAzimuths azimuths;
  std::vector<Piece> pieces;

  Time cycle_time(int64_t cycle) const { return Time{cycle * table.cycle_ns}; }
  size_t block_count(const Revolution& revolution) const {
    return static_cast<size_t>((revolution.cycles + kLanes - 1) / kLanes);
  }
  FiringBlock block_of(const Revolution& revolution, size_t index, const Trajectory& trajectory,
                       const SE3& T_base_lidar) const;
  uint32_t closed_cycles(const Revolution& revolution, const FiringBlock& block) const;
  bool closed(int64_t cycle, double azimuth_rad) const;
  void fire(const Revolution& revolution, const FiringBlock& block, const ScanFrame& frame,
            Piece& piece) const;
  void emit(const FiringBlock& block, const BlockReturns& returns, Piece& piece) const;
};

Lidar::Lidar(const LidarConfig& config, const SensorEvents& events, uint64_t seed, const Raycaster& raycaster)
    : impl_(std::make_unique<Impl>(config, events, seed, raycaster)) {}
Lidar::~Lidar() = default;

void Lidar::leave_out_truth() {
  impl_->wants_truth = false;
}

Revolution Lidar::power_on(Time stamp) {
  const int64_t cycle_ns = impl_->table.cycle_ns;
  int64_t cycle = stamp.ns / cycle_ns;
  if (cycle * cycle_ns < stamp.ns) ++cycle;
  return impl_->rotation.power_on(cycle);
}

Revolution Lidar::after(const Revolution& revolution) const {
  return impl_->rotation.after(revolution);
}

Time Lidar::begin(const Revolution& revolution) const {
  return impl_->cycle_time(revolution.first_cycle);
}

Time Lidar::end(const Revolution& revolution) const {
  return impl_->cycle_time(revolution.first_cycle + revolution.cycles - 1) +
         Duration{impl_->table.lasers.back().fire_offset_ns};
}

FiringBlock Lidar::Impl::block_of(const Revolution& revolution, size_t index, const Trajectory& trajectory,
                                  const SE3& T_base_lidar) const {
  FiringBlock block;
  block.first = index * kLanes;
  block.count = std::min(kLanes, static_cast<int>(static_cast<size_t>(revolution.cycles) - block.first));
  const Time begin = cycle_time(revolution.first_cycle + static_cast<int64_t>(block.first));
  const Time end = begin + Duration{(block.count - 1) * table.cycle_ns + table.lasers.back().fire_offset_ns};
  if (config.pose_per_firing)
    block.poses = FiringPoses::fit(trajectory, T_base_lidar, begin, end);
  else
    block.poses = FiringPoses::fixed(trajectory.pose(cycle_time(revolution.first_cycle)) * T_base_lidar);
  return block;
}

bool Lidar::Impl::closed(int64_t cycle, double azimuth_rad) const {
  const Time stamp = cycle_time(cycle);
  if (any_lasts(events.lidar_dropouts, stamp)) return true;
  const auto packet = static_cast<uint64_t>(cycle / (table.cycles_per_block * table.blocks_per_packet));
  for (size_t i = 0; i < events.lidar_lost_packets.size(); ++i) {
    const LostPackets& lost = events.lidar_lost_packets[i];
    if (lost.contains(stamp) && lost_packets.uniform(packet, i) < lost.probability) return true;
  }
  return std::any_of(
      events.lidar_blocked_sectors.begin(), events.lidar_blocked_sectors.end(),
      [&](const BlockedSector& sector) { return sector.contains(stamp) && sector.covers(azimuth_rad); });
}

uint32_t Lidar::Impl::closed_cycles(const Revolution& revolution, const FiringBlock& block) const {
  uint32_t bits = 0;
  if (events.lidar_dropouts.empty() && events.lidar_lost_packets.empty() &&
      events.lidar_blocked_sectors.empty())
    return bits;
  for (int i = 0; i < block.count; ++i) {
    const size_t cycle = block.first + static_cast<size_t>(i);
    const double azimuth_rad = std::atan2(azimuths.actual.sine[cycle], azimuths.actual.cosine[cycle]);
    if (closed(revolution.first_cycle + static_cast<int64_t>(cycle), azimuth_rad)) bits |= 1u << i;
  }
  return bits;
}

void Lidar::Impl::emit(const FiringBlock& block, const BlockReturns& returns, Piece& piece) const {
  LidarPoint* point = piece.points.data() + piece.size;
  PointTruth* truth = wants_truth ? piece.truth.data() + piece.size : nullptr;
  for (int i = 0; i < block.count; ++i) {
    const int64_t cycle_ns = (static_cast<int64_t>(block.first) + i) * table.cycle_ns;
    for (size_t laser = 0; laser < beams.lasers; ++laser) {
      const ReportedPacket& reported = returns.reported[laser];
      if (!reported.any[i]) continue;
      const PointPacket& at = returns.points[laser];
      const Laser& mount = table.lasers[laser];
      const auto time_s = static_cast<float>(1e-9 * static_cast<double>(cycle_ns + mount.fire_offset_ns));
      *point++ = {at.x[i], at.y[i], at.z[i], reported.intensity[i], mount.ring, time_s};
      if (!wants_truth) continue;
      const EchoPacket& echo = returns.echoes[laser];
      *truth++ = {{echo.x[i], echo.y[i], echo.z[i]},
                  {echo.normal_x[i], echo.normal_y[i], echo.normal_z[i]},
                  echo.range_m[i],
                  echo.cos_incidence[i],
                  echo.object[i],
                  echo.triangle[i],
                  static_cast<uint16_t>(echo.material[i])};
    }
  }
  piece.size = static_cast<size_t>(point - piece.points.data());
}

void Lidar::Impl::fire(const Revolution& revolution, const FiringBlock& block, const ScanFrame& frame,
                       Piece& piece) const {
  BlockReturns returns;
  const uint32_t closed = closed_cycles(revolution, block);
  const int64_t first_cycle = revolution.first_cycle + static_cast<int64_t>(block.first);
  receiver.receive(raycaster, beams, block, azimuths, closed, {returns.echoes.data(), beams.lasers});
  for (size_t laser = 0; laser < beams.lasers; ++laser) {
    EchoPacket& echo = returns.echoes[laser];
    ReportedPacket& reported = returns.reported[laser];
    errors.report(echo, laser, first_cycle, reported);
    place_points(beams, laser, block, azimuths, reported.range_m, returns.points[laser]);
    if (wants_truth) frame.enter(echo);
  }
  emit(block, returns, piece);
}

LidarMeasurement Lidar::scan(const Revolution& revolution, const Trajectory& trajectory,
                             const SE3& T_base_lidar) {
  Impl& impl = *impl_;
  LidarMeasurement measurement;
  measurement.scan.stamp = measurement.true_stamp = begin(revolution);
  measurement.scan.end = end(revolution);
  measurement.T_world_lidar = trajectory.pose(begin(revolution)) * T_base_lidar;

  impl.rotation.azimuths(revolution, impl.azimuths);
  const ScanFrame frame(measurement.T_world_lidar);
  const size_t blocks = impl.block_count(revolution);
  impl.pieces.resize((blocks + kBlocksPerPiece - 1) / kBlocksPerPiece);
  parallel_pieces(blocks, kBlocksPerPiece, [&](size_t first, size_t last) {
    Piece& piece = impl.pieces[first / kBlocksPerPiece];
    piece.points.resize(kBlocksPerPiece * kLanes * impl.beams.lasers);
    if (impl.wants_truth) piece.truth.resize(piece.points.size());
    piece.size = 0;
    for (size_t b = first; b < last; ++b)
      impl.fire(revolution, impl.block_of(revolution, b, trajectory, T_base_lidar), frame, piece);
  });

  size_t total = 0;
  for (const Piece& piece : impl.pieces) total += piece.size;
  measurement.scan.points.reserve(total);
  if (impl.wants_truth) measurement.truth.reserve(total);
  for (const Piece& piece : impl.pieces) {
    const LidarPoint* const points = piece.points.data();
    measurement.scan.points.insert(measurement.scan.points.end(), points, points + piece.size);
    if (!impl.wants_truth) continue;
    const PointTruth* const truth = piece.truth.data();
    measurement.truth.insert(measurement.truth.end(), truth, truth + piece.size);
  }
  return measurement;
}

std::vector<RayPacket> Lidar::rays(const Revolution& revolution, const Trajectory& trajectory,
                                   const SE3& T_base_lidar) {
  Impl& impl = *impl_;
  impl.rotation.azimuths(revolution, impl.azimuths);
  std::vector<RayPacket> packets;
  for (size_t b = 0; b < impl.block_count(revolution); ++b) {
    const FiringBlock block = impl.block_of(revolution, b, trajectory, T_base_lidar);
    for (size_t laser = 0; laser < impl.beams.lasers; ++laser)
      make_rays(impl.beams, laser, 0, block, impl.azimuths, impl.config.max_range_m, 0,
                packets.emplace_back());
  }
  return packets;
}

}  // namespace vsslam

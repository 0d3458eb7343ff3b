#include "sensors/lidar.h"

#include <algorithm>
#include <cmath>

#include "core/ordered_parallel.h"
#include "sensors/lidar_beams.h"
#include "sensors/lidar_echo.h"
#include "sensors/lidar_errors.h"

namespace vsslam {

namespace {

constexpr size_t kMaxLasers = 32;
constexpr size_t kBlocksPerPiece = 16;  ///< of parallel work

/// Returns of a block before they are put in order of firing.
struct BlockReturns {
  std::array<EchoPacket, kMaxLasers> echoes;
  std::array<ReportedPacket, kMaxLasers> reported;
};

/// Output of one piece of parallel work, in order of firing. Kept from scan to scan.
struct Piece {
  std::vector<LidarPoint> points;
  std::vector<PointTruth> truth;
};

/// World to the LiDAR frame at the scan's stamp, as plain numbers.
struct ScanFrame {
  float r[3][3];
  double origin[3];
  explicit ScanFrame(const SE3& T_world_lidar) {
    const Mat3 R_lidar_world = T_world_lidar.matrix3().transpose();
    for (int i = 0; i < 3; ++i) {
      origin[i] = T_world_lidar.translation[i];
      for (int k = 0; k < 3; ++k) r[i][k] = static_cast<float>(R_lidar_world(i, k));
    }
  }
  Vec3f turn(float x, float y, float z) const {
    return {r[0][0] * x + r[0][1] * y + r[0][2] * z, r[1][0] * x + r[1][1] * y + r[1][2] * z,
            r[2][0] * x + r[2][1] * y + r[2][2] * z};
  }
  Vec3f move(float x, float y, float z) const {
    return turn(static_cast<float>(x - origin[0]), static_cast<float>(y - origin[1]),
                static_cast<float>(z - origin[2]));
  }
};

PointTruth truth_of(const EchoPacket& echo, int i, const ScanFrame& frame) {
  PointTruth truth;
  truth.position_lidar = frame.move(echo.x[i], echo.y[i], echo.z[i]);
  truth.normal_lidar = frame.turn(echo.normal_x[i], echo.normal_y[i], echo.normal_z[i]);
  truth.range_m = echo.range_m[i];
  truth.cos_incidence = echo.cos_incidence[i];
  truth.object = echo.object[i];
  truth.triangle = echo.triangle[i];
  truth.material = static_cast<uint16_t>(echo.material[i]);
  return truth;
}

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
  void emit(const Revolution& revolution, const FiringBlock& block, const BlockReturns& returns,
            const ScanFrame& frame, Piece& piece) const;
  LidarPoint point_of(const ReportedPacket& reported, int lane, size_t laser, size_t cycle) const;
};

Lidar::Lidar(const LidarConfig& config, const SensorEvents& events, uint64_t seed, const Raycaster& raycaster)
    : impl_(std::make_unique<Impl>(config, events, seed, raycaster)) {}
Lidar::~Lidar() = default;

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

LidarPoint Lidar::Impl::point_of(const ReportedPacket& reported, int lane, size_t laser, size_t cycle) const {
  const Laser& mount = table.lasers[laser];
  const SubRay& ray = beams.ray(laser, 0);
  const double a = azimuths.reported.step_rad[cycle] * static_cast<double>(mount.fire_offset_ns) /
                   static_cast<double>(table.cycle_ns);
  const double ca = 1 - a * a / 2, sa = a * (1 - a * a / 6);
  const double c = azimuths.reported.cosine[cycle] * ca - azimuths.reported.sine[cycle] * sa;
  const double s = azimuths.reported.sine[cycle] * ca + azimuths.reported.cosine[cycle] * sa;
  const double range = reported.range_m[lane], across = range * ray.cos_elevation;
  LidarPoint point;
  point.x = static_cast<float>(across * (c * ray.cos_offset - s * ray.sin_offset));
  point.y = static_cast<float>(across * (s * ray.cos_offset + c * ray.sin_offset));
  point.z = static_cast<float>(range * ray.sin_elevation + mount.dz_m);
  point.intensity = reported.intensity[lane];
  point.ring = mount.ring;
  point.time_s = static_cast<float>(
      1e-9 * static_cast<double>(static_cast<int64_t>(cycle) * table.cycle_ns + mount.fire_offset_ns));
  return point;
}

void Lidar::Impl::emit(const Revolution&, const FiringBlock& block, const BlockReturns& returns,
                       const ScanFrame& frame, Piece& piece) const {
  for (int i = 0; i < block.count; ++i) {
    for (size_t laser = 0; laser < beams.lasers; ++laser) {
      if (!returns.reported[laser].any[i]) continue;
      piece.points.push_back(
          point_of(returns.reported[laser], i, laser, block.first + static_cast<size_t>(i)));
      piece.truth.push_back(truth_of(returns.echoes[laser], i, frame));
    }
  }
}

void Lidar::Impl::fire(const Revolution& revolution, const FiringBlock& block, const ScanFrame& frame,
                       Piece& piece) const {
  BlockReturns returns;
  const uint32_t closed = closed_cycles(revolution, block);
  const int64_t first_cycle = revolution.first_cycle + static_cast<int64_t>(block.first);
  for (size_t laser = 0; laser < beams.lasers; ++laser) {
    receiver.receive(raycaster, beams, laser, block, azimuths, closed, returns.echoes[laser]);
    errors.report(returns.echoes[laser], laser, first_cycle, returns.reported[laser]);
  }
  emit(revolution, block, returns, frame, piece);
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
    piece.points.clear();
    piece.truth.clear();
    for (size_t b = first; b < last; ++b)
      impl.fire(revolution, impl.block_of(revolution, b, trajectory, T_base_lidar), frame, piece);
  });

  size_t total = 0;
  for (const Piece& piece : impl.pieces) total += piece.points.size();
  measurement.scan.points.reserve(total);
  measurement.truth.reserve(total);
  for (const Piece& piece : impl.pieces) {
    measurement.scan.points.insert(measurement.scan.points.end(), piece.points.begin(), piece.points.end());
    measurement.truth.insert(measurement.truth.end(), piece.truth.begin(), piece.truth.end());
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

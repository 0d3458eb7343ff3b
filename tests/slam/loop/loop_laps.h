// Laps in a room, for loop closing.
#pragma once

#include <cmath>
#include <vector>

#include "slam/loop/local_map.h"
#include "slam/loop/loop_closer.h"
#include "tests/slam/loop/loop_room.h"

namespace vsslam {

inline constexpr double kMountHeight = 0.6;
inline const SE3 kBaseLidar(Quat::Identity(), {0.2, 0, 0.35});
inline const LidarCalibration kLidar{.T_base_lidar = kBaseLidar, .mount_height_m = kMountHeight};

struct Drive {
  std::vector<KeyScan> keys;
  std::vector<SE3> truth;  // T_map_base without drift
};

/// As seen from there, without drift. Its scene counts as distinct.
inline KeyScan key_scan_in(const TestRoom& room, int id, Time stamp, const SE3& T_map_base) {
  KeyScan key;
  key.id = id;
  key.stamp = stamp;
  key.points_lidar = share(scan_room(room, T_map_base * kBaseLidar));
  key.features_lidar = share(voxel_means(*key.points_lidar, 0.3));
  key.information = analyse_information(Vec6(300, 350, 400, 300, 350, 400).asDiagonal());
  key.T_map_base = key.T_odom_base = T_map_base;
  key.way_m = id;  // a key scan every metre
  return key;
}

/// Laps on a circle in a room, a key scan every metre and 1.5 s; every second lap in the other direction.
/// The belief drifts along x. Laps after the first run `aside_m` further out.
inline Drive laps(int count, double drift_m_per_key, double aside_m = 0) {
  Drive drive;
  for (int id = 0; id < count; ++id) {
    const int per_lap = 25, lap = id / per_lap;
    const bool back = lap % 2 == 1;
    const double angle = 2 * M_PI * (back ? per_lap - id % per_lap : id % per_lap) / per_lap;
    const double radius_m = lap > 0 ? 4 + aside_m : 4;
    const SE3 T_map_base =
        planar(radius_m * std::cos(angle), radius_m * std::sin(angle), angle + (back ? -M_PI / 2 : M_PI / 2),
               kMountHeight - kBaseLidar.translation.z());
    KeyScan key = key_scan_in(cluttered_room(), id, Time::from_seconds(1.5 * id), T_map_base);
    key.T_map_base = SE3(Quat::Identity(), {drift_m_per_key * id, 0, 0}) * T_map_base;
    key.T_odom_base = key.T_map_base;
    drive.keys.push_back(std::move(key));
    drive.truth.push_back(T_map_base);
  }
  return drive;
}

/// Along the middle of a long corridor, a key scan every metre and second.
inline Drive along_corridor(int count) {
  Drive drive;
  for (int id = 0; id < count; ++id) {
    const SE3 T_map_base = planar(id - count / 2.0, 0, 0, kMountHeight - kBaseLidar.translation.z());
    drive.keys.push_back(key_scan_in(long_corridor(), id, Time::from_seconds(id), T_map_base));
    drive.truth.push_back(T_map_base);
  }
  return drive;
}

inline std::vector<LoopRecord> play(LoopCloser& closer, const Drive& drive) {
  std::vector<LoopRecord> all;
  std::vector<KeyScan> so_far;
  for (const KeyScan& key : drive.keys) {
    so_far.push_back(key);
    for (LoopRecord& record : closer.add(so_far, key.stamp)) all.push_back(std::move(record));
  }
  return all;
}

inline double error_m(const LoopRecord& record, const Drive& drive) {
  const SE3 truth = drive.truth[static_cast<size_t>(record.match)].inverse() *
                    drive.truth[static_cast<size_t>(record.query)];
  return (truth.inverse() * record.T_match_query).translation.norm();
}

}  // namespace vsslam

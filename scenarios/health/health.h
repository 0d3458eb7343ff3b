// How the sensors and the front end fared in one run: `health` in metrics.json. Facts, and what follows from them.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/time.h"
#include "slam/odometry_health.h"

namespace vsslam {

/// What every sensor tells. A figure that too few samples were there for is absent, null in the file.
struct SensorHealth {
  int64_t used = 0;                          ///< samples that the front end was given
  std::map<std::string, int64_t> dropped{};  ///< samples that it was not given, by reason
  std::optional<double> rate_hz{};           ///< of the median interval
  /// Samples used of those that this rate would have given from the run's first sample to its last.
  std::optional<double> share_of_time{};
  std::optional<double> longest_gap_s{};     ///< to the end of the run, if the sensor fell silent
  std::optional<double> longest_gap_at_s{};  ///< its begin, since the first sample of the run

  bool present() const { return used > 0 || !dropped.empty(); }
  int64_t dropped_count() const;
};

struct ImuHealth : SensorHealth {
  std::optional<double> gravity_mps2{};  ///< mean specific force at rest, else over the whole run
  std::optional<double>
      gravity_tilt_deg{};  ///< its direction against +z of the base, through the sheet's mount
  bool gravity_at_rest = false;
  /// Gyroscope against the LiDAR's rotation, in the base frame: 1 and 1 where they agree. Absent where the robot hardly
  /// turned. The scale is 57.3 in degrees, and negative about an inverted axis.
  std::optional<double> gyro_scale{}, gyro_correlation{};
  std::array<std::optional<double>, 3> gyro_axis_scale{};  ///< about x, y and z of the base
};

struct WheelsHealth : SensorHealth {
  std::optional<double> travel_scale{};  ///< travel of the wheels by that of the LiDAR
  std::optional<double>
      yaw_scale{};  ///< turning of the wheels by that of the LiDAR: the sheet's track is off by it
};

struct LidarHealth : SensorHealth {
  std::optional<double> points_mean{};
  int64_t without_points = 0;
};

struct CameraHealth : SensorHealth {
  std::optional<double> grey_mean{};  ///< 0 to 255
  int64_t dark = 0;                   ///< images too dark to track anything in
  int64_t frozen = 0;                 ///< images that are, byte for byte, the one before
};

/// One scan in twenty without the LiDAR: a prior drifts by centimetres in it, and the map shows it.
inline constexpr double kBlindShare = 0.05;

struct Health {
  ImuHealth imu;
  WheelsHealth wheels;
  LidarHealth lidar;
  CameraHealth camera;
  /// What the front end says; its repairs and warnings are below. The first scan, which begins the map, is not counted
  /// among those without the LiDAR or without convergence.
  OdometryHealth odometry;
  std::vector<std::string> repairs;   ///< what was certain and set right
  std::vector<std::string> warnings;  ///< what is doubtful, with what can be done
  std::string worthless;              ///< why the result is worth nothing; empty (null in the file): it is

  bool good() const { return warnings.empty() && worthless.empty(); }
  /// Share of the scans in which the LiDAR gave nothing, 0 without scans.
  double blind_share() const;
  /// The trajectory is in part not what this method found: its errors are shown with a mark.
  bool blind() const { return !worthless.empty() || blind_share() > kBlindShare; }
  /// "ok", "2 warnings" or "worthless".
  std::string verdict() const;
};

/// Stamps of lost spans are written with `stamp_offset` added.
nlohmann::ordered_json health_json(const Health& health, Duration stamp_offset);

/// What a person must be told at the end, one line each; empty if all is well. What the source set right was told as it
/// was read.
std::string health_text(const Health& health);

}  // namespace vsslam

// What goes wrong with sensors, and what moves in the world: part of the scenario's `events`.
#pragma once

#include <string>
#include <vector>

#include "core/config.h"
#include "core/time.h"

namespace vsslam {

/// from_s <= t < to_s, seconds of true time since the start of the scenario.
struct EventSpan {
  double from_s = 0, to_s = 1e9;
  bool contains(Time stamp) const { return stamp.seconds() >= from_s && stamp.seconds() < to_s; }
  void fields(Fields& f);
};

enum class SensorKind { lidar, imu, wheels, camera };

/// The sensor delivers nothing.
struct SensorDropout : EventSpan {};

/// Data packets of the LiDAR vanish, each with this probability.
struct LostPackets : EventSpan {
  double probability = 0.1;
  void fields(Fields& f);
};

/// Something covers the LiDAR's window. Azimuths in the lidar frame, counter-clockwise from forward, from
/// `from_deg` on to `to_deg`.
struct BlockedSector : EventSpan {
  double from_deg = 0, to_deg = 0;
  bool covers(double azimuth_rad) const;
  void fields(Fields& f);
};

/// Something covers the camera's lens. This share of the light that should enter reaches the pixels, all of them alike.
struct CoveredLens : EventSpan {
  double transmission = 0.002;
  void fields(Fields& f);
};

/// Single samples of the IMU are off by this magnitude, in a random direction, each with this probability.
struct ImuSpikes : EventSpan {
  double probability = 0.01;
  double gyro_radps = 0, accel_mps2 = 0;
  void fields(Fields& f);
};

/// Wrong stamps of one sensor; when it measures does not change. Jitter is uniform in +-jitter_s, at most
/// 0.49 periods, so that it alone does not change the order of samples.
struct ClockError : EventSpan {
  SensorKind sensor = SensorKind::lidar;
  double offset_s = 0, jitter_s = 0;
  void fields(Fields& f);
};

/// An object of the world appears, disappears, or slides (a door: its own width within a second).
struct ObjectEvent {
  enum class Action { appear, disappear, slide };
  std::string object;
  double at_s = 0;
  Action action = Action::slide;
  Vec3 by_m = Vec3::Zero();  ///< slide: in the world frame
  double duration_s = 1;     ///< slide: at even speed
  void fields(Fields& f);
};

/// Lamps that go off, on, or are dimmed. For cameras; a LiDAR does not notice.
struct LightEvent {
  double at_s = 0;
  std::string group;  ///< of lights; empty: all
  double level = 0;   ///< share of the intensity that the lighting gives them
  void fields(Fields& f);
};

/// All lists may be empty. `fields` lists the keys of the scenario's `events` that concern sensors,
/// objects and lights.
struct SensorEvents {
  std::vector<SensorDropout> lidar_dropouts, imu_dropouts, wheel_dropouts, camera_dropouts;
  std::vector<LostPackets> lidar_lost_packets;
  std::vector<BlockedSector> lidar_blocked_sectors;
  std::vector<CoveredLens> camera_covered;
  std::vector<ImuSpikes> imu_spikes;
  std::vector<ClockError> clocks;
  std::vector<ObjectEvent> objects;
  std::vector<LightEvent> lights;
  void fields(Fields& f);
};

/// True while any of the spans lasts.
bool any_lasts(const std::vector<SensorDropout>& spans, Time stamp);

}  // namespace vsslam

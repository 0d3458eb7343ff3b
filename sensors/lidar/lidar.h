// A rotating multi-beam LiDAR: VLP-16 and VLP-32C are the same code with another table.
//
// Frame `lidar`: x forward, y left, z up along the axis. The head turns clockwise seen from above and starts
// each revolution forward. Points are computed as a driver does it, from the reported (quantised) range and
// azimuth and the nominal elevation, in the lidar frame of the moment of firing.
#pragma once

#include <memory>

#include "sensors/lidar/lidar_config.h"
#include "sensors/lidar/lidar_rotation.h"
#include "sensors/measurement/samples.h"
#include "sensors/measurement/sensor_events.h"
#include "sensors/ray/raycaster.h"
#include "sim/trajectory.h"

namespace vsslam {

class Lidar {
 public:
  /// The raycaster's materials are read once. It must outlive the LiDAR.
  Lidar(const LidarConfig& config, const SensorEvents& events, uint64_t seed, const Raycaster& raycaster);
  ~Lidar();

  /// The first revolution begins with the first firing cycle at or after `stamp`.
  Revolution power_on(Time stamp);
  Revolution after(const Revolution& revolution) const;
  Time begin(const Revolution& revolution) const;  ///< first firing
  Time end(const Revolution& revolution) const;    ///< last firing

  /// From here on scans come without the truth of their points.
  void leave_out_truth();
  /// One revolution along the trajectory, which must cover it. The same for any number of threads.
  LidarMeasurement scan(const Revolution& revolution, const Trajectory& trajectory, const SE3& T_base_lidar);
  /// The rays of the beams' centres that scan() traces, packet by packet in its order.
  std::vector<RayPacket> rays(const Revolution& revolution, const Trajectory& trajectory,
                              const SE3& T_base_lidar);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace vsslam

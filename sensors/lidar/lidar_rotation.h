// The motor and its encoder: where the head points at each firing cycle, and what it reports.
//
// Angles are counter-clockwise about the lidar frame's z, 0 = forward; the head turns clockwise, so they
// fall.
#pragma once

#include <cstdint>
#include <vector>

#include "sensors/lidar/lidar_config.h"
#include "sensors/measurement/noise.h"

namespace vsslam {

/// Firing cycles of one turn. A turn has no whole number of cycles, so its first azimuth differs every time.
struct Revolution {
  int64_t index = 0;
  int64_t first_cycle = 0;  ///< cycles are counted from time 0
  int64_t cycles = 0;
};

/// Per firing cycle of a revolution: direction at the start of the cycle, and how far it turns until the
/// next.
struct CycleAzimuths {
  struct Turning {
    std::vector<double> cosine, sine, step_rad;
    void resize(size_t cycles);
    void set(size_t cycle, double angle_rad, double step);
    void repeat(size_t cycle);  ///< the one before
  };
  Turning actual;    ///< where the beam goes
  Turning reported;  ///< what the data packets say
};

class LidarRotation {
 public:
  LidarRotation(const LidarConfig& config, uint64_t seed);

  /// The first revolution begins at azimuth 0 with this cycle.
  Revolution power_on(int64_t first_cycle);
  Revolution after(const Revolution& revolution) const;
  void azimuths(const Revolution& revolution, CycleAzimuths& out) const;

 private:
  Revolution revolution_from(int64_t index, int64_t first_cycle) const;
  /// Since power-on.
  double turns(int64_t cycle, SlowNoise::Cache& cache) const;
  /// Encoder reading at the start of a data block, where the head stands at `actual_turns`.
  double reported_turns(int64_t block, double actual_turns) const;

  double cycle_s_, turns_per_cycle_;
  int cycles_per_block_;
  double step_turns_, jitter_turns_, wander_turns_;
  SlowNoise wander_;
  RandomStream jitter_;
  int64_t origin_cycle_ = 0;
  double origin_wander_turns_ = 0;
};

}  // namespace vsslam

// Turns of a LiDAR whose driver sends them in parts: a cloud for every packet, or for a half or a quarter of a turn.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "core/samples.h"

namespace vsslam {

/// Where points are, seen from above: all but the largest gap between their azimuths. Counter-clockwise.
struct Sector {
  double begin_rad = 0, width_rad = 0;
  double middle_rad() const { return begin_rad + width_rad / 2; }
};
/// nullopt: no points.
std::optional<Sector> sector_of(const std::vector<LidarPoint>& points);

/// How clouds make up turns.
struct TurnParts {
  double every_s = 0;  ///< from one cloud to the next
  double turn_s = 0;   ///< that they take for a turn
};
/// nullopt: each cloud is a turn, or all look the same way: that is so unless most lie beside the one before, hardly over
/// it. From some clouds in a row, at least 4.
std::optional<TurnParts> parts_of_turns(std::span<const LidarScan> clouds);

/// Puts parts together until the next would begin another turn.
class TurnAssembler {
 public:
  /// A whole turn once the next part has come. It begins at its first part's stamp and ends with its last.
  std::optional<LidarScan> add(LidarScan part);
  /// What is left at the end, if it is nearly a turn.
  std::optional<LidarScan> rest();
  /// Left out: turns of which parts are missing.
  int broken() const { return broken_; }

 private:
  void begin(LidarScan part, double middle_rad);
  void append(const LidarScan& part);
  std::optional<LidarScan> finish();

  std::optional<LidarScan> turn_;
  double middle_rad_ = 0, swept_rad_ = 0, step_rad_ = 0;  // of the last part; since the first; to the last
  int broken_ = 0;
};

}  // namespace vsslam

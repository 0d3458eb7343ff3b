// Point clouds of other people's drivers as scans: finds out what each field means, once, and says so.
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/samples.h"
#include "scenarios/datasets/import/decoders/ring_finder.h"
#include "scenarios/datasets/import/decoders/turn_assembler.h"
#include "scenarios/datasets/messages/messages.h"

namespace vsslam {

/// Clouds of one topic, in order. Needed: x, y, z. Used if there: an intensity; the ring, if it makes sense, else derived
/// from elevation (rings_known tells whether the lasers separate there); the time of each point, else derived from azimuth
/// (the LiDAR turns clockwise, seen from above; then times_known is false) if scans come as regularly as a scanner turns.
///
/// Times may be seconds, milliseconds, microseconds or nanoseconds (told apart by how long the scan lasts), counted from
/// the stamp, from 1970 or from anywhere: times that go on from cloud to cloud as the stamps do are not counted from them.
/// A stamp at the end of the scan is moved to its first point. Times that are all the same mean a scan without motion in it.
class CloudDecoder {
 public:
  struct Options {
    int rings = 16;
    bool undistorted = false;          ///< every point counts as fired at the stamp
    std::optional<TurnParts> parts{};  ///< clouds are parts of turns
  };
  explicit CloudDecoder(const Options& options) : options_(options), rings_(options.rings) {}

  /// Points that are not finite, in place or time, or at the origin, are dropped; the rest is in order of time. scan.end is the last
  /// point's time. Throws InputError that starts with `place`.
  LidarScan decode(const PointCloudMessage& cloud, std::string_view place);
  /// Fields that are missing and what stands for them.
  const std::vector<std::string>& notes() const { return notes_; }

 private:
  struct Layout;
  Layout layout_of(const PointCloudMessage& cloud, std::string_view place) const;
  void read_points(const PointCloudMessage& cloud, const Layout& layout, LidarScan& scan,
                   std::vector<double>& rings, std::vector<double>& times) const;
  void settle_rings(LidarScan& scan, const std::vector<double>& rings, std::vector<double>& times);
  double zero_of_times(Time stamp, double first_s, double last_s);
  void set_times(LidarScan& scan, std::vector<double>& times, bool seconds_as_float, std::string_view place);
  void learn_turn(double since_s);
  void derive_times(LidarScan& scan);
  double unit_s(double span) const;
  void note(const std::string& text);

  Options options_;
  RingFinder rings_;
  std::optional<double> unit_s_;
  std::optional<double> last_first_s_;  // time of the first point of the cloud before, as it has it
  std::optional<bool> running_;         // do the points' times go on from cloud to cloud?
  std::optional<Time> last_header_;
  std::optional<Time> last_stamp_;
  double turn_s_ = std::numeric_limits<double>::infinity();  // the shortest time between scans
  int alike_ = 0, others_ = 0;                                // intervals about as long, and longer ones
  bool turns_ = true;
  std::vector<std::string> notes_;
};

/// Revolutions of points without times: fills time_s from azimuth, `period_s` for a whole turn. Points in order of firing
/// may turn a little more than once; others, ring by ring, turn once each.
void times_from_azimuth(LidarScan& scan, double period_s);

/// Sorts by time_s unless it is sorted; points of the same time keep their order.
void sort_by_time(LidarScan& scan);

}  // namespace vsslam

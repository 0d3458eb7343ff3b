#include "scenarios/datasets/import/decoders/cloud_decoder.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <initializer_list>
#include <numbers>
#include <utility>

#include "core/errors.h"

namespace vsslam {

namespace {

using Field = PointCloudMessage::Field;

constexpr double kLongestScan_s = 10;
constexpr double kUsualTurn_s = 0.1;  // of the first scan, before a second tells

size_t bytes_of(uint8_t datatype) {
  switch (datatype) {
    case Field::i8:
    case Field::u8:
      return 1;
    case Field::i16:
    case Field::u16:
      return 2;
    case Field::i32:
    case Field::u32:
    case Field::f32:
      return 4;
    case Field::f64:
      return 8;
    default:
      return 0;
  }
}

template <class T>
double value_at(const uint8_t* bytes) {
  T value;
  std::memcpy(&value, bytes, sizeof value);
  return static_cast<double>(value);
}

double number_at(const uint8_t* bytes, uint8_t datatype) {
  switch (datatype) {
    case Field::i8:
      return value_at<int8_t>(bytes);
    case Field::u8:
      return value_at<uint8_t>(bytes);
    case Field::i16:
      return value_at<int16_t>(bytes);
    case Field::u16:
      return value_at<uint16_t>(bytes);
    case Field::i32:
      return value_at<int32_t>(bytes);
    case Field::u32:
      return value_at<uint32_t>(bytes);
    case Field::f32:
      return value_at<float>(bytes);
    default:
      return value_at<double>(bytes);
  }
}

const Field* find(const PointCloudMessage& cloud, std::initializer_list<std::string_view> names) {
  for (const std::string_view name : names)
    for (const Field& field : cloud.fields)
      if (field.name == name) return &field;
  return nullptr;
}

std::string names_of(const PointCloudMessage& cloud) {
  std::vector<std::string> names;
  for (const Field& field : cloud.fields) names.push_back(field.name);
  return fmt::format("{}", fmt::join(names, " "));
}

void check_sizes(const PointCloudMessage& cloud, std::string_view place) {
  if (cloud.is_bigendian)
    throw InputError(fmt::format("{}: a cloud of big-endian numbers is not read", place));
  const uint64_t row = uint64_t{cloud.point_step} * cloud.width,
                 all = uint64_t{cloud.row_step} * cloud.height;
  if (row > cloud.row_step || all > cloud.data.size())
    throw InputError(
        fmt::format("{}: expected {} x {} points of {} bytes in rows of {} bytes, got {} bytes of data",
                    place, cloud.height, cloud.width, cloud.point_step, cloud.row_step, cloud.data.size()));
  for (const Field& field : cloud.fields) {
    const size_t bytes = bytes_of(field.datatype) * std::max<size_t>(1, field.count);
    if (bytes == 0 || uint64_t{field.offset} + bytes > cloud.point_step)
      throw InputError(
          fmt::format("{}: field \"{}\" (type {}, offset {}) does not lie within the {} bytes of a point",
                      place, field.name, field.datatype, field.offset, cloud.point_step));
  }
}

double azimuth_rad(const LidarPoint& p) {
  return std::atan2(static_cast<double>(p.y), static_cast<double>(p.x));
}

}  // namespace

struct CloudDecoder::Layout {
  const Field *x, *y, *z, *intensity, *ring, *time;
};

CloudDecoder::Layout CloudDecoder::layout_of(const PointCloudMessage& cloud, std::string_view place) const {
  check_sizes(cloud, place);
  Layout layout{.x = find(cloud, {"x"}),
                .y = find(cloud, {"y"}),
                .z = find(cloud, {"z"}),
                .intensity = find(cloud, {"intensity", "intensities", "reflectivity", "i"}),
                .ring = find(cloud, {"ring", "line", "channel", "laser_id"}),
                .time = find(cloud, {"time", "t", "timestamp", "offset_time", "time_stamp", "time_offset"})};
  if (layout.x == nullptr || layout.y == nullptr || layout.z == nullptr)
    throw InputError(fmt::format("{}: expected the fields x y z, got: {}", place, names_of(cloud)));
  return layout;
}

void CloudDecoder::note(const std::string& text) {
  if (std::find(notes_.begin(), notes_.end(), text) == notes_.end()) notes_.push_back(text);
}

LidarScan CloudDecoder::decode(const PointCloudMessage& cloud, std::string_view place) {
  const Layout layout = layout_of(cloud, place);
  LidarScan scan{.stamp = cloud.header.stamp, .end = cloud.header.stamp, .points = {}};
  std::vector<double> rings, times;
  read_points(cloud, layout, scan, rings, times);
  if (layout.ring == nullptr) {
    note("no field of rings: derived from the points' elevation");
    scan.rings_known = rings_.fill(scan.points);
  } else {
    settle_rings(scan, rings, times);
  }
  if (options_.parts) {
    turn_s_ = options_.parts->turn_s;
  } else if (last_stamp_) {
    learn_turn(seconds_between(*last_stamp_, scan.stamp));
  }
  last_stamp_ = scan.stamp;
  if (options_.undistorted) {
    note("points count as undistorted: all as fired at the stamp");
    scan.times_known = false;
  } else if (layout.time == nullptr) {
    note("no field of times: derived from the points' azimuth");
    derive_times(scan);
    scan.times_known = false;
  } else {
    set_times(scan, times, layout.time->datatype == Field::f32, place);
  }
  sort_by_time(scan);
  if (!scan.points.empty())
    scan.end = scan.stamp + Duration::from_seconds(static_cast<double>(scan.points.back().time_s));
  return scan;
}

void CloudDecoder::read_points(const PointCloudMessage& cloud, const Layout& layout, LidarScan& scan,
                               std::vector<double>& rings, std::vector<double>& times) const {
  if (cloud.width == 0) return;  // in however many rows
  scan.points.reserve(size_t{cloud.width} * cloud.height);
  for (uint32_t row = 0; row < cloud.height; ++row) {
    const uint8_t* point = cloud.data.data() + size_t{row} * cloud.row_step;
    for (uint32_t i = 0; i < cloud.width; ++i, point += cloud.point_step) {
      const auto number = [point](const Field* f) { return number_at(point + f->offset, f->datatype); };
      LidarPoint p{.x = static_cast<float>(number(layout.x)),
                   .y = static_cast<float>(number(layout.y)),
                   .z = static_cast<float>(number(layout.z))};
      if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) continue;
      if (p.x == 0 && p.y == 0 && p.z == 0) continue;
      if (layout.intensity != nullptr) p.intensity = static_cast<float>(number(layout.intensity));
      if (layout.time != nullptr) {
        const double time = number(layout.time);
        if (!std::isfinite(time)) continue;
        times.push_back(time);
      }
      if (layout.ring != nullptr) rings.push_back(number(layout.ring));
      scan.points.push_back(p);
    }
  }
}

// A few points of rings that there are not are left out.
void CloudDecoder::settle_rings(LidarScan& scan, const std::vector<double>& rings,
                                std::vector<double>& times) {
  if (const auto fault = fault_of_rings(scan.points, rings, options_.rings)) {
    note(fmt::format("the field of rings says nothing: {}: derived from the points' elevation", *fault));
    scan.rings_known = rings_.fill(scan.points);
    return;
  }
  size_t kept = 0;
  for (size_t i = 0; i < scan.points.size(); ++i) {
    if (!(rings[i] >= 0 && rings[i] < options_.rings)) continue;
    scan.points[kept] = scan.points[i];
    scan.points[kept].ring = static_cast<uint16_t>(rings[i]);
    if (!times.empty()) times[kept] = times[i];
    ++kept;
  }
  if (kept == scan.points.size()) return;
  note(fmt::format("some points are of rings that there are not (of {}): left out", options_.rings));
  scan.points.resize(kept);
  if (!times.empty()) times.resize(kept);
}

// A scan lasts between 10 ms and 1.5 s, a part of one about from one to the next.
double CloudDecoder::unit_s(double span) const {
  const double least_s = options_.parts ? options_.parts->every_s / 30 : 0.01,
               most_s = options_.parts ? options_.parts->every_s * 3 : 1.5;
  for (const double unit : {1.0, 1e-3, 1e-6, 1e-9})
    if (span * unit >= least_s && span * unit <= most_s) return unit;
  return 0;
}

void CloudDecoder::set_times(LidarScan& scan, std::vector<double>& times, bool seconds_as_float,
                             std::string_view place) {
  if (times.empty()) return;
  const auto [low, high] = std::minmax_element(times.begin(), times.end());
  const double first = *low, span = *high - *low;
  if (span == 0 && !unit_s_) {
    note("the points' times are all the same: scans count as taken at their stamps, undistorted");
    scan.times_known = false;
    return;
  }
  if (!unit_s_) {
    const double unit = unit_s(span);
    if (unit == 0 || (seconds_as_float && unit != 1))
      note(fmt::format("a scan lasts {} by its points' times: taken as {}", span,
                       unit == 0 ? "seconds" : fmt::format("{} s", unit)));
    unit_s_ = unit == 0 ? 1 : unit;
  }
  if (!(span * *unit_s_ <= kLongestScan_s))
    throw InputError(fmt::format("{}: the points' times span {} s", place, span * *unit_s_));
  const double zero_s = zero_of_times(scan.stamp, first * *unit_s_, *high * *unit_s_);
  const double zero = zero_s == first * *unit_s_ ? first : zero_s / *unit_s_;
  double shift_s = 0;
  if (const double offset_s = (first - zero) * *unit_s_; offset_s < 0) {
    if (offset_s < -1e-3) note("stamps are not at the first point: moved there");
    shift_s = -offset_s;
    scan.stamp = scan.stamp - Duration::from_seconds(shift_s);
  }
  for (size_t i = 0; i < times.size(); ++i)
    scan.points[i].time_s = static_cast<float>((times[i] - zero) * *unit_s_ + shift_s);
}

// What the stamp is by the points' times: 0 if they are counted from it, its own value if from where it is counted; on a
// clock of their own the first point's. Times that go on as the stamps do are not counted from them.
double CloudDecoder::zero_of_times(Time stamp, double first_s, double last_s) {
  constexpr double kOff_s = 10, kLongest_s = 1.5;
  const double stamp_s = stamp.seconds();
  if (last_header_ && last_first_s_) {
    const double since_s = seconds_between(*last_header_, stamp), went_s = first_s - *last_first_s_;
    if (since_s > 0 && since_s < kLongest_s) running_ = std::abs(went_s - since_s) < std::abs(went_s);
  }
  last_header_ = stamp;
  last_first_s_ = first_s;
  const double from_stamp_s = std::min(std::abs(first_s), std::abs(last_s)),
               from_zero_s = std::min(std::abs(first_s - stamp_s), std::abs(last_s - stamp_s));
  const bool relative = running_ ? !*running_ && from_stamp_s <= kOff_s
                                 : from_stamp_s <= from_zero_s && from_stamp_s <= kLongest_s;
  if (relative) return 0;
  if (from_zero_s <= kOff_s) return stamp_s;
  note("the points' times are on another clock than the stamps: the first point's is taken for the stamp's");
  return first_s;
}

// A turn lasts as long as most scans are apart, if that is what scanners take (4 to 25 Hz). Of key scans picked from a
// drive it says nothing.
void CloudDecoder::learn_turn(double since_s) {
  constexpr double kShortest_s = 0.04, kLongest_s = 0.25, kAlike = 1.2;
  if (since_s < kShortest_s) return;
  if (since_s * kAlike < turn_s_) others_ += std::exchange(alike_, 0);  // those before were several turns
  if (since_s < turn_s_ * kAlike) {
    turn_s_ = std::min(turn_s_, since_s);
    ++alike_;
  } else {
    ++others_;
  }
  turns_ = turn_s_ <= kLongest_s && alike_ > others_;
}

void CloudDecoder::derive_times(LidarScan& scan) {
  if (!turns_) {
    note("scans at no regular rate: all points count as fired at the stamp");
    for (LidarPoint& p : scan.points) p.time_s = 0;
    return;
  }
  times_from_azimuth(scan, std::isfinite(turn_s_) ? turn_s_ : kUsualTurn_s);
}

void times_from_azimuth(LidarScan& scan, double period_s) {
  if (scan.points.empty()) return;
  constexpr double kTurn = 2 * std::numbers::pi;
  const double first_rad = azimuth_rad(scan.points.front());
  const size_t n = scan.points.size();
  const auto place = [n](size_t i) { return static_cast<double>(i) / static_cast<double>(n); };
  std::vector<double> turned(n);  // of a revolution, clockwise, 0 .. 1
  size_t together = 0;
  for (size_t i = 0; i < n; ++i) {
    const double share = (first_rad - azimuth_rad(scan.points[i])) / kTurn;
    turned[i] = share - std::floor(share);
    const double apart = std::abs(turned[i] - place(i));
    together += std::min(apart, 1 - apart) < 0.35;
  }
  // Points in order of firing turn as their number grows. Some then lie a little before the first, or beyond a turn.
  const bool in_order = static_cast<double>(together) >= 0.9 * static_cast<double>(n);
  for (size_t i = 0; i < n; ++i) {
    double share = turned[i];
    if (in_order && place(i) < 0.25 && share > 0.75) share = 0;
    if (in_order && place(i) > 0.75 && share < 0.25) share += 1;
    scan.points[i].time_s = static_cast<float>(share * period_s);
  }
}

void sort_by_time(LidarScan& scan) {
  const auto earlier = [](const LidarPoint& a, const LidarPoint& b) { return a.time_s < b.time_s; };
  if (!std::is_sorted(scan.points.begin(), scan.points.end(), earlier))
    std::stable_sort(scan.points.begin(), scan.points.end(), earlier);
}

}  // namespace vsslam

#include "scenarios/evaluation/trajectory_file.h"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>
#include <optional>

#include "core/errors.h"
#include "core/files.h"
#include "scenarios/evaluation/csv.h"

namespace vsslam {

namespace {

constexpr std::string_view kBlank = " \t\r";
constexpr double kLargestCoordinate_m = 1e9;

/// ORB-SLAM3 writes stamps in whole nanoseconds, with or without zeros behind a point. No seconds since 1970 are as
/// many, and parse_seconds() takes none of them.
std::optional<Time> parse_nanoseconds(std::string_view text) {
  const size_t point = std::min(text.find('.'), text.size());
  int64_t ns = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + point, ns);
  if (error != std::errc() || end != text.data() + point) return std::nullopt;
  if (text.find_first_not_of('0', std::min(point + 1, text.size())) != text.npos) return std::nullopt;
  return ns < 100'000'000'000'000'000 ? std::nullopt : std::optional(Time{ns});
}

/// Lines that are neither empty nor comments, cut at blanks.
class Lines {
 public:
  Lines(std::string_view text, const std::string& name) : rest_(text), name_(name) {}

  /// Moves to the next line; false at the end.
  bool next() {
    while (!rest_.empty()) {
      const size_t end = std::min(rest_.find('\n'), rest_.size());
      cut(rest_.substr(0, end));
      rest_.remove_prefix(std::min(end + 1, rest_.size()));
      ++line_;
      if (!words_.empty() && words_[0][0] != '#') return true;
    }
    return false;
  }

  const std::vector<std::string_view>& words() const { return words_; }
  void expect_words(size_t count, std::string_view what) const {
    if (words_.size() != count) fail(fmt::format("{} columns, expected {} ({})", words_.size(), count, what));
  }
  double number(size_t column) const {
    const auto value = parse_number(words_[column]);
    if (!value)
      fail(fmt::format("column {}: expected a finite number, found \"{}\"", column + 1, words_[column]));
    return *value;
  }
  double coordinate(size_t column) const {
    const double value = number(column);
    if (std::abs(value) > kLargestCoordinate_m)
      fail(fmt::format("column {}: {} m is absurd", column + 1, value));
    return value;
  }
  Time stamp(size_t column) const {
    if (const auto seconds = parse_seconds(words_[column])) return *seconds;
    if (const auto nanoseconds = parse_nanoseconds(words_[column])) return *nanoseconds;
    fail(fmt::format("column {}: expected seconds (or ns since 1970), found \"{}\"", column + 1,
                     words_[column]));
  }
  [[noreturn]] void fail(std::string_view what) const {
    throw InputError(fmt::format("{}:{}: {}", name_, line_, what));
  }

 private:
  void cut(std::string_view line) {
    words_.clear();
    for (size_t at = line.find_first_not_of(kBlank); at != line.npos;) {
      const size_t end = std::min(line.find_first_of(kBlank, at), line.size());
      words_.push_back(line.substr(at, end - at));
      at = line.find_first_not_of(kBlank, end);
    }
  }

  std::string_view rest_;
  const std::string& name_;
  std::vector<std::string_view> words_;
  size_t line_ = 0;
};

void expect_ascending(const Lines& lines, const PoseTrajectory& before, Time stamp) {
  if (!before.empty() && stamp <= before.back().stamp)
    lines.fail(fmt::format("stamp {} is not after the one before, {}", format_seconds(stamp),
                           format_seconds(before.back().stamp)));
}

StampedPose parse_tum_pose(const Lines& lines) {
  lines.expect_words(8, "t x y z qx qy qz qw");
  const Vec3 position(lines.coordinate(1), lines.coordinate(2), lines.coordinate(3));
  const Quat q(lines.number(7), lines.number(4), lines.number(5), lines.number(6));
  // Files with few decimals have quaternions a little off unit length; anything else is a mistake.
  if (!(std::abs(q.norm() - 1) < 0.1))
    lines.fail(fmt::format("quaternion of length {:.6g}, expected a unit quaternion", q.norm()));
  return {lines.stamp(0), SE3(q, position)};
}

SE3 parse_kitti_pose(const Lines& lines) {
  lines.expect_words(12, "upper 3 x 4 of a pose, row by row");
  Mat3 R;
  Vec3 t;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column)
      R(row, column) = lines.number(static_cast<size_t>(4 * row + column));
    t[row] = lines.coordinate(static_cast<size_t>(4 * row + 3));
  }
  if (!((R * R.transpose() - Mat3::Identity()).norm() < 0.01 && R.determinant() > 0))
    lines.fail("the 3 x 3 part is not a rotation");
  return SE3(Quat(R), t);
}

bool has_kitti_columns(std::string_view text, const std::string& name) {
  Lines lines(text, name);
  return lines.next() && lines.words().size() == 12;
}

void set_stamps(PoseTrajectory& trajectory, std::string_view text, const std::string& name) {
  PoseTrajectory stamped;
  for (Lines lines(text, name); lines.next();) {
    lines.expect_words(1, "a stamp in seconds");
    const Time stamp = lines.stamp(0);
    expect_ascending(lines, stamped, stamp);
    if (stamped.size() == trajectory.size())
      lines.fail(fmt::format("more stamps than the {} poses", stamped.size()));
    stamped.push_back({stamp, trajectory[stamped.size()].pose});
  }
  if (stamped.size() != trajectory.size())
    throw InputError(fmt::format("{}: {} stamps for {} poses", name, stamped.size(), trajectory.size()));
  trajectory = std::move(stamped);
}

/// Fixed decimals; never "-0.000000000".
std::string fixed(double value) {
  std::string text = fmt::format("{:.9f}", value);
  if (text == "-0.000000000") text.erase(0, 1);
  return text;
}

}  // namespace

PoseTrajectory parse_tum(std::string_view text, const std::string& name) {
  PoseTrajectory trajectory;
  for (Lines lines(text, name); lines.next();) {
    const StampedPose pose = parse_tum_pose(lines);
    expect_ascending(lines, trajectory, pose.stamp);
    trajectory.push_back(pose);
  }
  if (trajectory.empty()) throw InputError(fmt::format("{}: no pose", name));
  return trajectory;
}

PoseTrajectory read_tum(const std::filesystem::path& path) {
  return parse_tum(read_file(path), path.string());
}

std::string format_tum(std::span<const StampedPose> trajectory) {
  std::string text;
  for (const auto& [stamp, pose] : trajectory) {
    const Vec3& t = pose.translation;
    const Quat& q = pose.rotation;
    const double sign = q.w() < 0 ? -1 : 1;
    text += format_seconds(stamp);
    for (const double value : {t.x(), t.y(), t.z(), sign * q.x(), sign * q.y(), sign * q.z(), sign * q.w()})
      text += ' ' + fixed(value);
    text += '\n';
  }
  return text;
}

void write_tum(const std::filesystem::path& path, std::span<const StampedPose> trajectory) {
  write_file(path, format_tum(trajectory));
}

PoseTrajectory parse_kitti(std::string_view text, const std::string& name) {
  PoseTrajectory trajectory;
  for (Lines lines(text, name); lines.next();)
    trajectory.push_back(
        {Time{static_cast<int64_t>(trajectory.size()) * 100'000'000}, parse_kitti_pose(lines)});
  if (trajectory.empty()) throw InputError(fmt::format("{}: no pose", name));
  return trajectory;
}

PoseTrajectory read_kitti(const std::filesystem::path& path, const std::filesystem::path& times) {
  PoseTrajectory trajectory = parse_kitti(read_file(path), path.string());
  if (!times.empty()) set_stamps(trajectory, read_file(times), times.string());
  return trajectory;
}

void write_kitti(const std::filesystem::path& path, std::span<const StampedPose> trajectory) {
  std::string text;
  for (const auto& [stamp, pose] : trajectory) {
    const Eigen::Matrix4d T = pose.matrix4();
    for (int i = 0; i < 12; ++i) text += fixed(T(i / 4, i % 4)) + (i < 11 ? ' ' : '\n');
  }
  write_file(path, text);
}

void write_kitti_times(const std::filesystem::path& path, std::span<const StampedPose> trajectory) {
  std::string text;
  for (const auto& [stamp, pose] : trajectory) text += format_seconds(stamp) + '\n';
  write_file(path, text);
}

bool is_kitti(const std::filesystem::path& path) {
  return has_kitti_columns(read_file(path), path.string());
}

PoseTrajectory read_trajectory(const std::filesystem::path& path) {
  const std::string text = read_file(path), name = path.string();  // once: it may be a pipe
  if (!has_kitti_columns(text, name)) return parse_tum(text, name);
  PoseTrajectory trajectory = parse_kitti(text, name);
  const std::filesystem::path times = path.parent_path() / "times.txt";
  if (std::filesystem::exists(times)) set_stamps(trajectory, read_file(times), times.string());
  return trajectory;
}

}  // namespace vsslam

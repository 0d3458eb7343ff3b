#include "scenarios/oracles/loop_truth.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "core/ordered_parallel.h"

namespace vsslam {

namespace {

constexpr size_t kPacket = 16;

/// Rays from one position to up to 16 points, each ending `short_by_m` before its point; rays that would be
/// empty are off.
RayPacket rays_to(const Vec3& from_world, std::span<const Vec3> points_world, double short_by_m,
                  double max_range_m) {
  RayPacket rays;
  for (size_t i = 0; i < kPacket; ++i) {
    const bool used = i < points_world.size();
    const Vec3 way = used ? Vec3(points_world[i] - from_world) : Vec3::UnitX();
    const double distance = way.norm();
    const Vec3 direction = distance > 0 ? Vec3(way / distance) : Vec3::UnitX();
    const bool on = used && distance > short_by_m && distance <= max_range_m;
    rays.origin_x[i] = static_cast<float>(from_world.x());
    rays.origin_y[i] = static_cast<float>(from_world.y());
    rays.origin_z[i] = static_cast<float>(from_world.z());
    rays.direction_x[i] = static_cast<float>(direction.x());
    rays.direction_y[i] = static_cast<float>(direction.y());
    rays.direction_z[i] = static_cast<float>(direction.z());
    rays.near_m[i] = on ? 0.0f : 1.0f;
    rays.far_m[i] = on ? static_cast<float>(distance - short_by_m) : 0.0f;
  }
  return rays;
}

/// Up to 16 points of a scan, every `every`-th from `begin` on.
std::vector<Vec3> packet_of(const KeyScanTruth& scan, size_t begin, size_t every) {
  std::vector<Vec3> points_world;
  for (size_t i = begin; i < scan.points_lidar.size() && points_world.size() < kPacket; i += every)
    points_world.push_back(scan.T_world_lidar * scan.points_lidar[i].cast<double>());
  return points_world;
}

std::vector<bool> glass_materials(const World& world) {
  std::vector<bool> glass;
  for (const Material& material : world.materials) glass.push_back(material.glass);
  return glass;
}

std::optional<double> share(int part, int whole) {
  if (whole == 0) return std::nullopt;
  return static_cast<double>(part) / whole;
}

}  // namespace

KeyScanTruth key_scan_truth(int key, const LidarMeasurement& measurement, const SE3& T_world_base,
                            size_t max_points) {
  KeyScanTruth result{.key = key,
                      .stamp = measurement.scan.stamp,
                      .T_world_base = T_world_base,
                      .T_world_lidar = measurement.T_world_lidar,
                      .points_lidar = {}};
  const size_t all = measurement.truth.size(), kept = std::min(max_points, all);
  for (size_t i = 0; i < kept; ++i)
    result.points_lidar.push_back(measurement.truth[i * all / kept].position_lidar);
  return result;
}

std::string_view verdict_name(LoopVerdict verdict) {
  switch (verdict) {
    case LoopVerdict::accepted_true:
      return "true";
    case LoopVerdict::accepted_false:
      return "false";
    case LoopVerdict::accepted_unknown:
      return "";
    default:
      return "rejected";
  }
}

std::optional<double> LoopScore::recall() const {
  const auto closed =
      std::count_if(revisits.begin(), revisits.end(), [](const Revisit& r) { return r.closed; });
  return share(static_cast<int>(closed), static_cast<int>(revisits.size()));
}

std::optional<double> LoopScore::precision() const {
  return share(true_loops, true_loops + false_loops);
}

LoopJudgement judge_loop(const LoopRecord& record, const std::optional<SE3>& T_world_query,
                         const std::optional<SE3>& T_world_match, const LoopTruthOptions& options) {
  LoopJudgement judgement;
  judgement.verdict = record.accepted ? LoopVerdict::accepted_unknown : LoopVerdict::rejected;
  if (!T_world_query || !T_world_match) return judgement;
  const SE3 T_match_query = T_world_match->inverse() * *T_world_query;
  const SE3 error = T_match_query.inverse() * record.T_match_query;
  judgement.error_m = error.translation.norm();
  judgement.error_deg = error.angle() * 180 / std::numbers::pi;
  const bool is_true =
      judgement.error_m <= options.true_within_m && judgement.error_deg <= options.true_within_deg;
  if (record.accepted)
    judgement.verdict = is_true ? LoopVerdict::accepted_true : LoopVerdict::accepted_false;
  return judgement;
}

LoopScore score_loops(std::span<const LoopRecord> records,
                      const std::function<std::optional<SE3>(int key)>& T_world_base) {
  LoopScore result;
  result.candidates = static_cast<int>(records.size());
  for (const LoopRecord& record : records) {
    result.judgements.push_back(judge_loop(record, T_world_base(record.query), T_world_base(record.match)));
    const LoopVerdict verdict = result.judgements.back().verdict;
    result.accepted += record.accepted;
    result.true_loops += verdict == LoopVerdict::accepted_true;
    result.false_loops += verdict == LoopVerdict::accepted_false;
  }
  return result;
}

LoopOracle::LoopOracle(const World& world, const Raycaster& raycaster, std::vector<KeyScanTruth> keys,
                       const LoopTruthOptions& options)
    : raycaster_(raycaster), keys_(std::move(keys)), options_(options), glass_(glass_materials(world)) {
  for (size_t i = 0; i < keys_.size(); ++i)
    if (keys_[i].key != static_cast<int>(i))
      throw std::logic_error(fmt::format("key scan {} at place {} of the oracle's list", keys_[i].key, i));
  std::vector<std::optional<Revisit>> found(keys_.size());
  parallel_pieces(keys_.size(), 1, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) found[i] = revisit(static_cast<int>(i));
  });
  for (const auto& revisit : found)
    if (revisit) revisits_.push_back(*revisit);
}

bool LoopOracle::sees(const Vec3& from_world, const Vec3& point_world) const {
  const Vec3 way = point_world - from_world;
  const double distance = way.norm();
  const Vec3 direction = way / distance;
  double passed_m = 0;
  // Every pane of glass that the ray meets is left behind; a ray that meets very many is not worth following.
  for (int panes = 0; panes < 16; ++panes) {
    const double left_m = distance - options_.seen_within_m - passed_m;
    Raycaster::Hit hit;
    if (left_m <= 0 || !raycaster_.trace_one(from_world + passed_m * direction, direction, left_m, hit))
      return true;
    if (hit.material < 0 || !glass_.at(static_cast<size_t>(hit.material))) return false;
    passed_m += hit.range_m + 1e-3;
  }
  return false;
}

size_t LoopOracle::count_seen(const Vec3& from_world, std::span<const Vec3> points_world) const {
  const RayPacket rays = rays_to(from_world, points_world, options_.seen_within_m, options_.max_range_m);
  HitPacket hits;
  raycaster_.trace({&rays, 1}, {&hits, 1});
  size_t seen = 0;
  for (size_t i = 0; i < points_world.size(); ++i) {
    if ((points_world[i] - from_world).norm() > options_.max_range_m) continue;
    const bool clear = rays.far_m[i] < rays.near_m[i] || hits.object[i] == HitPacket::kNoHit;
    if (clear || (glass_.at(static_cast<size_t>(hits.material[i])) && sees(from_world, points_world[i])))
      ++seen;
  }
  return seen;
}

double LoopOracle::overlap(int query, int match) const {
  const KeyScanTruth& from = keys_.at(static_cast<size_t>(query));
  const Vec3 eye_world = keys_.at(static_cast<size_t>(match)).T_world_lidar.translation;
  size_t seen = 0;
  for (size_t begin = 0; begin < from.points_lidar.size(); begin += kPacket)
    seen += count_seen(eye_world, packet_of(from, begin, 1));
  return from.points_lidar.empty()
             ? 0.0
             : static_cast<double>(seen) / static_cast<double>(from.points_lidar.size());
}

bool LoopOracle::overlaps(int query, int match) const {
  constexpr size_t kEvery = 5;
  const KeyScanTruth& from = keys_.at(static_cast<size_t>(query));
  const Vec3 eye_world = keys_.at(static_cast<size_t>(match)).T_world_lidar.translation;
  for (size_t begin = 0; begin < from.points_lidar.size(); begin += kEvery * kPacket)
    if (count_seen(eye_world, packet_of(from, begin, kEvery)) > 0) return true;
  return false;
}

std::optional<Revisit> LoopOracle::revisit(int key) const {
  const KeyScanTruth& here = keys_[static_cast<size_t>(key)];
  std::vector<std::pair<double, int>> near;
  for (int older = 0; older < key; ++older) {
    const KeyScanTruth& there = keys_[static_cast<size_t>(older)];
    const double distance = (here.T_world_base.translation - there.T_world_base.translation).norm();
    if (here.stamp - there.stamp > options_.revisit_after && distance <= options_.revisit_within_m)
      near.emplace_back(distance, older);
  }
  std::sort(near.begin(), near.end());
  for (const auto& [distance, older] : near)
    if (const double seen = overlap(key, older); seen >= options_.revisit_overlap)
      return Revisit{.key = key, .of = older, .overlap = seen, .closed = false};
  return std::nullopt;
}

LoopJudgement LoopOracle::judge(const LoopRecord& record) const {
  LoopJudgement judgement =
      judge_loop(record, keys_.at(static_cast<size_t>(record.query)).T_world_base,
                 keys_.at(static_cast<size_t>(record.match)).T_world_base, options_);
  judgement.overlap = overlap(record.query, record.match);
  return judgement;
}

LoopScore LoopOracle::score(std::span<const LoopRecord> records) const {
  LoopScore result;
  result.candidates = static_cast<int>(records.size());
  result.revisits = revisits_;
  result.judgements.resize(records.size());
  parallel_pieces(records.size(), 1, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) result.judgements[i] = judge(records[i]);
  });
  for (size_t i = 0; i < records.size(); ++i) {
    const LoopVerdict verdict = result.judgements[i].verdict;
    if (verdict == LoopVerdict::rejected) continue;
    ++result.accepted;
    ++(verdict == LoopVerdict::accepted_true ? result.true_loops : result.false_loops);
    if (verdict == LoopVerdict::accepted_true) close_near(records[i].query, result.revisits);
  }
  return result;
}

void LoopOracle::close_near(int query, std::vector<Revisit>& revisits) const {
  const Vec3& edge_world = keys_[static_cast<size_t>(query)].T_world_base.translation;
  for (Revisit& revisit : revisits) {
    const Vec3& here_world = keys_[static_cast<size_t>(revisit.key)].T_world_base.translation;
    if ((here_world - edge_world).norm() <= options_.revisit_within_m) revisit.closed = true;
  }
}

}  // namespace vsslam

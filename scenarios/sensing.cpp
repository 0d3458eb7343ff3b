#include "scenarios/sensing.h"

#include <algorithm>
#include <utility>

namespace vsslam {

namespace {

constexpr Duration kChunk{100'000'000};
constexpr Duration kSpan{10'000'000};  // how far the dynamics run ahead at a time, for the truth to catch up

}  // namespace

Sensing::Sensing(const Scenario& scenario, const World& world, uint64_t seed, StageClock* clock)
    : scenario_(scenario),
      clock_(clock),
      simulation_(world, scenario.robot, scenario.drive),
      rig_(world, scenario.rig, scenario.events.sensors, seed),
      T_lidar_base_(scenario.rig.mounts.lidar.T_base_sensor().inverse()) {
  for (const WheelSlipEvent& slip : scenario.events.wheel_slip)
    simulation_.scale_friction(Time::from_seconds(slip.at_s), Time::from_seconds(slip.at_s + slip.duration_s),
                               slip.left_friction, slip.right_friction);
}

// The raycaster's objects are moved by the rig, the solid ones here.
void Sensing::place_objects() {
  const MovingObjects& moving = rig_.moving_objects();
  placed_.resize(moving.objects().size());
  for (size_t i = 0; i < placed_.size(); ++i) {
    const ObjectState state = moving.state(moving.objects()[i], until_);
    if (placed_[i] == state) continue;
    placed_[i] = state;
    simulation_.set_object_pose(moving.objects()[i], state.T_world_object, state.present);
  }
}

Chunk Sensing::next(const std::optional<Belief>& belief) {
  place_objects();
  if (belief) simulation_.set_believed_pose(belief->stamp, belief->T_world_base);

  Chunk chunk;
  chunk.until = until_ + kChunk;
  {
    StageTimer timer(clock_, "simulate");
    Time ahead = chunk.until;
    while (simulation_.trajectory().end() < chunk.until) simulation_.advance(ahead = ahead + kSpan);
  }
  {
    StageTimer timer(clock_, "sense");
    rig_.advance(
        chunk.until, simulation_.trajectory(), [this](Time t) { return simulation_.wheels(t); },
        [&](Measurement&& m) { chunk.measurements.push_back(std::move(m)); });
  }
  simulation_.forget_before(std::min(rig_.needed_from(), chunk.until));
  add_truth(chunk);
  until_ = chunk.until;
  ended_ = simulation_.outcome() != DriveOutcome::driving || until_.seconds() >= scenario_.max_duration_s;
  return chunk;
}

double Sensing::expected_duration_s() const {
  return std::min(simulation_.expected_duration_s(), scenario_.max_duration_s);
}

void Sensing::add_truth(Chunk& chunk) const {
  StageTimer timer(clock_, "truth");
  for (const Measurement& measurement : chunk.measurements)
    if (const auto* lidar = std::get_if<LidarMeasurement>(&measurement))
      chunk.scans.push_back({lidar->T_world_lidar * T_lidar_base_, degeneracy_truth(*lidar)});
}

}  // namespace vsslam

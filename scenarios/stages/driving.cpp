#include "scenarios/stages/driving.h"

#include <algorithm>

namespace vsslam {

namespace {

constexpr Duration kStretch{100'000'000};
constexpr Duration kSpan{10'000'000};  // how far the dynamics run ahead at a time, for the truth to catch up

}  // namespace

Driving::Driving(const Scenario& scenario, const World& world, StageClock* clock)
    : scenario_(scenario),
      clock_(clock),
      simulation_(world, scenario.robot, scenario.drive),
      moving_(world, scenario.events.sensors.objects) {
  for (const WheelSlipEvent& slip : scenario.events.wheel_slip)
    simulation_.scale_friction(Time::from_seconds(slip.at_s), Time::from_seconds(slip.at_s + slip.duration_s),
                               slip.left_friction, slip.right_friction);
}

Motion Driving::next(const std::optional<Belief>& belief, Time keep_from) {
  StageTimer timer(clock_, "simulate");
  // Those that are solid; what the sensors see is moved by the rig.
  for (const auto& [object, state] : moving_.changes(until_, placed_))
    simulation_.set_object_pose(object, state.T_world_object, state.present);
  if (belief) simulation_.set_believed_pose(belief->stamp, belief->T_world_base);
  until_ = until_ + kStretch;
  Time ahead = until_;
  while (simulation_.trajectory().end() < until_) simulation_.advance(ahead = ahead + kSpan);
  simulation_.forget_before(keep_from);
  ended_ = simulation_.outcome() != DriveOutcome::driving || until_.seconds() >= scenario_.max_duration_s;
  return simulation_.motion_since(keep_from, until_);
}

double Driving::expected_duration_s() const {
  return std::min(simulation_.expected_duration_s(), scenario_.max_duration_s);
}

}  // namespace vsslam

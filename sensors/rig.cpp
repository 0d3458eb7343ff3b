#include "sensors/rig.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <utility>

#include "sensors/lidar/lidar.h"
#include "sensors/measurement/faults.h"
#include "sensors/moving_objects.h"
#include "sensors/rig_camera.h"

namespace vsslam {

struct Rig::Impl {
  Impl(const World& world, const RigConfig& c, const SensorEvents& e, uint64_t seed,
       const LightingConfig& lighting)
      : config(c),
        events(e),
        T_base_lidar(c.mounts.lidar.T_base_sensor()),
        raycaster(world),
        moving(world, e.objects),
        lidar(c.sensors.lidar, e, seed, raycaster),
        imu(c.sensors.imu, c.mounts.imu.T_base_sensor(), seed),
        wheels(c.sensors.wheels, seed),
        clocks(e.clocks, seed),
        spikes(seed, "events.imu_spikes") {
    if (c.sensors.camera.enabled)
      camera.emplace(world, raycaster, moving, c.sensors.camera, c.mounts.camera.T_base_sensor(), lighting, e,
                     seed);
  }

  RigConfig config;
  SensorEvents events;
  SE3 T_base_lidar;
  Raycaster raycaster;
  MovingObjects moving;
  Lidar lidar;
  Imu imu;
  WheelEncoder wheels;
  std::optional<RigCamera> camera;
  ClockErrors clocks;
  RandomStream spikes;
  TakenBefore taken;

  bool started = false;
  int64_t next_imu = 0, next_wheels = 0, delivered_scans = 0;
  Revolution next_revolution;
  std::vector<ObjectState> placed;  ///< of moving.objects(), as the raycaster has them

  void start(Time begin) {
    const Time first{std::max<int64_t>(0, begin.ns)};
    next_imu = imu.first_index(first);
    next_wheels = wheels.first_index(first);
    next_revolution = lidar.power_on(first);
    if (camera) camera->power_on(first);
    started = true;
  }
  void place_objects(Time stamp);
  std::optional<ImuMeasurement> measure_imu(const Trajectory& trajectory);
  std::optional<WheelMeasurement> measure_wheels(const std::function<WheelState(Time)>& state);
  std::optional<LidarMeasurement> measure_lidar(const Trajectory& trajectory);
  std::optional<CameraMeasurement> measure_camera(Time until, const Trajectory& trajectory);
};

Rig::Rig(const World& world, const RigConfig& config, const SensorEvents& events, uint64_t seed,
         const LightingConfig& lighting)
    : impl_(std::make_unique<Impl>(world, config, events, seed, lighting)) {}
Rig::~Rig() = default;

Raycaster& Rig::raycaster() {
  return impl_->raycaster;
}

void Rig::leave_out(TakenBefore taken) {
  impl_->taken = std::move(taken);
  if (!impl_->camera || !impl_->taken.image) return;
  impl_->camera->leave_out([this](Time true_stamp) {
    return impl_->taken.image(
        impl_->clocks.stamp(SensorKind::camera, true_stamp, 1 / impl_->config.sensors.camera.rate_hz));
  });
}

void Rig::leave_out_point_truth() {
  impl_->lidar.leave_out_truth();
}

Time Rig::needed_from() const {
  if (!impl_->started) return Time{0};
  const Time others = std::min({impl_->imu.stamp(impl_->next_imu), impl_->wheels.stamp(impl_->next_wheels),
                                impl_->lidar.begin(impl_->next_revolution)});
  return impl_->camera ? std::min(others, impl_->camera->needed_from()) : others;
}

void Rig::advance(Time until, const Trajectory& trajectory, const std::function<WheelState(Time)>& wheels,
                  const std::function<void(Measurement&&)>& sink) {
  Impl& impl = *impl_;
  if (!impl.started && trajectory.begin() < trajectory.end()) impl.start(trajectory.begin());
  if (!impl.started) return;
  until = std::min(until, trajectory.end());
  const auto emit = [&](auto&& measured) {
    if (measured) sink(Measurement(std::move(*measured)));
  };
  while (true) {
    const Time imu = impl.imu.stamp(impl.next_imu), wheel = impl.wheels.stamp(impl.next_wheels),
               lidar = impl.lidar.end(impl.next_revolution),
               camera = impl.camera ? impl.camera->next_end() : Time{std::numeric_limits<int64_t>::max()};
    const Time next = std::min({imu, wheel, lidar, camera});
    if (next > until) return;
    if (next == imu)
      emit(impl.measure_imu(trajectory));
    else if (next == wheel)
      emit(impl.measure_wheels(wheels));
    else if (next == lidar)
      emit(impl.measure_lidar(trajectory));
    else
      emit(impl.measure_camera(until, trajectory));
  }
}

std::optional<ImuMeasurement> Rig::Impl::measure_imu(const Trajectory& trajectory) {
  const int64_t index = next_imu++;
  ImuMeasurement m = imu.measure(index, trajectory);
  if (any_lasts(events.imu_dropouts, m.true_stamp)) return std::nullopt;
  add_spikes(events.imu_spikes, spikes, index, m);
  m.sample.stamp = clocks.stamp(SensorKind::imu, m.true_stamp, 1 / config.sensors.imu.rate_hz);
  return m;
}

std::optional<WheelMeasurement> Rig::Impl::measure_wheels(const std::function<WheelState(Time)>& state) {
  const int64_t index = next_wheels++;
  const Time now = wheels.stamp(index);
  if (any_lasts(events.wheel_dropouts, now)) return std::nullopt;
  WheelMeasurement m = wheels.measure(index, state(now));
  m.sample.stamp = clocks.stamp(SensorKind::wheels, now, 1 / config.sensors.wheels.rate_hz);
  return m;
}

std::optional<LidarMeasurement> Rig::Impl::measure_lidar(const Trajectory& trajectory) {
  const Revolution revolution = std::exchange(next_revolution, lidar.after(next_revolution));
  const Time begin = lidar.begin(revolution), end = lidar.end(revolution);
  for (const SensorDropout& dropout : events.lidar_dropouts)
    if (dropout.contains(begin) && dropout.contains(end)) return std::nullopt;
  const Time stamp = clocks.stamp(SensorKind::lidar, begin, 1 / config.sensors.lidar.rate_hz);
  LidarMeasurement m;
  if (const int64_t index = delivered_scans++; taken.scan && taken.scan(index, stamp)) {
    m.true_stamp = begin;
    m.T_world_lidar = trajectory.pose(begin) * T_base_lidar;
  } else {
    place_objects(begin);
    m = lidar.scan(revolution, trajectory, T_base_lidar);
  }
  m.scan.stamp = stamp;
  m.scan.end = stamp + (end - begin);
  return m;
}

std::optional<CameraMeasurement> Rig::Impl::measure_camera(Time until, const Trajectory& trajectory) {
  auto m = camera->measure(until, trajectory, [this](Time stamp) { place_objects(stamp); });
  if (m) m->frame.stamp = clocks.stamp(SensorKind::camera, m->true_stamp, 1 / config.sensors.camera.rate_hz);
  return m;
}

void Rig::Impl::place_objects(Time stamp) {
  const auto changes = moving.changes(stamp, placed);
  for (const auto& [object, state] : changes)
    raycaster.set_object_pose(object, state.T_world_object, state.present);
  if (!changes.empty()) raycaster.commit();
}

}  // namespace vsslam

// A camera on the robot: when it exposes, what it then sees, and what it makes of that.
//
// Frame `camera`: x right, y down, z forward. Global shutter. Stamps are the middle of the exposure, at the rate of the
// camera's clock whatever the exposure time. Motion blur is the mean over instants spread evenly over the exposure, as
// many as keep the flow between neighbours below `blur_spacing_px`. One view per `blur_view_spacing_px` of flow is
// rendered; instants between them move its pixels along their flow (camera_blur.h).
#pragma once

#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "sensors/camera/camera_config.h"
#include "sensors/camera/camera_exposure.h"
#include "sensors/camera/camera_optics.h"
#include "sensors/camera/camera_sensor.h"
#include "sensors/measurement/samples.h"
#include "sensors/measurement/sensor_events.h"
#include "sensors/render/renderer.h"
#include "sim/trajectory.h"

namespace vsslam {

/// Luminance and depth through rays from a pose. Called from several threads at once.
using ViewSource = std::function<void(const SE3& T_world_camera, const ViewRays& rays, View& view)>;

/// Takes images in order; auto exposure and the number of the next image are the only state.
class Camera {
 public:
  Camera(const CameraConfig& config, const SensorEvents& events, uint64_t seed);

  /// The first image is the first whose exposure begins at or after `first`.
  void power_on(Time first);
  /// Middle, begin and end of the exposure of the k-th image from the next one on, k < known().
  Time stamp(int k = 0) const { return stamp_of(next_ + k); }
  Time begin(int k = 0) const;
  Time end(int k = 0) const;
  /// How many images' exposures are settled already. So many can be taken side by side.
  int known() const { return control_.known(); }
  /// Earliest time of the trajectory that the next image needs.
  Time needed_from() const;

  /// Takes the next `count` images (at most known()), side by side; the same for any number of threads. Images of a
  /// dropout are left out.
  std::vector<CameraMeasurement> take(int count, const Trajectory& trajectory, const SE3& T_base_camera,
                                      const ViewSource& source);

  /// Mean grey by true stamp of images that were taken in an earlier run: they come without pixels and truth.
  void leave_out(std::function<std::optional<double>(Time)> taken) { taken_before_ = std::move(taken); }

  const CameraOptics& optics() const { return optics_; }
  const ViewRays& rays() const { return centre_rays_; }

 private:
  /// One image to be taken.
  struct Shot {
    int64_t index;
    Time stamp;
    Exposure exposure;
    const Trajectory& trajectory;
    const SE3& T_base_camera;
    const ViewSource& source;
    SE3 T_world_camera(Time t) const { return trajectory.pose(t) * T_base_camera; }
    /// At a share of the exposure, 0 .. 1.
    SE3 T_world_camera(double share) const;
    SE3 T_later_earlier(double later, double earlier) const;
  };
  /// Memory of one image in the making, kept for the next.
  struct Workshop {
    View view, coarse;
    std::vector<float> luminance;  ///< mean over the views
    bool view_is_middle = false;   ///< `view` is what the centres of the pixels see at the stamp
  };

  Time stamp_of(int64_t index) const;
  double transmission(Time stamp) const;
  double take_one(const Shot& shot, Workshop& workshop,
                  CameraMeasurement& out) const;  // returns the mean grey
  double coarse_flow_px(const Shot& shot, Workshop& workshop) const;
  int blur_views(double flow_px) const;
  void gather_light(const Shot& shot, Workshop& workshop) const;
  void add_truth(const Shot& shot, Workshop& workshop, CameraMeasurement& out) const;

  CameraConfig config_;
  std::vector<SensorDropout> dropouts_;
  std::vector<CoveredLens> covered_;
  CameraOptics optics_;
  ViewRays centre_rays_, coarse_rays_;
  std::vector<ViewRays> sample_rays_;  ///< spread over the pixels' areas; empty: one through each centre
  ImageSensor sensor_;
  ExposureControl control_;
  std::function<std::optional<double>(Time)> taken_before_;
  Time first_{0};
  int64_t next_ = 0;
  std::vector<Workshop> workshops_;
};

}  // namespace vsslam

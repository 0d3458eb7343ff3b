#include "slam/slam_config.h"

namespace vsslam {

void SlamConfig::fields(Fields& f) {
  f.choice("prior", prior,
           {{"vio", PriorKind::vio},
            {"wheel_imu", PriorKind::wheel_imu},
            {"imu", PriorKind::imu},
            {"wheel", PriorKind::wheel},
            {"constant_velocity", PriorKind::constant_velocity}});
  f("inertial", inertial);
  f("vision", vision);
  f("odometry", odometry);
  f("loop", loop);
  f("graph", graph);
}

}  // namespace vsslam

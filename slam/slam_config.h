// Every setting of the stack: the `slam` section of a scenario.
#pragma once

#include "core/config.h"
#include "slam/graph/pose_graph.h"
#include "slam/inertial/motion_prior.h"
#include "slam/lidar/lidar_odometry.h"
#include "slam/loop/loop_config.h"
#include "slam/vision_config.h"

namespace vsslam {

struct SlamConfig {
  PriorKind prior = PriorKind::wheel_imu;
  InertialConfig inertial;
  VisionConfig vision;
  LidarOdometryConfig odometry;
  LoopConfig loop;
  PoseGraphConfig graph;
  void fields(Fields& f);
};

}  // namespace vsslam

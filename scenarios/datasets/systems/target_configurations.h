// The systems themselves, one file each.
#pragma once

#include <vector>

#include "scenarios/datasets/systems/target_system.h"

namespace vsslam {

TargetSystem lio_sam();
TargetSystem lvi_sam();
TargetSystem fast_lio();
TargetSystem kiss_icp();
TargetSystem openvins();
TargetSystem vins_fusion();
TargetSystem orb_slam3();
TargetSystem evalio();

inline std::vector<TargetSystem> make_target_systems() {
  return {lio_sam(), lvi_sam(), fast_lio(), kiss_icp(), openvins(), vins_fusion(), orb_slam3(), evalio()};
}

}  // namespace vsslam

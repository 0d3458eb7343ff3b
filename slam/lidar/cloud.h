// Point clouds of the estimator.
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "core/se3.h"

namespace vsslam {

/// Points in the frame that the variable's name ends with, e.g. cloud_lidar. m.
using Cloud = std::vector<Eigen::Vector3f>;

/// A cloud that several keep and none changes.
using SharedCloud = std::shared_ptr<const Cloud>;
inline SharedCloud share(Cloud cloud) {
  return std::make_shared<const Cloud>(std::move(cloud));
}

}  // namespace vsslam

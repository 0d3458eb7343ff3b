// Our ICP beside PCL's, an independent implementation of the same method.
#include <gtest/gtest.h>
#include <pcl/point_types.h>
#include <pcl/registration/icp.h>

#include "slam/loop/icp.h"
#include "slam/loop/local_map.h"
#include "tests/slam/loop/loop_room.h"

namespace vsslam {
namespace {

pcl::PointCloud<pcl::PointXYZ>::Ptr to_pcl(const Cloud& cloud) {
  auto out = pcl::make_shared<pcl::PointCloud<pcl::PointXYZ>>();
  for (const Eigen::Vector3f& p : cloud) out->push_back({p.x(), p.y(), p.z()});
  return out;
}

TEST(IcpBesidePcl, SamePathSameResult) {
  const SE3 T_map_match = planar(1, 1, 0.2, 0.6);
  const Cloud target = voxel_means(scan_room(cluttered_room(), T_map_match), 0.2);
  for (double max_correspondence_m : {2.0, 40.0}) {
    const SE3 truth = planar(0.5, -0.3, 0.1), guess = planar(0.1, 0, 0.02);
    const Cloud source = voxel_means(scan_room(cluttered_room(), T_map_match * truth), 0.4);

    pcl::IterativeClosestPoint<pcl::PointXYZ, pcl::PointXYZ> twin;
    twin.setMaxCorrespondenceDistance(max_correspondence_m);
    twin.setMaximumIterations(100);
    twin.setTransformationEpsilon(1e-6);
    twin.setEuclideanFitnessEpsilon(1e-6);
    twin.setRANSACIterations(0);
    twin.setInputSource(to_pcl(source));
    twin.setInputTarget(to_pcl(target));
    pcl::PointCloud<pcl::PointXYZ> unused;
    twin.align(unused, guess.matrix4().cast<float>());
    const Eigen::Matrix4d expected = twin.getFinalTransformation().cast<double>();

    const IcpResult ours = align(source, IcpTarget(target), guess,
                                 {.max_correspondence_m = max_correspondence_m, .coarse_stride = 1}, 0.5);
    EXPECT_TRUE(ours.converged);
    EXPECT_TRUE(twin.hasConverged());
    EXPECT_LT((ours.T_target_source.matrix4() - expected).norm(), 2e-3);
    EXPECT_NEAR(ours.fitness_m2, twin.getFitnessScore(max_correspondence_m), 1e-4);
  }
}

}  // namespace
}  // namespace vsslam

// The members of every message in the order of ROS' definitions, told once: an archive writes or reads them.
// ROS 1 and ROS 2 agree on that order.
#pragma once

#include "scenarios/datasets/messages/messages.h"

namespace vsslam {

/// The message as an archive sees it: const where it writes.
template <class Archive, class T>
using Of = typename Archive::template Of<T>;

template <class A>
void members(A& archive, Of<A, MessageHeader>& m) {
  archive.sequence(m.seq);
  archive(m.stamp, m.frame_id);
}

template <class A>
void members(A& archive, Of<A, PointCloudMessage::Field>& m) {
  archive(m.name, m.offset, m.datatype, m.count);
}

template <class A>
void members(A& archive, Of<A, PointCloudMessage>& m) {
  archive(m.header, m.height, m.width, m.fields, m.is_bigendian, m.point_step, m.row_step, m.data,
          m.is_dense);
}

template <class A>
void members(A& archive, Of<A, ImuMessage>& m) {
  archive(m.header, m.orientation, m.orientation_covariance, m.angular_velocity,
          m.angular_velocity_covariance, m.linear_acceleration, m.linear_acceleration_covariance);
}

template <class A>
void members(A& archive, Of<A, ImageMessage>& m) {
  archive(m.header, m.height, m.width, m.encoding, m.is_bigendian, m.step, m.data);
}

template <class A>
void members(A& archive, Of<A, CompressedImageMessage>& m) {
  archive(m.header, m.format, m.data);
}

template <class A>
void members(A& archive, Of<A, CameraInfoMessage>& m) {
  archive(m.header, m.height, m.width, m.distortion_model, m.d, m.k, m.r, m.p);
  uint32_t binning_x = 0, binning_y = 0, roi_x = 0, roi_y = 0, roi_height = 0, roi_width = 0;
  bool roi_rectify = false;
  archive(binning_x, binning_y, roi_x, roi_y, roi_height, roi_width, roi_rectify);
}

template <class A>
void members(A& archive, Of<A, OdometryMessage>& m) {
  archive(m.header, m.child_frame_id, m.T_parent_child, m.pose_covariance, m.linear_velocity_child,
          m.angular_velocity_child, m.twist_covariance);
}

template <class A>
void members(A& archive, Of<A, JointStateMessage>& m) {
  archive(m.header, m.name, m.position, m.velocity, m.effort);
}

template <class A>
void members(A& archive, Of<A, PoseStampedMessage>& m) {
  archive(m.header, m.T_parent_child);
}

template <class A>
void members(A& archive, Of<A, TransformsMessage::Transform>& m) {
  archive(m.header, m.child_frame_id, m.T_parent_child);
}

template <class A>
void members(A& archive, Of<A, TransformsMessage>& m) {
  archive(m.transforms);
}

}  // namespace vsslam

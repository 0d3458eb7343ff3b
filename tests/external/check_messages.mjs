// Every type of message, from a bag and from an MCAP file: what others read is what was written (tests/scenarios/
// dataset_messages.h).
import assert from "node:assert/strict";
import { readBag, readMcap } from "./recordings.mjs";

const EPOCH = 1700000000000000000n;
const header = { stamp: EPOCH + 123456789n, frame_id: "lidar" };
const position = { x: 1, y: -2, z: 0.25 };
const rotation = { x: 0.5, y: -0.5, z: 0.5, w: 0.5 };
const someBytes = (size, seed) => Buffer.from(Array.from({ length: size }, (_, i) => Math.imul(i + seed, 2654435761) >>> 24));
const zeros = (size) => Array(size).fill(0);
const pose = { position, orientation: rotation };

const expected = {
  "sensor_msgs/PointCloud2": {
    header,
    height: 1,
    width: 3,
    fields: [
      { name: "x", offset: 0, datatype: 7, count: 1 },
      { name: "ring", offset: 16, datatype: 4, count: 1 },
      { name: "time", offset: 18, datatype: 7, count: 1 },
    ],
    is_bigendian: false,
    point_step: 22,
    row_step: 66,
    data: someBytes(66, 1),
    is_dense: true,
  },
  "sensor_msgs/Imu": {
    header,
    orientation: { x: 0.2, y: 0.3, z: 0.4, w: 0.1 },
    orientation_covariance: [-1, ...zeros(8)],
    angular_velocity: { x: 0.01, y: -0.02, z: 0.03 },
    angular_velocity_covariance: zeros(9),
    linear_acceleration: { x: 0.1, y: 0.2, z: 9.81 },
    linear_acceleration_covariance: zeros(9),
  },
  "sensor_msgs/Image": { header, height: 2, width: 5, encoding: "mono8", is_bigendian: 0, step: 5, data: someBytes(10, 2) },
  "sensor_msgs/CompressedImage": { header, format: "bgr8; jpeg compressed bgr8", data: someBytes(13, 3) },
  "sensor_msgs/CameraInfo": {
    header,
    height: 480,
    width: 640,
    distortion_model: "plumb_bob",
    d: [0.1, -0.2, 0.001, 0.002, 0],
    k: [600, 0, 320, 0, 601, 240, 0, 0, 1],
    r: [1, 0, 0, 0, 1, 0, 0, 0, 1],
    p: [600, 0, 320, 0, 0, 601, 240, 0, 0, 0, 1, 0],
    binning_x: 0,
    binning_y: 0,
    roi: { x_offset: 0, y_offset: 0, height: 0, width: 0, do_rectify: false },
  },
  "nav_msgs/Odometry": {
    header,
    child_frame_id: "base",
    pose: { pose, covariance: [...zeros(35), 0.5] },
    twist: { twist: { linear: { x: 0.8, y: 0, z: 0 }, angular: { x: 0, y: 0, z: 0 } }, covariance: zeros(36) },
  },
  "sensor_msgs/JointState": { header, name: ["left_wheel", "right_wheel"], position: [1.5, -2.5], velocity: [], effort: [3.5] },
  "geometry_msgs/PoseStamped": { header, pose },
  "tf2_msgs/TFMessage": {
    transforms: [
      { header, child_frame_id: "imu", transform: { translation: position, rotation } },
      {
        header: { stamp: EPOCH, frame_id: "" },
        child_frame_id: "camera",
        transform: { translation: { x: 0, y: 0, z: 0 }, rotation: { x: 0, y: 0, z: 0, w: 1 } },
      },
    ],
  },
};

for (const [path, read] of [[process.argv[2], readBag], [process.argv[3], readMcap]]) {
  const messages = await read(path);
  assert.deepEqual(messages.map((m) => m.type), Object.keys(expected), path);
  messages.forEach((m, i) => {
    assert.deepEqual(m.message, expected[m.type], `${path}: ${m.type}`);
    assert.equal(m.topic, `/topic_${i}`, path);
    assert.equal(m.recorded, EPOCH + BigInt(i + 1), path);
    assert.equal(m.latched, m.type === "tf2_msgs/TFMessage", `${path}: ${m.topic} latched`);
  });
  console.log(`${path}: ${messages.length} types of messages as written`);
}

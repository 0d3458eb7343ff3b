// A dataset with a bag, an MCAP file and the folders of EuRoC, KITTI, PCD, PLY and TUM: what consumers rely on holds, and
// all formats say the same. Clouds are read by PCL's programs. usage: check_dataset.mjs FOLDER SCRATCH_FOLDER
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import fs from "node:fs";
import path from "node:path";
import { PNG } from "pngjs";
import { readBag, readMcap } from "./recordings.mjs";

const [folder, scratch] = process.argv.slice(2);
const file = (...names) => path.join(folder, ...names);
const lines = (...names) => fs.readFileSync(file(...names), "utf8").split("\n").filter((line) => line && !line.startsWith("#"));
const numbers = (...names) => lines(...names).map((line) => line.split(/[\s,]+/).map(Number));
const only = (suffix) => file(fs.readdirSync(folder).find((name) => name.endsWith(suffix)) ?? `*${suffix}`);
const say = (what) => console.log(`${folder}: ${what}`);
const near = (a, b, tolerance, what) => assert.ok(Math.abs(a - b) <= tolerance, `${what}: ${a}, not ${b}`);

const messages = await readBag(only(".bag"));
const on = (topic) => {
  const found = messages.filter((m) => m.topic === topic);
  assert.notEqual(found.length, 0, `no messages on ${topic}`);
  return found;
};

// The MCAP file has the same messages; of the same time, perhaps in another order.
const inOrder = (list) => [...list].sort((a, b) => Number(a.recorded - b.recorded) || (a.topic < b.topic ? -1 : 1));
const others = await readMcap(only(".mcap"));
assert.equal(others.length, messages.length, "messages of the MCAP file");
const sorted = inOrder(others);
inOrder(messages).forEach((m, i) => assert.deepEqual(sorted[i], m, `${m.topic} at ${m.recorded}`));
say(`${messages.length} messages, the same in the bag and in the MCAP file`);

const last = new Map();
let recorded = 0n;
for (const m of messages) {
  assert.ok(m.recorded >= recorded, `${m.topic}: recorded at ${m.recorded}, after ${recorded}`);
  recorded = m.recorded;
  const stamp = m.message.header?.stamp;
  if (stamp === undefined) continue;
  assert.ok(stamp > (last.get(m.topic) ?? 0n), `${m.topic}: stamp ${stamp} after ${last.get(m.topic)}`);
  assert.ok(stamp <= m.recorded, `${m.topic}: stamp ${stamp}, recorded before that at ${m.recorded}`);
  last.set(m.topic, stamp);
}
assert.deepEqual(messages.filter((m) => m.latched).map((m) => m.topic), ["/tf_static"], "latched messages");

// x y z intensity, ring, time: the layout that LIO-SAM, FAST-LIO and others take.
const F32 = 7, U16 = 4;
const layout = [["x", 0, F32], ["y", 4, F32], ["z", 8, F32], ["intensity", 12, F32], ["ring", 16, U16], ["time", 18, F32]].map(
  ([name, offset, datatype]) => ({ name, offset, datatype, count: 1 }),
);
const column = (point) => Math.floor((point[5] + 5e-7) / 55.296e-6);  // firing cycle of a VLP-16
const clouds = on("/velodyne_points").map(({ message, recorded }) => {
  assert.deepEqual(message.fields, layout);
  assert.deepEqual([message.height, message.point_step, message.is_dense, message.is_bigendian], [1, 22, true, false]);
  assert.equal(message.row_step, 22 * message.width);
  assert.equal(message.data.length, message.row_step);
  const view = message.data;
  const points = Array.from({ length: message.width }, (_, i) => [
    ...[0, 4, 8, 12].map((offset) => view.readFloatLE(22 * i + offset)),
    view.readUInt16LE(22 * i + 16),
    view.readFloatLE(22 * i + 18),
  ]);
  points.forEach((point, i) => {
    assert.ok(point.every(Number.isFinite), `point ${i}: ${point}`);
    assert.ok(point[4] < 16 && point[5] >= 0 && point[5] < 0.11, `point ${i}: ring ${point[4]}, time ${point[5]}`);
    if (i === 0) return;
    const step = column(point) - column(points[i - 1]);
    assert.ok(step > 0 || (step === 0 && point[4] > points[i - 1][4]), `point ${i}: ${point} after ${points[i - 1]}`);
  });
  assert.equal(points.at(-1)[5], Math.max(...points.map((point) => point[5])), "the last point is the latest");
  near(Number(recorded - message.header.stamp) * 1e-9, 0.1, 0.005, "a scan is recorded at its end, s after its stamp");
  return { stamp: message.header.stamp, points };
});
say(`${clouds.length} clouds in the common layout, column by column, by ring within one`);

const imus = on("/imu/data");
for (const { message } of imus)
  near(Math.hypot(...Object.values(message.orientation)), 1, 1e-9, "norm of the IMU's orientation");

// EuRoC: the same doubles, the same pixels.
const rows = lines("mav0", "imu0", "data.csv").map((line) => line.split(","));
assert.equal(rows.length, imus.length, "IMU rows of EuRoC");
rows.forEach(([stamp, ...values], i) => {
  const { header, angular_velocity: w, linear_acceleration: a } = imus[i].message;
  assert.equal(BigInt(stamp), header.stamp);
  assert.deepEqual(values.map(Number), [w.x, w.y, w.z, a.x, a.y, a.z], `IMU at ${stamp}`);
});
const images = new Map(on("/camera/image_raw").map(({ message }) => [message.header.stamp, message]));
const samePixels = (name, image) => {
  const png = PNG.sync.read(fs.readFileSync(name));
  assert.deepEqual([png.width, png.height, image.encoding], [image.width, image.height, "mono8"], name);
  for (let i = 0; i < image.data.length; ++i) assert.equal(png.data[4 * i], image.data[i], `${name}: pixel ${i}`);
};
const listed = lines("mav0", "cam0", "data.csv").map((line) => line.split(","));
assert.ok(listed.length >= images.size - 2 && listed.length > 0, `${listed.length} images of EuRoC, ${images.size} messages`);
for (const [stamp, name] of listed) samePixels(file("mav0", "cam0", "data", name.trim()), images.get(BigInt(stamp)));
assert.equal(on("/camera/camera_info").length, images.size, "camera_info for each image");
say(`${rows.length} IMU rows and ${listed.length} images of EuRoC as in the messages`);

for (const line of lines("rgb.txt")) PNG.sync.read(fs.readFileSync(file(line.split(/\s+/)[1])));

// KITTI: x y z and reflectance of 0..1.
clouds.forEach(({ points }, scan) => {
  const name = file("velodyne", `${String(scan).padStart(6, "0")}.bin`);
  const bytes = fs.readFileSync(name);
  assert.equal(bytes.length, 16 * points.length, name);
  points.forEach((point, i) => {
    for (let k = 0; k < 3; ++k) assert.equal(bytes.readFloatLE(16 * i + 4 * k), point[k], `${name}: point ${i}`);
    near(bytes.readFloatLE(16 * i + 12), point[3] / 255, 1e-6, `${name}: reflectance of point ${i}`);
  });
});
const times = numbers("times.txt");
assert.equal(times.length, clouds.length, "times of KITTI");
times.forEach(([t], i) => near(t, Number(clouds[i].stamp - clouds[0].stamp) * 1e-9, 1e-6, `time of scan ${i}`));
say(`${clouds.length} scans of KITTI as in the messages`);

// Truth.
const truth = on("/truth/odometry");
const tum = numbers("truth.tum");
assert.equal(tum.length, truth.length, "poses of truth.tum");
tum.forEach((row, i) => {
  assert.equal(row.length, 8);
  const { position: p, orientation: q } = truth[i].message.pose.pose;
  [p.x, p.y, p.z, q.x, q.y, q.z, q.w].forEach((value, k) => near(row[k + 1], value, 1e-6, `truth.tum, row ${i}`));
});
assert.deepEqual(truth.map((m) => m.message.header.stamp), clouds.map((cloud) => cloud.stamp), "stamps of truth and scans");

// PCD and PLY through PCL: binary to text.
const quiet = { stdio: ["ignore", "ignore", "pipe"] };
for (const scan of [0, clouds.length - 1]) {
  const name = String(scan).padStart(6, "0");
  const [fromPcd, fromPly, fromPlyText] = ["pcd.pcd", "ply.pcd", "ply_text.pcd"].map((end) => path.join(scratch, end));
  execFileSync("pcl_convert_pcd_ascii_binary", [file("pcd", `${name}.pcd`), fromPcd, "0", "9"], quiet);
  execFileSync("pcl_ply2pcd", [file("ply", `${name}.ply`), fromPly], quiet);
  execFileSync("pcl_convert_pcd_ascii_binary", [fromPly, fromPlyText, "0", "9"], quiet);
  for (const text of [fromPcd, fromPlyText]) {
    const [header, data] = fs.readFileSync(text, "utf8").split(/DATA ascii\n/);
    assert.match(header, /^FIELDS x y z intensity ring time$/m, text);
    const points = data.trim().split("\n").map((line) => line.split(" ").map(Number));
    assert.equal(points.length, clouds[scan].points.length, text);
    points.forEach((point, i) =>
      point.forEach((value, k) => assert.equal(Math.fround(value), clouds[scan].points[i][k], `${text}: point ${i}`)),
    );
  }
}
say("PCD and PLY as PCL reads them as in the messages");

#!/usr/bin/env bash
# What vsslam writes, read by programs that others wrote. run.sh SOURCE_FOLDER BUILD_FOLDER
set -euo pipefail
source=$1 build=$2
scripts=$source/tests/external
work=$build/external  # the readers from npm stay in it from one time to the next
data=$work/data
export VSSLAM_HOME=$source

stop() {
  echo "external: $*" >&2
  exit 1
}
for program in node npm pcl_pcd2ply; do
  command -v "$program" >/dev/null || stop "$program is missing; ./vsslam test --external installs it"
done
/usr/bin/python3 -c 'import rosbag, roslz4' || stop "python3-rosbag is missing; ./vsslam test --external installs it"

rm -rf "$data"
mkdir -p "$data"
cp "$scripts"/* "$work"
cd "$work"
if ! cmp -s package-lock.json node_modules/.installed-lock.json; then
  npm ci --no-audit --no-fund >npm.log 2>&1 || {
    cat npm.log >&2
    stop "npm ci failed (above): can the npm registry $(npm config get registry) be reached?"
  }
  cp package-lock.json node_modules/.installed-lock.json
fi

echo "== messages"
"$build/tests/write_messages" data/messages.bag data/messages.mcap
node check_messages.mjs data/messages.bag data/messages.mcap
/usr/bin/python3 check_bag.py data/messages.bag
/usr/bin/python3 copy_bag.py data/messages.bag data/copy
node copy_mcap.mjs data/messages.mcap data/copy
"$build/tests/same_messages" data/messages.bag data/copy_*.bag
"$build/tests/same_messages" data/messages.mcap data/copy_*.mcap

echo "== worlds"
for world in corridor gate street room; do
  "$build/vsslam" world "$world" --out "data/$world.glb" >/dev/null
done
node check_worlds.mjs data/*.glb
echo "== datasets"
"$build/vsslam" export quick_room --set max_duration_s=3 --format bag,mcap,euroc,kitti,pcd,ply,tum --with camera \
  --out data/quick_room --quiet
node check_dataset.mjs data/quick_room data
/usr/bin/python3 check_bag.py data/quick_room/*.bag
"$build/tests/opencv_images" data/quick_room/*.mcap data/quick_room
rm -rf data/quick_room
echo "external: all readers agree"

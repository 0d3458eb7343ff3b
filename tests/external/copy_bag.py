"""Copies a bag by ROS 1's own Python writer, once in each compression, in small chunks and another order.

usage: copy_bag.py FILE.bag OUT_PREFIX
"""

import sys

import rosbag

source, prefix = sys.argv[1:]
with rosbag.Bag(source) as bag:
    messages = list(bag.read_messages(raw=True))
for compression in ("none", "bz2", "lz4"):
    with rosbag.Bag(f"{prefix}_{compression}.bag", "w", compression=compression, chunk_threshold=500) as copy:
        for topic, message, recorded in reversed(messages):
            copy.write(topic, message, recorded, raw=True)

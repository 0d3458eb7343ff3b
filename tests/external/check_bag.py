"""ROS 1's own Python reader on bags: every message decodes, times ascend, checksums of definitions agree.

usage: check_bag.py FILE.bag...
"""

import collections
import sys

import rosbag


def check(path):
    topics = collections.Counter()
    with rosbag.Bag(path) as bag:
        last = None
        for topic, message, recorded in bag.read_messages():
            assert last is None or recorded >= last, f"{path}: {topic} recorded at {recorded}, after {last}"
            last = recorded
            topics[topic] += 1
        info = bag.get_type_and_topic_info().topics
        assert {topic: info[topic].message_count for topic in info} == topics, f"{path}: counts of the index differ"
        for connection in bag._get_connections():
            # Made from the definition in the file, by another generator than the one that wrote it.
            made = rosbag.bag._get_message_type(connection)
            assert made._md5sum == connection.md5sum, f"{path}: {connection.topic}: md5sum {connection.md5sum}"
    print(f"{path}: {sum(topics.values())} messages of {len(topics)} topics by rosbag for Python")


for path in sys.argv[1:]:
    check(path)

"""Writes a bag of ROS 1: write_ros1_bag.py BAG none|bz2|lz4

Standard input has a message a line, as JSON: topic, type, time (ns) and data (base64). rosbag's own classes read and
write each message.
"""

import base64
import json
import sys

import genpy
import rosbag
import roslib.message

path, compression = sys.argv[1:]
with rosbag.Bag(path, "w", compression=compression) as bag:
    for line in sys.stdin:
        record = json.loads(line)
        message = roslib.message.get_message_class(record["type"])()
        message.deserialize(base64.b64decode(record["data"]))
        seconds, nanoseconds = divmod(int(record["time"]), 10**9)
        bag.write(record["topic"], message, genpy.Time(seconds, nanoseconds))

#!/usr/bin/env python3
"""Writes a bag of poses alone with PyPI's rosbags, as other people's recorders do.

usage: write_pose_bag.py POSES.csv BAG [--storage mcap|sqlite3] [--version 8|9] [--topic NAME]

The CSV has the header t,x,y,z,qx,qy,qz,qw; every row becomes a geometry_msgs/msg/PoseStamped, stamped t.
"""

import argparse
import csv

from rosbags.rosbag2 import StoragePlugin, Writer
from rosbags.typesys import Stores, get_typestore


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("poses")
    parser.add_argument("bag")
    parser.add_argument("--storage", choices=["mcap", "sqlite3"], default="mcap")
    parser.add_argument("--version", type=int, choices=[8, 9], default=9)
    parser.add_argument("--topic", default="/hand/pose")
    args = parser.parse_args()
    store = get_typestore(Stores.ROS2_JAZZY)
    types = store.types
    kind = "geometry_msgs/msg/PoseStamped"
    plugin = StoragePlugin.MCAP if args.storage == "mcap" else StoragePlugin.SQLITE3
    with Writer(args.bag, version=args.version, storage_plugin=plugin) as bag, open(args.poses) as rows:
        connection = bag.add_connection(args.topic, kind, typestore=store)
        for row in csv.DictReader(rows):
            ns = round(float(row["t"]) * 1e9)
            stamp = types["builtin_interfaces/msg/Time"](sec=ns // 10**9, nanosec=ns % 10**9)
            header = types["std_msgs/msg/Header"](stamp=stamp, frame_id="world")
            point = types["geometry_msgs/msg/Point"](*(float(row[k]) for k in ("x", "y", "z")))
            turn = types["geometry_msgs/msg/Quaternion"](*(float(row[k]) for k in ("qx", "qy", "qz", "qw")))
            pose = types["geometry_msgs/msg/Pose"](position=point, orientation=turn)
            message = types[kind](header=header, pose=pose)
            bag.write(connection, ns, store.serialize_cdr(message, kind))


main()

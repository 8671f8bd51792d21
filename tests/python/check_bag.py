#!/usr/bin/env python3
"""Opens bags with two readers that know nothing of this project, and checks what they find.

usage: check_bag.py [--messages DIR] [--ticks-at-least N] [--topics T,T,...] BAG...

rosbags (PyPI) reads the folder with metadata.yaml, mcap with mcap-ros2-support the files by their index. Every message of
every topic is decoded by both, their contents and counts must agree, sequence numbers of ticks must go on without a gap,
and type hashes must be those that rosbags computes from the definitions. Exit 0, or 1 with one line.
"""

import argparse
import dataclasses
import math
import sys
from pathlib import Path

from mcap.reader import make_reader
from mcap_ros2.decoder import DecoderFactory
from rosbags.rosbag2 import Reader
from rosbags.typesys import Stores, get_types_from_msg, get_typestore

TICKS = "cspace_haptics_msgs/msg/TickBatch"


def fail(text):
    print(f"error: {text}", file=sys.stderr)
    sys.exit(1)


def is_same(a, b):
    """The same message from both readers, whatever Python types they use."""
    if dataclasses.is_dataclass(a):
        return all(is_same(getattr(a, f.name), getattr(b, f.name)) for f in dataclasses.fields(a) if f.name.islower() and f.name[0] != "_")
    if isinstance(a, (str, bool)):
        return a == b
    if hasattr(a, "__len__"):
        return len(a) == len(b) and all(is_same(x, y) for x, y in zip(a, b))
    if isinstance(a, float) and math.isnan(a):
        return math.isnan(b)
    return a == b


def check_rosbags(bag, store):
    """Decodes everything; returns messages by topic and the largest gap-free run of ticks."""
    messages = {}
    with Reader(bag) as reader:
        for connection in reader.connections:
            types = get_types_from_msg(connection.msgdef.data, connection.msgtype)
            store.register({k: v for k, v in types.items() if k not in store.fielddefs})
            if connection.digest and connection.digest != store.hash_rihs01(connection.msgtype):
                fail(f"{bag}: {connection.msgtype}: hash {connection.digest} is not that of its definition")
            if not connection.ext.offered_qos_profiles:
                fail(f"{bag}: {connection.topic} has no QoS")
        for connection, stamp, data in reader.messages(reader.connections):
            message = store.deserialize_cdr(data, connection.msgtype)
            messages.setdefault((connection.topic, connection.msgtype), []).append((stamp, message))
        found = sum(len(m) for m in messages.values())
        if found != reader.message_count:
            fail(f"{bag}: metadata promises {reader.message_count} messages, rosbags finds {found}")
    return messages


def check_mcap(bag, messages):
    """Reads the files by their index and compares with what rosbags read."""
    seen = {key: 0 for key in messages}
    for path in sorted(Path(bag).glob("*.mcap"), key=lambda p: int(p.stem.rsplit("_", 1)[-1])):
        with path.open("rb") as stream:
            reader = make_reader(stream, validate_crcs=True, decoder_factories=[DecoderFactory()])
            summary = reader.get_summary()
            if summary is None or summary.statistics is None:
                fail(f"{path}: no summary")
            count = 0
            for schema, channel, message, decoded in reader.iter_decoded_messages():
                key = (channel.topic, schema.name)
                stamp, other = messages[key][seen[key]]
                if stamp != message.log_time or not is_same(other, decoded):
                    fail(f"{path}: message {seen[key]} of {channel.topic} differs between the readers")
                seen[key] += 1
                count += 1
            if count != summary.statistics.message_count:
                fail(f"{path}: the summary promises {summary.statistics.message_count} messages, {count} are there")
    for key, n in seen.items():
        if n != len(messages[key]):
            fail(f"{bag}: {key[0]}: rosbags reads {len(messages[key])} messages, mcap {n}")


def check_ticks(bag, messages):
    """Sequence numbers of ticks go on without a gap; returns how many ticks there are."""
    ticks = 0
    for (topic, kind), batches in messages.items():
        if kind != TICKS:
            continue
        expected = None
        for _, batch in batches:
            for tick in batch.ticks:
                if expected is not None and tick.sequence != expected:
                    fail(f"{bag}: {topic}: tick {tick.sequence} follows {expected - 1}")
                expected = tick.sequence + 1
                ticks += 1
    return ticks


def check_files(directory, store):
    """The .msg files of this project give the hashes that stand in the bags."""
    types = {}
    for path in Path(directory).glob("*.msg"):
        types.update(get_types_from_msg(path.read_text(), f"cspace_haptics_msgs/msg/{path.stem}"))
    store.register(types)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--messages", help="folder of this project's .msg files: definitions in the bag must match them")
    parser.add_argument("--ticks-at-least", type=int, default=0)
    parser.add_argument("--topics", default="", help="topics that must be there, separated by commas")
    parser.add_argument("bags", nargs="+")
    args = parser.parse_args()
    for bag in args.bags:
        store = get_typestore(Stores.ROS2_JAZZY)
        if args.messages:
            check_files(args.messages, store)
        messages = check_rosbags(bag, store)
        check_mcap(bag, messages)
        ticks = check_ticks(bag, messages)
        if ticks < args.ticks_at_least:
            fail(f"{bag}: {ticks} ticks, expected at least {args.ticks_at_least}")
        missing = [t for t in args.topics.split(",") if t and t not in {topic for topic, _ in messages}]
        if missing:
            fail(f"{bag}: no messages on {', '.join(missing)}")
        print(f"{bag}: {sum(len(m) for m in messages.values())} messages on {len(messages)} topics, {ticks} ticks")


main()

"""An independent ROS 2 client: rclpy, which knows nothing of this project but its messages."""

import os
import threading
import time

import rclpy
from cspace_haptics_msgs.msg import TickBatch
from rclpy.executors import SingleThreadedExecutor
from rclpy.qos import DurabilityPolicy, HistoryPolicy, QoSProfile, ReliabilityPolicy
from rclpy.serialization import deserialize_message

from support import PATIENCE, wait_until


def qos(reliable=False, latched=False, depth=1000):
    """A subscriber's profile."""
    return QoSProfile(
        history=HistoryPolicy.KEEP_LAST,
        depth=depth,
        reliability=ReliabilityPolicy.RELIABLE if reliable else ReliabilityPolicy.BEST_EFFORT,
        durability=DurabilityPolicy.TRANSIENT_LOCAL if latched else DurabilityPolicy.VOLATILE,
    )


class Client:
    """A node with a thread that spins it; a context."""

    def __init__(self, name="observer", domain=None):
        self.context = rclpy.Context()
        rclpy.init(context=self.context, domain_id=int(domain or os.environ["ROS_DOMAIN_ID"]))
        self.node = rclpy.create_node(name, context=self.context)
        self.executor = SingleThreadedExecutor(context=self.context)
        self.executor.add_node(self.node)
        self.stopping = threading.Event()
        self.thread = threading.Thread(target=self._spin, daemon=True)
        self.thread.start()

    def _spin(self):
        while not self.stopping.is_set():
            self.executor.spin_once(timeout_sec=0.05)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.stopping.set()
        self.thread.join(timeout=PATIENCE)
        self.executor.shutdown()
        # Fast DDS can spin for ever over a participant that goes while it hears of another that goes: first come, first gone.
        time.sleep(0.2)
        self.node.destroy_node()
        rclpy.shutdown(context=self.context)

    def listen(self, kind, topic, profile, raw=False):
        """A list that grows with what comes on `topic`; `raw` keeps bytes, for topics that are faster than Python."""
        heard = []
        self.node.create_subscription(kind, topic, heard.append, profile, raw=raw)
        return heard

    def wait(self, heard, count=1, what="messages"):
        wait_until(lambda: len(heard) >= count, f"{count} {what}, {len(heard)} came")
        return heard

    def call(self, kind, name, request):
        client = self.node.create_client(kind, name)
        wait_until(client.service_is_ready, f"service {name}")
        future = client.call_async(request)
        wait_until(future.done, f"answer of {name}")
        return future.result()


class Ticks:
    """What a servo tells of its ticks, kept as bytes until somebody asks: making objects of them all is slower than a busy
    machine's ticks come."""

    def __init__(self, client, topic):
        # Room for a minute: Python may be slow to take even the bytes.
        self.heard = client.listen(TickBatch, topic, qos(reliable=True, depth=6000), raw=True)
        self.decoded = []

    def batches(self):
        """All so far."""
        self.decoded += messages(self.heard[len(self.decoded):], TickBatch)
        return self.decoded

    def all(self):
        return [tick for batch in self.batches() for tick in batch.ticks]

    def since(self, count):
        """Those of all batches but the first `count`."""
        return [tick for batch in messages(self.heard[count:], TickBatch) for tick in batch.ticks]

    def newest(self):
        wait_until(lambda: self.heard, "a tick")
        return deserialize_message(self.heard[-1], TickBatch).ticks[-1]


def messages(heard, kind):
    """The messages that were kept as bytes."""
    return [deserialize_message(each, kind) for each in list(heard)]


def seconds(stamp):
    return stamp.sec + stamp.nanosec * 1e-9


def norm(vector):
    return (vector.x**2 + vector.y**2 + vector.z**2) ** 0.5

"""Whether looking costs the servo anything, in one run of one servo: its wake-up and tick times while nobody looks, while
the inspector writes a file, while a viewer draws, while that viewer is stopped (SIGSTOP), and, as a control, while
processes that have nothing to do with it compute or copy memory. The phases take turns, so that whatever drifts hits all
alike; what the rounds of one phase differ by is the noise that the differences between phases are to be held against.

The set-up is that of a cell: the servo's thread alone on one processor (`realtime.cpu`), everything else on the others.
No test, since it asserts no times; run it on a quiet machine with two processors or more, as root:

    eval "$(cargo xtask env)"; ROS_DOMAIN_ID=87 CSPACE_HAPTICS_ROOT=$PWD CSPACE_HAPTICS_BIN=target/release \\
        CSPACE_HAPTICS_TOOLS=TOOLS TOOLS/bin/python tests/python/watched.py [--rounds N] [--seconds S] [--shared]

TOOLS is the environment of nodes/xtask/python-tools.lock. `--shared` leaves every process on every processor.
"""

import argparse
import os
import shutil
import signal
import socket
import statistics
import subprocess
import sys
import tempfile
import time
from contextlib import ExitStack, contextmanager
from pathlib import Path

from rosbags.rosbag2 import Reader
from rosbags.typesys import Stores, get_types_from_msg, get_typestore

from support import ROOT, TOOLS, Process, node, wait_until

SCENE = ROOT / "config/scenes/peg_in_hole/scene.yaml"
# A processor without a graphics card draws slowly.
VIEWER_PATIENCE = 60.0
# What a phase takes to settle, s; left out of its times.
SETTLING = 1.0
COMPUTE = "while True: pass"
COPY = "a, b = bytearray(64 << 20), bytearray(64 << 20)\nwhile True: a[:] = b"


def free_port():
    with socket.socket() as s:
        s.bind(("127.0.0.1", 0))
        return s.getsockname()[1]


def listens(port):
    with socket.socket() as s:
        return s.connect_ex(("127.0.0.1", port)) == 0


class Watchers:
    """The phases: each a context in which somebody does or does not look."""

    def __init__(self, folder, strangers):
        self.folder = folder
        self.strangers = strangers
        self.port = free_port()
        # The viewer itself, not the Python program that starts it: a signal must hit what draws.
        program = next(TOOLS.glob("lib/*/site-packages/rerun_sdk/rerun_cli/rerun"))
        arguments = ["--headless", "--bind", "127.0.0.1", "--port", self.port, "--memory-limit", "500MB"]
        self.viewer = Process(program, *arguments, env={"XDG_RUNTIME_DIR": str(folder), "RUST_LOG": "off"})
        wait_until(lambda: listens(self.port), "the viewer to listen", VIEWER_PATIENCE)
        self.rest()

    def rest(self):
        os.kill(self.viewer.process.pid, signal.SIGSTOP)

    def wake(self):
        os.kill(self.viewer.process.pid, signal.SIGCONT)

    @contextmanager
    def nobody(self):
        yield

    @contextmanager
    def file(self):
        with node("haptic_inspect", output=self.folder / "run.rrd").wait_ready() as inspect:
            yield
            inspect.end()

    @contextmanager
    def drawing(self, stopped=False):
        self.wake()
        with node("haptic_inspect", viewer=True, address=f"127.0.0.1:{self.port}").wait_ready() as inspect:
            time.sleep(SETTLING)
            if stopped:
                self.rest()
            yield
            self.wake()
            inspect.end()
        self.rest()

    def stopped(self):
        return self.drawing(stopped=True)

    @contextmanager
    def strange(self, work):
        with ExitStack() as stack:
            for _ in range(self.strangers):
                stack.enter_context(Process(sys.executable, "-c", work))
            yield

    def phases(self):
        return {
            "nobody looks": self.nobody,
            "to a file": self.file,
            "viewer draws": self.drawing,
            "viewer stopped": self.stopped,
            "others compute": lambda: self.strange(COMPUTE),
            "others copy": lambda: self.strange(COPY),
        }

    def close(self):
        self.wake()
        self.viewer.__exit__()


def ticks_of(bag):
    """Time (s), wake-up latency (us) and tick (us) of every tick in a bag."""
    store = get_typestore(Stores.ROS2_JAZZY)
    with Reader(bag) as reader:
        connections = [c for c in reader.connections if c.msgtype.endswith("/TickBatch")]
        for connection in connections:
            types = get_types_from_msg(connection.msgdef.data, connection.msgtype)
            store.register({k: v for k, v in types.items() if k not in store.fielddefs})
        for connection, _, data in reader.messages(connections):
            for tick in store.deserialize_cdr(data, connection.msgtype).ticks:
                yield tick.stamp.sec + tick.stamp.nanosec * 1e-9, tick.wakeup_ns * 1e-3, tick.compute_ns * 1e-3


def percentile(values, share):
    return sorted(values)[min(int(share * len(values)), len(values) - 1)]


FIGURES = [(what, column, share) for column, what in [(1, "wakeup"), (2, "tick")] for share in (0.5, 0.99)]


def run(servo_cpu, arguments, strangers):
    """Runs all phases; returns for each the figures of its rounds."""
    with ExitStack() as stack:
        folder = Path(stack.enter_context(tempfile.TemporaryDirectory()))
        pinned = {} if servo_cpu is None else {"realtime__cpu": servo_cpu}
        # Quick enough that every phase sees the same of the motion: each contact has a price of its own.
        quick = {"device__operator__speed": 4.0}
        servo = stack.enter_context(node("haptic_servo", scene=SCENE, enabled=True, **quick, **pinned)).wait_ready()
        recorder = stack.enter_context(node("haptic_recorder", output=folder / "bag")).wait_ready()
        recorder.wait_for_line("/haptic_servo/ticks")
        watchers = Watchers(folder, strangers)
        stack.callback(watchers.close)
        phases = list(watchers.phases().items())
        spans = {name: [] for name, _ in phases}
        for turn in range(arguments.rounds):
            # Another order each time: no phase always follows the same one.
            for name, phase in phases[turn % len(phases) :] + phases[: turn % len(phases)]:
                with phase():
                    time.sleep(SETTLING)
                    begun = time.time()
                    time.sleep(arguments.seconds)
                    spans[name].append((begun, time.time()))
        servo.end()
        recorder.end()
        ticks = list(ticks_of(folder / "bag"))
    figures = {}
    for name, rounds in spans.items():
        within = [[t for t in ticks if begun <= t[0] < end] for begun, end in rounds]
        figures[name] = {(what, share): [percentile([t[column] for t in r], share) for r in within] for what, column, share in FIGURES}
    return figures, len(ticks)


def bare_loop(servo_cpu, seconds, strangers):
    """What cyclictest, which knows nothing of us, says of the same processor: p50 and p99 of its wake-up, in us."""
    affinity = [] if servo_cpu is None else ["-a", str(servo_cpu)]
    command = ["cyclictest", "-q", "-m", "-t", "1", "-p", "80", "-i", "1000", "-h", "2000", "-D", str(max(round(seconds), 1)), *affinity]
    with ExitStack() as stack:
        for work in strangers:
            stack.enter_context(Process(sys.executable, "-c", work))
        text = subprocess.run(command, capture_output=True, text=True, check=True).stdout
    counts = [tuple(map(int, line.split())) for line in text.splitlines() if line[:1].isdigit()]
    latencies = [us for us, count in counts for _ in range(count)]
    return percentile(latencies, 0.5), percentile(latencies, 0.99)


def report(figures):
    quiet = figures["nobody looks"]
    print(f"{'':16}" + "".join(f"{f'{what} p{share * 100:.0f}':>30}" for what, _, share in FIGURES))
    for name, measured in figures.items():
        cells = []
        for what, _, share in FIGURES:
            rounds, base = measured[what, share], quiet[what, share]
            middle = statistics.median(rounds)
            more = statistics.median([a - b for a, b in zip(rounds, base)])
            change = "" if rounds is base else f"{more:+6.1f}"
            cells.append(f"{middle:8.1f} ({min(rounds):.1f}-{max(rounds):.1f}) {change:>6}")
        print(f"{name:16}" + "".join(f"{cell:>30}" for cell in cells))
    print("us: median of the rounds (least-most of them), and the median difference from the same round with nobody looking")


def main():
    parser = argparse.ArgumentParser(description=__doc__.partition("\n\n")[0])
    parser.add_argument("--rounds", type=int, default=6)
    parser.add_argument("--seconds", type=float, default=3.0)
    parser.add_argument("--shared", action="store_true", help="leave every process on every processor")
    arguments = parser.parse_args()
    allowed = sorted(os.sched_getaffinity(0))
    if arguments.shared or len(allowed) < 2:
        servo_cpu, others = None, allowed
    else:
        servo_cpu, others = allowed[-1], allowed[:-1]
        # Children inherit it; the servo's thread alone leaves for its own processor.
        os.sched_setaffinity(0, others)
    print(f"servo thread: {'any processor' if servo_cpu is None else f'processor {servo_cpu}'}; all else: {others}", flush=True)
    if shutil.which("cyclictest"):
        for name, strangers in [("alone", []), ("others compute", [COMPUTE] * len(others)), ("others copy", [COPY] * len(others))]:
            p50, p99 = bare_loop(servo_cpu, arguments.seconds, strangers)
            print(f"cyclictest, {name}: wakeup p50 {p50}, p99 {p99} us", flush=True)
    figures, count = run(servo_cpu, arguments, len(others))
    report(figures)
    print(f"{count} ticks")


if __name__ == "__main__":
    sys.exit(main())

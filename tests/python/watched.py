"""Whether looking costs the servo anything: the histograms of its wake-up and of its tick with nobody looking, with a
viewer that draws, and with one that is stopped (SIGSTOP). No test, since it asserts no times; run it on a quiet machine:

    eval "$(cargo xtask env)"; ROS_DOMAIN_ID=87 CSPACE_HAPTICS_ROOT=$PWD CSPACE_HAPTICS_BIN=target/release \\
        CSPACE_HAPTICS_TOOLS=$VIRTUAL_ENV python3 tests/python/watched.py [SECONDS]
"""

import os
import re
import signal
import socket
import sys
import tempfile
import time
from pathlib import Path

from support import ROOT, TOOLS, Process, node, wait_until

SCENE = ROOT / "config/scenes/peg_in_hole/scene.yaml"
# A processor without a graphics card draws slowly.
VIEWER_PATIENCE = 60.0


def free_port():
    with socket.socket() as s:
        s.bind(("127.0.0.1", 0))
        return s.getsockname()[1]


def listens(port):
    with socket.socket() as s:
        return s.connect_ex(("127.0.0.1", port)) == 0


def viewer(port):
    """The viewer itself, not the Python program that starts it: a signal must hit what draws."""
    program = next(TOOLS.glob("lib/*/site-packages/rerun_sdk/rerun_cli/rerun"))
    env = {"XDG_RUNTIME_DIR": tempfile.gettempdir(), "RUST_LOG": "off"}
    arguments = ["--headless", "--bind", "127.0.0.1", "--port", port, "--memory-limit", "500MB"]
    return Process(program, *arguments, env=env)


def histograms(servo):
    """The two lines that the servo says at its end, as (p50, p99, p99.9, max) in microseconds."""
    found = {}
    for what in ["wakeup", "tick"]:
        # Later lines hold the earlier ones' ticks.
        line = [line for line in servo.lines if f"{what}: mean" in line][-1]
        numbers = re.search(r"p50 ([\d.]+), p99 ([\d.]+), p99.9 ([\d.]+), max ([\d.]+) \(n = (\d+)\)", line.split(f"{what}: ")[1])
        found[what] = numbers.groups()
    return found


def run(watching, seconds):
    """One run of servo, inspector and viewer; `watching` is "off", "on" or "stopped"."""
    port = free_port()
    opened = [node("haptic_servo", scene=SCENE, enabled=True)]
    servo = opened[0].wait_ready()
    drawn = ""
    try:
        if watching != "off":
            shown = viewer(port)
            opened.append(shown)
            wait_until(lambda: listens(port), "the viewer to listen", VIEWER_PATIENCE)
            inspect = node("haptic_inspect", viewer=True, address=f"127.0.0.1:{port}").wait_ready()
            opened.append(inspect)
            time.sleep(2.0)
            if watching == "stopped":
                os.kill(shown.process.pid, signal.SIGSTOP)
        time.sleep(seconds)
        servo.end()
        if watching != "off":
            inspect.end()
            drawn = next((line for line in inspect.lines if "drawn:" in line or "not taken" in line), "")
    finally:
        for process in opened[::-1]:
            process.__exit__()
    return histograms(servo), drawn


def main():
    seconds = float(sys.argv[1]) if len(sys.argv) > 1 else 15.0
    print(f"{'inspect':8} {'what':7} {'p50':>7} {'p99':>8} {'p99.9':>8} {'max':>8} us   ticks", flush=True)
    for watching in ["off", "on", "stopped"]:
        found, drawn = run(watching, seconds)
        for what, (p50, p99, p999, most, count) in found.items():
            print(f"{watching:8} {what:7} {p50:>7} {p99:>8} {p999:>8} {most:>8}      {count}", flush=True)
        if drawn:
            print(f"         {drawn}", flush=True)


if __name__ == "__main__":
    sys.exit(main())

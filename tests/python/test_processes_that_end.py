"""What the hand feels when a process ends or is killed, and how old a force is that came through topics: measured at the
device's side, by the stamps of haptic_device, on one clock."""

import bisect
import signal
import tempfile
import time
import unittest
from pathlib import Path

import motions
from client import Client, Ticks, messages, norm, qos
from cspace_haptics_msgs.msg import TickBatch, TickRecord
from geometry_msgs.msg import PoseStamped, WrenchStamped
from support import enter, node, wait_until

DEPTH, STIFFNESS = 0.001, 1000.0
FORCE = DEPTH * STIFFNESS
SIGNALS = {"SIGTERM": signal.SIGTERM, "SIGKILL": signal.SIGKILL}


def nanoseconds(stamp):
    return stamp.sec * 10**9 + stamp.nanosec


class Hands(unittest.TestCase):
    def setUp(self):
        self.folder = Path(enter(self, tempfile.TemporaryDirectory()))
        self.client = enter(self, Client("observer"))
        self.running = {}

    def start(self, name, **parameters):
        self.running[name] = enter(self, node(name, cwd=self.folder, **parameters)).wait_ready()
        return self.running[name]

    def start_device(self, depth=lambda t: DEPTH, rate=500, **parameters):
        poses = motions.write(self.folder / "poses.csv", depth, 120, rate)
        self.start("haptic_device", device__driver="replay", device__file=poses, scene=motions.SCENE, enabled=True, **parameters)

    def start_servo(self, **parameters):
        # What is measured is the device's own patience: the servo's is left wide where a busy machine would end it first.
        self.start("haptic_servo", scene=motions.SCENE, device__driver="topic", device__timeout=parameters.pop("timeout", 0.2),
                   enabled=True, limits__ramp_time=0.01, gains__stiffness=STIFFNESS, **motions.PLAIN, **parameters)


class ProcessesThatEnd(Hands):
    rows = []

    def setUp(self):
        super().setUp()
        # A thousand a second, kept as bytes: Python on a busy machine does not make objects of so many.
        self.shown = self.client.listen(WrenchStamped, "/haptic_device/wrench", qos(), raw=True)

    @classmethod
    def tearDownClass(cls):
        print("\n| process | signal | force on the hand | after |\n|---|---|---|---|")
        for row in cls.rows:
            print("| " + " | ".join(row) + " |")

    def row(self, name, how, what, since_ns, at_ns):
        self.rows.append((f"`{name}`", how, what, "" if at_ns is None else f"{(at_ns - since_ns) * 1e-6:.1f} ms"))

    def wrenches(self, begin):
        """From number `begin` on, as Python counts them."""
        return messages(self.shown[begin:], WrenchStamped)

    def wait_for_force(self, force=FORCE):
        def steady():
            last = self.wrenches(-50)
            fresh = last and time.time_ns() - nanoseconds(last[-1].header.stamp) < 10**9
            return len(last) == 50 and fresh and all(abs(norm(m.wrench.force) - force) < 1e-6 for m in last)

        wait_until(steady, f"{force} N at the hand; {[norm(m.wrench.force) for m in self.wrenches(-1)]}")

    def end(self, name, how):
        """Signals a process; returns when, and how many wrenches had been heard by then."""
        heard = len(self.shown)
        since = time.time_ns()
        self.running[name].process.send_signal(SIGNALS[how])
        code = self.running[name].wait()
        self.assertEqual(code, 0 if how == "SIGTERM" else -signal.SIGKILL, self.running[name].text)
        return since, heard

    def first(self, heard, since, condition, what):
        """The stamp of the first wrench after `since` that is as wanted."""

        def look():
            for message in self.wrenches(heard):
                if nanoseconds(message.header.stamp) > since and condition(norm(message.wrench.force)):
                    return message
            return None

        return nanoseconds(wait_until(look, what).header.stamp)

    def test_0_the_middleware_shares_no_memory_that_a_killed_process_could_leave_locked(self):
        self.start_device()
        threads = Path(f"/proc/{self.running['haptic_device'].process.pid}/task").glob("*/comm")
        names = [thread.read_text().strip() for thread in threads]
        self.assertEqual([name for name in names if name.startswith("dds.shm")], [], "see config/fastdds_loopback.xml")

    def test_1_a_servo_that_ends_leaves_no_force(self):
        self.start_device()
        for how in SIGNALS:
            self.start_servo()
            self.wait_for_force()
            since, heard = self.end("haptic_servo", how)
            zero = self.first(heard, since, lambda f: f == 0.0, "no force")
            # A device that stood still meanwhile takes up what was said before the end, and lets it go again.
            self.wait_for_force(0.0)
            before = len(self.shown)
            wait_until(lambda: len(self.shown) > before + 200, "200 more wrenches")
            self.assertTrue(all(norm(m.wrench.force) == 0.0 for m in self.wrenches(before)), "force came back by itself")
            self.row("haptic_servo", how, "zero", since, zero)

    def test_2_a_device_that_ends_is_commanded_no_force(self):
        ticks = Ticks(self.client, "/haptic_servo/ticks")
        self.start_servo(timeout=0.02)
        for how in SIGNALS:
            self.start_device()
            self.wait_for_force()
            before = len(ticks.heard)
            since, _ = self.end("haptic_device", how)

            def cut():
                """The ticks after the end, from the first stale one on."""
                after = [t for t in ticks.since(before) if nanoseconds(t.stamp) > since]
                first = next((i for i, t in enumerate(after) if t.health & TickRecord.HEALTH_STALE), len(after))
                return after[first:] if len(after) > first + 100 else None

            stale = wait_until(cut, "stale ticks")
            tick = stale[0]
            # A servo that stood still takes up what was said before the end: its sample is young for a moment.
            self.assertTrue(all(norm(t.out_wrench.force) == 0.0 for t in stale if t.health & TickRecord.HEALTH_STALE))
            self.assertTrue(stale[-1].health & TickRecord.HEALTH_STALE)
            if how == "SIGTERM":
                wait_until(lambda: norm(self.wrenches(-1)[0].wrench.force) == 0.0, "the device's last word to be zero")
            self.row("haptic_device", how, "command zero, health stale", since, nanoseconds(tick.stamp))

    def test_3_who_only_listens_takes_nothing_along(self):
        ticks = Ticks(self.client, "/haptic_servo/ticks")
        # A busy machine must not pass for somebody's end.
        self.start_device(command_timeout=1.0)
        self.start_servo(timeout=1.0)
        for name in ("haptic_recorder", "haptic_inspect"):
            for how in SIGNALS:
                # A machine that stalls for longer than the time-outs takes the force away, too; hardly three times over.
                self.assertTrue(any(self.goes_on(name, how, attempt) for attempt in range(3)), f"{name}, {how}: force faltered")
                self.row(name, how, "stays", 0, None)
        sequences = [t.sequence for t in ticks.all()]
        self.assertEqual(sequences, list(range(sequences[0], sequences[0] + len(sequences))), "ticks were lost")

    def goes_on(self, name, how, attempt):
        """Whether the force stays as it is when a listener is ended at its work."""
        output = self.folder / f"{name}_{how}_{attempt}"
        self.start(name, output=output)
        files = (lambda: output.glob("*.mcap")) if name == "haptic_recorder" else (lambda: [output])
        wait_until(lambda: sum(f.stat().st_size for f in files()) > 20_000, f"{name} to write")
        self.wait_for_force()
        _, heard = self.end(name, how)
        wait_until(lambda: len(self.shown) > heard + 300, "300 more wrenches")
        return all(abs(norm(m.wrench.force) - FORCE) < 1e-6 for m in self.wrenches(heard))

    def test_4_the_force_of_a_robot_that_ends_is_let_go(self):
        self.start_device()
        self.start_servo()
        # The robot follows the proxy, which stands on the floor, 1 mm in a wall of its own; a fifth of what it measures is
        # sent back.
        height, back = motions.STANDING + 0.001, 0.2 * 2000.0 * 0.001
        for how in SIGNALS:
            self.start("haptic_follower", remap=["~/wrench:=haptic_servo/remote_wrench"], wall__height=height,
                       wall__stiffness=2000.0, wall__damping=0.0, return_gain=0.2)
            self.wait_for_force(FORCE + back)
            since, heard = self.end("haptic_follower", how)
            gone = self.first(heard, since, lambda f: abs(f - FORCE) < 1e-6, "the law's force alone")
            self.row("haptic_follower", how, "the law's alone", since, gone)


class ThroughTopics(Hands):
    def test_the_age_of_a_force_that_came_through_topics(self):
        def listen(kind, topic, reliable=False):
            return self.client.listen(kind, topic, qos(reliable=reliable, depth=5000), raw=True)

        poses = listen(PoseStamped, "/haptic_device/pose")
        shown = listen(WrenchStamped, "/haptic_device/wrench")
        batches = listen(TickBatch, "/haptic_servo/ticks", reliable=True)
        self.start_servo()
        # Ever deeper: each force belongs to one pose.
        self.start_device(lambda t: 2e-4 + 2e-5 * t, rate=1000)
        wait_until(lambda: len(shown) > 6000, "6,000 wrenches")
        for process in self.running.values():
            self.assertEqual(process.end(), 0, process.text)
        sent = sorted((motions.STANDING - m.pose.position.z, nanoseconds(m.header.stamp)) for m in messages(poses, PoseStamped))
        depths = [depth for depth, _ in sent]
        ages, last = [], None
        for message in messages(shown, WrenchStamped):
            force = norm(message.wrench.force)
            # The ramp of the beginning is over by then.
            if force == last or force < 0.21:
                continue
            last = force
            near = min(bisect.bisect_left(depths, force / STIFFNESS - 5e-9), len(sent) - 1)
            depth, stamp = sent[near]
            # A pose that this listener missed is passed over.
            if abs(depth - force / STIFFNESS) < 5e-9:
                ages.append((nanoseconds(message.header.stamp) - stamp) * 1e-6)
        self.assertGreater(len(ages), 500)
        self.assertGreater(min(ages), 0.0, "a force older than its pose")
        waits = sorted((nanoseconds(t.stamp) - nanoseconds(t.sample.stamp)) * 1e-6 for b in messages(batches, TickBatch) for t in b.ticks
                       if t.sample.sequence and not t.health & TickRecord.HEALTH_STALE)
        ages.sort()

        def told(values):
            return f"median {values[len(values) // 2]:.2f}, p99 {values[len(values) * 99 // 100]:.2f}, max {values[-1]:.2f} ms (n = {len(values)})"

        print(f"\nthrough topics on loopback: sample to tick {told(waits)}; sample to force at the device {told(ages)}")


if __name__ == "__main__":
    unittest.main()

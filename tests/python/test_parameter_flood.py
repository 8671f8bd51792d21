"""Every live parameter set a hundred times a second, good values and bad ones, while a vendor's driver (this program, on
topics of its own names) holds the part in contact: force never steps, no tick is lost, and each bad value is refused with
its reason."""

import math
import random
import tempfile
import threading
import time
import unittest
from pathlib import Path

import motions
from client import Client, messages, norm, qos, seconds
from cspace_haptics_msgs.msg import TickBatch, TickRecord
from geometry_msgs.msg import PoseStamped, WrenchStamped
from launch_stub import Launch
from rcl_interfaces.msg import Parameter, ParameterType, ParameterValue
from rcl_interfaces.srv import DescribeParameters, ListParameters, SetParameters
from rclpy.qos import qos_profile_parameters
from support import enter, wait_until

SECONDS, RATE = 10.0, 100.0
# With it gains follow a change (nodes/servo/src/gain_ramp.rs), s.
RAMP = 0.05


def value(x):
    if isinstance(x, bool):
        return ParameterValue(type=ParameterType.PARAMETER_BOOL, bool_value=x)
    if isinstance(x, str):
        return ParameterValue(type=ParameterType.PARAMETER_STRING, string_value=x)
    return ParameterValue(type=ParameterType.PARAMETER_DOUBLE, double_value=x)


class Values:
    """Values for a parameter as its descriptor allows them, and such as it does not."""

    def __init__(self, descriptor):
        self.name = descriptor.name
        self.kind = descriptor.type
        self.span = descriptor.floating_point_range
        self.choices = descriptor.additional_constraints.removeprefix("one of ").split(", ")

    def good(self, chance):
        if self.kind == ParameterType.PARAMETER_BOOL:
            return value(chance.random() < 0.5)
        if self.kind == ParameterType.PARAMETER_STRING:
            return value(chance.choice(self.choices))
        low, high = self.span[0].from_value, self.span[0].to_value
        if low > 0:
            return value(min(high, max(low, math.exp(chance.uniform(math.log(low), math.log(high))))))
        return value(chance.uniform(low, high))

    def bad(self, chance):
        if self.kind == ParameterType.PARAMETER_BOOL:
            return value("perhaps")
        if self.kind == ParameterType.PARAMETER_STRING:
            return value(chance.choice(["no such choice", 1.0]))
        low, high = self.span[0].from_value, self.span[0].to_value
        return value(chance.choice([math.nan, math.inf, -math.inf, low - 1.0, high * 1.01 + 1.0, "much"]))


class Driver:
    """A vendor's driver: tells where the hand is, a few hundred times a second."""

    def __init__(self, client):
        self.out = client.node.create_publisher(PoseStamped, "/vendor/pose", qos(depth=1))
        self.wrenches = client.listen(WrenchStamped, "/vendor/wrench", qos())
        self.clock = client.node.get_clock()
        self.stopping = threading.Event()
        self.thread = threading.Thread(target=self._run, daemon=True)

    def _run(self):
        begun = time.monotonic()
        while not self.stopping.wait(0.003):
            t = time.monotonic() - begun
            message = PoseStamped()
            message.header.stamp = self.clock.now().to_msg()
            message.header.frame_id = "world"
            message.pose.position.x = -0.01 + 0.003 * math.sin(2.0 * t)
            message.pose.position.z = motions.STANDING - 0.001 - 0.0005 * math.sin(3.0 * t)
            tilt = 0.01 * math.sin(1.3 * t)
            message.pose.orientation.y, message.pose.orientation.w = math.sin(tilt / 2), math.cos(tilt / 2)
            self.out.publish(message)

    def __enter__(self):
        self.thread.start()
        return self

    def __exit__(self, *_):
        self.stopping.set()
        self.thread.join()


class Flood(unittest.TestCase):
    def setUp(self):
        folder = Path(enter(self, tempfile.TemporaryDirectory()))
        (folder / "servo.yaml").write_text("/**:\n  ros__parameters:\n    device: {timeout: 1.0}\n")
        self.client = enter(self, Client("console"))
        # Kept as bytes: making objects of them waits until the flood is over.
        self.batches = self.client.listen(TickBatch, "/haptic_servo/ticks", qos(reliable=True, latched=True, depth=5000), raw=True)
        launch = Launch("servo.launch.py", scene=motions.SCENE, device="topic", enabled="true", params_file=folder / "servo.yaml",
                        pose_topic="/vendor/pose", wrench_topic="/vendor/wrench")
        self.driver = Driver(self.client)
        self.servo = launch.start(self, cwd=folder)["haptic_servo"]
        enter(self, self.driver)

    def live_parameters(self):
        names = self.client.call(ListParameters, "/haptic_servo/list_parameters", ListParameters.Request()).result.names
        described = self.client.call(DescribeParameters, "/haptic_servo/describe_parameters", DescribeParameters.Request(names=names))
        return [Values(d) for d in described.descriptors if not d.read_only]

    def flood(self, parameters):
        """Sets all of them at a steady rate; returns what was asked, with whether it was good, and what was answered."""
        # As deep as the server's: answers that this program is slow to take are not pushed out by newer ones.
        client = self.client.node.create_client(SetParameters, "/haptic_servo/set_parameters", qos_profile=qos_profile_parameters)
        wait_until(client.service_is_ready, "the service that sets parameters")
        chance = random.Random(7)
        asked, begun = [], time.monotonic()
        for n in range(int(SECONDS * RATE)):
            goods = [chance.random() < 0.8 for _ in parameters]
            wanted = [Parameter(name=p.name, value=p.good(chance) if good else p.bad(chance)) for p, good in zip(parameters, goods)]
            asked.append((wanted, goods, client.call_async(SetParameters.Request(parameters=wanted))))
            time.sleep(max(0.0, begun + (n + 1) / RATE - time.monotonic()))
        wait_until(lambda: all(future.done() for _, _, future in asked), "an answer to every request")
        return asked, time.monotonic() - begun

    def test_force_does_not_step_and_no_tick_is_lost(self):
        wait_until(lambda: any(norm(m.wrench.force) > 0.2 for m in list(self.driver.wrenches)), "force at the driver")
        parameters = self.live_parameters()
        self.assertGreater(len(parameters), 12)
        begun = self.client.node.get_clock().now().nanoseconds * 1e-9
        asked, took = self.flood(parameters)
        ended = self.client.node.get_clock().now().nanoseconds * 1e-9
        refused = 0
        for wanted, goods, future in asked:
            results = future.result().results
            self.assertEqual(len(results), len(wanted))
            for parameter, good, result in zip(wanted, goods, results):
                self.assertEqual(result.successful, good, f"{parameter}: {result.reason}")
                if not good:
                    refused += 1
                    self.assertIn(parameter.name, result.reason)
        self.assertEqual(self.servo.end(), 0, self.servo.text)
        self.servo.wait_for_line("lost=0")
        ticks = [t for batch in messages(self.batches, TickBatch) for t in batch.ticks]
        sequences = [t.sequence for t in ticks]
        self.assertEqual(sequences, list(range(len(sequences))), "ticks were lost")
        steepest = self.check_steps(ticks)
        during = [t for t in ticks if begun < seconds(t.stamp) < ended]
        # However many a busy machine made of them.
        self.assertGreater(sum(t.dt for t in during), 0.9 * took)
        touching = sum(t.depth > 0 for t in during) / len(during)
        self.assertGreater(touching, 0.99, "the part was to stay in contact")
        changed = len({(t.gains.stiffness, t.gains.law, t.gains.max_force) for t in during})
        print(f"\n{len(asked)} requests of {len(parameters)} parameters in {took:.1f} s, {refused} values refused, {changed} sets of gains in "
              f"{len(during)} ticks, none lost; in contact {touching:.1%}; steepest force {steepest[0]:.3f}, torque {steepest[1]:.3f} of the limit")

    def check_steps(self, ticks):
        """No force or torque steps by more than its rate allows; a limit that comes down takes the force along at once."""
        steepest = [0.0, 0.0]
        sides = [("force", "max_force", "max_force_rate"), ("torque", "max_torque", "max_torque_rate")]
        greatest, last = [getattr(ticks[0].gains, limit) for _, limit, _ in sides], ticks[0]
        for tick in ticks[1:]:
            cut = tick.health & (TickRecord.HEALTH_STALE | TickRecord.HEALTH_DISCONNECTED | TickRecord.HEALTH_JUMP)
            self.assertFalse(tick.health & (TickRecord.HEALTH_FAULT | TickRecord.HEALTH_INVALID), f"health {tick.health}")
            for i, (side, limit, rate) in enumerate(sides):
                target = getattr(tick.gains, limit)
                greatest[i] += (target - greatest[i]) * tick.dt / (RAMP + tick.dt) if abs(target - greatest[i]) > 1e-6 * target else target - greatest[i]
                greatest[i] = min(greatest[i], target)  # comes up smoothly, down at once
                was, now = getattr(last.out_wrench, side), getattr(tick.out_wrench, side)
                step = math.dist((was.x, was.y, was.z), (now.x, now.y, now.z))
                allowed = getattr(tick.gains, rate) * tick.dt + max(0.0, norm(was) - greatest[i])
                if not cut:
                    self.assertLessEqual(step, allowed * (1 + 1e-9) + 1e-9, f"{side} of tick {tick.sequence}")
                    steepest[i] = max(steepest[i], step / allowed)
            last = tick
        return steepest


if __name__ == "__main__":
    unittest.main()

"""haptic_servo as an rclpy program sees it: discovery, topics, services, parameters."""

import math
import unittest

from client import Client, Ticks, norm, qos, seconds
from cspace_haptics_msgs.msg import ContactState, SceneDescription, ServoConfiguration, TickRecord
from geometry_msgs.msg import PoseStamped, WrenchStamped
from rcl_interfaces.msg import Log, Parameter, ParameterType, ParameterValue
from rcl_interfaces.srv import DescribeParameters, GetParameters, ListParameters, SetParameters
from rclpy.qos import ReliabilityPolicy
from std_srvs.srv import SetBool, Trigger
from support import enter, node, wait_until

NAME = "/haptic_servo"


def parameter(name, value):
    kinds = {float: ("double_value", ParameterType.PARAMETER_DOUBLE), str: ("string_value", ParameterType.PARAMETER_STRING)}
    field, kind = kinds[type(value)]
    return Parameter(name=name, value=ParameterValue(type=kind, **{field: value}))


class ServoNode(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.client = enter(cls, Client())
        # Subscribed before the servo starts, so that nothing of its beginning is missed but by discovery.
        cls.ticks = Ticks(cls.client, f"{NAME}/ticks")
        cls.poses = cls.client.listen(PoseStamped, f"{NAME}/pose", qos())
        cls.proxies = cls.client.listen(PoseStamped, f"{NAME}/proxy_pose", qos())
        # The servo keeps ten events for a reader that does not keep up, and no wrench at all. Ticks fill a socket in a fifth of a
        # second; this one takes none, and holds seconds of the others.
        quiet = enter(cls, Client("quiet_listener"))
        cls.wrenches = quiet.listen(WrenchStamped, f"{NAME}/wrench", qos())
        cls.states = quiet.listen(ContactState, f"{NAME}/contacts", qos(reliable=True))
        cls.servo = enter(cls, node("haptic_servo", scene="peg_in_hole", device__operator__speed=2.0))
        cls.servo.wait_ready()

    def test_1_is_discovered_with_its_topics_and_services(self):
        graph = self.client.node
        wait_until(lambda: ("haptic_servo", "/") in graph.get_node_names_and_namespaces(), "the node in the graph")
        expected = {
            "pose": "geometry_msgs/msg/PoseStamped",
            "proxy_pose": "geometry_msgs/msg/PoseStamped",
            "wrench": "geometry_msgs/msg/WrenchStamped",
            "contacts": "cspace_haptics_msgs/msg/ContactState",
            "ticks": "cspace_haptics_msgs/msg/TickBatch",
            "markers": "visualization_msgs/msg/MarkerArray",
        }
        expected = {f"{NAME}/{topic}": [kind] for topic, kind in expected.items()}
        expected["/diagnostics"] = ["diagnostic_msgs/msg/DiagnosticArray"]
        # Each is discovered for itself, in any order.
        self.come_to_be(expected, lambda: dict(graph.get_publisher_names_and_types_by_node("haptic_servo", "/")))
        services = {f"{NAME}/enable": ["std_srvs/srv/SetBool"], f"{NAME}/reset": ["std_srvs/srv/Trigger"]}
        self.come_to_be(services, lambda: dict(graph.get_service_names_and_types_by_node("haptic_servo", "/")))

    def come_to_be(self, expected, known):
        """Waits until all names of `expected` are known, each with what it says."""
        wait_until(lambda: expected.keys() <= known().keys(), f"{sorted(expected)}, there are {sorted(known())}")
        self.assertEqual({name: known()[name] for name in expected}, expected)

    def test_2_quality_of_service_fits_the_purpose(self):
        def reliability(topic):
            (offer,) = wait_until(lambda: self.client.node.get_publishers_info_by_topic(f"{NAME}/{topic}"), f"an offer of {topic}")
            return offer.qos_profile.reliability

        for topic in ("pose", "proxy_pose", "wrench"):
            self.assertEqual(reliability(topic), ReliabilityPolicy.BEST_EFFORT, topic)
        for topic in ("ticks", "contacts"):
            self.assertEqual(reliability(topic), ReliabilityPolicy.RELIABLE, topic)

    def test_3_force_is_zero_before_enable(self):
        # A whole motion of the operator at twice the speed: contact is certain, force is not shown.
        wait_until(lambda: any(t.contacts for t in self.ticks.all()), "a contact")
        self.client.wait(self.wrenches, 20, "wrenches")
        for message in list(self.wrenches):
            self.assertEqual((norm(message.wrench.force), norm(message.wrench.torque)), (0.0, 0.0))
        for tick in self.ticks.all():
            self.assertFalse(tick.enabled)
            self.assertEqual(norm(tick.out_wrench.force), 0.0)

    def test_4_enable_brings_force_and_takes_it_away(self):
        answer = self.client.call(SetBool, f"{NAME}/enable", SetBool.Request(data=True))
        self.assertTrue(answer.success, answer.message)
        wait_until(lambda: any(norm(m.wrench.force) > 0.2 for m in list(self.wrenches)), "a force on the wrench topic")
        answer = self.client.call(SetBool, f"{NAME}/enable", SetBool.Request(data=False))
        self.assertTrue(answer.success, answer.message)
        # From the first tick that saw the command on, nothing but zero.
        wait_until(lambda: not self.ticks.newest().enabled, "a tick without force wanted")
        newest = self.ticks.newest().sequence
        wait_until(lambda: self.ticks.newest().sequence > newest + 200, "200 more ticks")
        off = [t for t in self.ticks.all() if t.sequence > newest + 10]
        self.assertTrue(all(norm(t.out_wrench.force) == 0.0 for t in off))

    def test_5_every_tick_arrives_in_order_with_its_time(self):
        wait_until(lambda: len(self.ticks.all()) > 3000, "3,000 ticks")
        all_ticks = self.ticks.all()
        numbers = [t.sequence for t in all_ticks]
        self.assertEqual(numbers, list(range(numbers[0], numbers[0] + len(numbers))), "a gap in the sequence numbers")
        self.assertEqual({b.lost for b in self.ticks.batches()}, {0})
        # On a grid of milliseconds; a machine that was busy skips some, and the next tick says for how many it stands.
        for last, tick in zip(all_ticks, all_ticks[1:]):
            periods = round(tick.dt / 1e-3)
            self.assertAlmostEqual(tick.dt, periods * 1e-3, places=9)
            self.assertEqual(periods > 1, bool(tick.health & TickRecord.HEALTH_LATE), f"tick {tick.sequence}")
            if not tick.health & TickRecord.HEALTH_CLOCK_STEP:
                # But for the slow following of the wall clock.
                self.assertAlmostEqual(seconds(tick.stamp) - seconds(last.stamp), tick.dt, delta=0.01 * tick.dt)
        self.assertEqual(min(round(t.dt / 1e-3) for t in all_ticks), 1)
        self.assertTrue(all(t.depth >= 0 for t in all_ticks))

    def test_6_stamps_and_frames(self):
        self.client.wait(self.poses, 5, "poses")
        self.client.wait(self.proxies, 5, "proxy poses")
        now = self.client.node.get_clock().now().nanoseconds * 1e-9
        for heard in (self.poses, self.proxies, self.wrenches, self.states):
            for message in list(heard):
                self.assertEqual(message.header.frame_id, "world")
                self.assertLess(abs(now - seconds(message.header.stamp)), 600.0)
            stamps = [seconds(m.header.stamp) for m in list(heard)]
            self.assertEqual(stamps, sorted(stamps))
        for message in list(self.poses) + list(self.proxies):
            q = message.pose.orientation
            self.assertAlmostEqual(math.sqrt(q.x**2 + q.y**2 + q.z**2 + q.w**2), 1.0, places=9)
        self.assertEqual({b.child_frame_id for b in self.ticks.batches()}, {"hand"})
        self.assertEqual({b.version for b in self.ticks.batches()}, {1})

    def test_7_contact_states_begin_and_end(self):
        wait_until(lambda: any(s.event == ContactState.EVENT_END for s in list(self.states)), "the end of a contact state")
        states = list(self.states)
        indices = [s.index for s in states]
        self.assertEqual(indices, sorted(indices))
        events = {(s.index, s.event) for s in states}
        for index in range(indices[0] + 1, indices[-1]):
            for event in (ContactState.EVENT_BEGIN, ContactState.EVENT_END):
                self.assertIn((index, event), events, f"state {index}")
        for state in states:
            self.assertLessEqual(seconds(state.begin), seconds(state.header.stamp))
            self.assertGreaterEqual(state.max_force, state.mean_force * (1 - 1e-9))
            self.assertGreaterEqual(state.max_depth, 0.0)

    def test_8_a_late_joiner_gets_scene_configuration_and_contact_state_at_once(self):
        with Client("late_joiner") as late:
            latched = qos(reliable=True, latched=True, depth=1)
            scenes = late.listen(SceneDescription, f"{NAME}/scene", latched)
            configurations = late.listen(ServoConfiguration, f"{NAME}/configuration", latched)
            states = late.listen(ContactState, f"{NAME}/contacts", latched)
            lines = late.listen(Log, "/rosout", qos(reliable=True, latched=True))
            late.wait(scenes, what="scenes")
            late.wait(configurations, what="configurations")
            late.wait(states, what="contact states")
            self.assertEqual(scenes[0].name, "peg_in_hole")
            self.assertIn("law", configurations[0].yaml)
            said = wait_until(lambda: [m for m in list(lines) if m.name == "haptic_servo"], "what the servo has said")
            self.assertIn("ready", [m.msg for m in said])

    def test_9_parameters_are_described_set_and_refused_with_the_reason(self):
        call = self.client.call
        listed = call(ListParameters, f"{NAME}/list_parameters", ListParameters.Request()).result.names
        self.assertIn("gains.stiffness", listed)
        described = call(DescribeParameters, f"{NAME}/describe_parameters", DescribeParameters.Request(names=["gains.stiffness"]))
        self.assertEqual(described.descriptors[0].type, ParameterType.PARAMETER_DOUBLE)
        span = described.descriptors[0].floating_point_range[0]
        self.assertLess(span.from_value, span.to_value)
        self.assertTrue(described.descriptors[0].description)

        def set_one(name, value):
            return call(SetParameters, f"{NAME}/set_parameters", SetParameters.Request(parameters=[parameter(name, value)])).results[0]

        def get_one(name):
            return call(GetParameters, f"{NAME}/get_parameters", GetParameters.Request(names=[name])).values[0]

        self.assertTrue(set_one("gains.stiffness", 800.0).successful)
        self.assertEqual(get_one("gains.stiffness").double_value, 800.0)
        wait_until(lambda: self.ticks.newest().gains.stiffness == 800.0, "the gain in a tick")
        for name, value, reason in (
            ("gains.stiffness", -1.0, "range"),
            ("gains.stiffness", 1e9, "range"),
            ("gains.stiffness", float("nan"), "not a number"),
            ("gains.stiffness", "stiff", "double"),
            ("law", "papers", "paper"),
            ("no.such", 1.0, "no parameter"),
            ("frame_id", "elsewhere", "restart"),
        ):
            result = set_one(name, value)
            self.assertFalse(result.successful, f"{name} = {value} was taken")
            self.assertIn(reason, result.reason)
        self.assertEqual(get_one("gains.stiffness").double_value, 800.0, "a refused value changes nothing")

    def test_a_reset_is_answered_and_reaches_a_tick(self):
        before = self.ticks.newest().reset_count
        self.assertTrue(self.client.call(Trigger, f"{NAME}/reset", Trigger.Request()).success)
        wait_until(lambda: self.ticks.newest().reset_count == before + 1, "the reset in a tick")

    def test_b_ends_cleanly_with_force_off(self):
        self.client.call(SetBool, f"{NAME}/enable", SetBool.Request(data=True))
        wait_until(lambda: norm(self.wrenches[-1].wrench.force) > 0.2, "force")
        self.assertEqual(self.servo.end(), 0, self.servo.text)
        self.servo.wait_for_line("ticks=")
        wait_until(lambda: norm(self.wrenches[-1].wrench.force) == 0.0, "the last wrench to be zero")
        wait_until(lambda: self.states[-1].event == ContactState.EVENT_END, "the end of the last contact state")


if __name__ == "__main__":
    unittest.main()

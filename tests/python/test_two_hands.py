"""Two hands at once: the teleoperation launched twice, in the namespaces left and right, each with a force of its own."""

import tempfile
import unittest
from pathlib import Path

import motions
from client import Client, norm, qos
from cspace_haptics_msgs.msg import ContactState, PrincipalContact, SceneDescription, ServoConfiguration
from geometry_msgs.msg import WrenchStamped
from launch_stub import Launch
from support import enter, wait_until

# By namespace: stiffness in N/m, depth in m.
HANDS = {"left": (500.0, 0.001), "right": (2000.0, 0.0015)}


class TwoHands(unittest.TestCase):
    def start(self, folder, name, stiffness, depth):
        poses = motions.write(folder / f"{name}.csv", lambda t: depth, 120, 500)
        device = folder / f"{name}_device.yaml"
        device.write_text(f"/**:\n  ros__parameters:\n    command_timeout: 1.0\n    device:\n      file: {poses}\n")
        servo = folder / f"{name}_servo.yaml"
        servo.write_text(
            "/**:\n  ros__parameters:\n"
            f"    gains: {{stiffness: {stiffness}, damping: 0.0}}\n    passivity: {{enabled: false}}\n    device: {{timeout: 1.0}}\n"
        )
        launch = Launch("teleop.launch.py", namespace=name, enabled="true", scene=motions.SCENE, law="paper", device="replay",
                        params_file=str(servo), device_params_file=str(device))
        return launch.start(self, cwd=folder)

    def test_each_hand_feels_its_own_force(self):
        folder = Path(enter(self, tempfile.TemporaryDirectory()))
        client = enter(self, Client("observer"))
        shown = {name: client.listen(WrenchStamped, f"/{name}/haptic_device/wrench", qos()) for name in HANDS}
        nodes = {name: self.start(folder, name, *HANDS[name]) for name in HANDS}

        def felt(name):
            return [norm(m.wrench.force) for m in shown[name][-100:]]

        for name, (stiffness, depth) in HANDS.items():
            force = stiffness * depth
            wait_until(lambda: len(f := felt(name)) == 100 and all(abs(x - force) < 1e-6 * force for x in f), f"{force} N, {felt(name)[-1:]}")
        # Nothing of the one reaches the other, and who comes late is told at once by both.
        graph = client.node
        for name in HANDS:
            for topic in ("haptic_device/pose", "haptic_device/command/wrench", "haptic_servo/remote_wrench"):
                spaces = lambda: {o.node_namespace for o in graph.get_publishers_info_by_topic(f"/{name}/{topic}")}
                wait_until(lambda: spaces() == {f"/{name}"}, f"{topic} to be spoken on by the {name} hand alone, not by {spaces()}")
        latched = qos(reliable=True, latched=True, depth=1)
        with Client("late_joiner") as late:
            for name in HANDS:
                scenes = late.listen(SceneDescription, f"/{name}/haptic_servo/scene", latched)
                configurations = late.listen(ServoConfiguration, f"/{name}/haptic_servo/configuration", latched)
                states = late.listen(ContactState, f"/{name}/haptic_servo/contacts", latched)
                self.assertEqual(late.wait(scenes)[0].name, "corner")
                self.assertIn(f"stiffness: {HANDS[name][0]}", late.wait(configurations)[0].yaml)
                # The newest counts; a machine that stood still may have ended one state and begun another meanwhile.
                wait_until(lambda: states and states[-1].kind == PrincipalContact.KIND_FACE_FACE, f"face on face, not {states}")
        # One hand lets go: the other does not notice.
        for process in nodes["left"].values():
            self.assertEqual(process.end(), 0, process.text)
        ended = len(shown["right"])
        force = HANDS["right"][0] * HANDS["right"][1]
        wait_until(lambda: len(shown["right"]) > ended + 500 and all(abs(f - force) < 1e-6 * force for f in felt("right")), f"{force} N still")
        wait_until(lambda: norm(shown["left"][-1].wrench.force) == 0.0, "the last word on the left to be zero")


if __name__ == "__main__":
    unittest.main()

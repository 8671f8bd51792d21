"""Bad input to the nodes: exit code 1, one line that names it, nothing half-written."""

import tempfile
import unittest
from pathlib import Path

from support import ROOT, enter, node


class BadInput(unittest.TestCase):
    def setUp(self):
        self.folder = Path(enter(self, tempfile.TemporaryDirectory()))

    def refused(self, name, *parts, files=None, **parameters):
        """The one line with which a node refuses to start."""
        before = sorted(self.folder.rglob("*"))
        with node(name, cwd=self.folder, **parameters) as process:
            code = process.wait()
            lines = [line for line in process.lines if not line.startswith("warning:")]
        self.assertEqual(code, 1, process.text)
        self.assertEqual(len(lines), 1, process.text)
        self.assertTrue(lines[0].startswith("error: "), lines[0])
        for part in parts:
            self.assertIn(part, lines[0])
        self.assertEqual(sorted(self.folder.rglob("*")), before, "something was written")

    def test_unknown_scene(self):
        self.refused("haptic_servo", "no_such_scene", "peg_in_hole", scene="no_such_scene")

    def test_unreadable_mesh(self):
        (self.folder / "a.obj").write_text("v 0 0 nonsense\n")
        scene = self.folder / "scene.yaml"
        scene.write_text("name: bad\nmoving:\n  - mesh: a.obj\nfixed:\n  - mesh: a.obj\n")
        self.refused("haptic_servo", "a.obj", scene=scene)

    def test_missing_mesh(self):
        scene = self.folder / "scene.yaml"
        scene.write_text("name: bad\nmoving:\n  - mesh: gone.obj\nfixed:\n  - mesh: gone.obj\n")
        self.refused("haptic_servo", "gone.obj", scene=scene)

    def test_unknown_key_in_a_scene(self):
        text = (ROOT / "config/scenes/peg_in_hole/scene.yaml").read_text()
        scene = self.folder / "scene.yaml"
        scene.write_text(text + "\ncolour: red\n")
        self.refused("haptic_servo", "colour", scene=scene)

    def test_unknown_parameter(self):
        self.refused("haptic_servo", "gains.stifness", gains__stifness=100.0)

    def test_parameter_out_of_range(self):
        self.refused("haptic_servo", "gains.stiffness", "range", gains__stiffness=-5.0)

    def test_parameter_of_the_wrong_type(self):
        self.refused("haptic_servo", "gains.stiffness", gains__stiffness="soft")

    def test_gain_that_is_not_a_number(self):
        self.refused("haptic_servo", "gains.stiffness", gains__stiffness=".nan")

    def test_unknown_law(self):
        self.refused("haptic_servo", "law", "proxy", law="magic")

    @unittest.skipIf(any(Path("/dev").glob("hidraw*")), "a SpaceMouse may be plugged in")
    def test_a_device_that_is_not_there_is_told(self):
        for name in "haptic_servo", "haptic_device":
            with node(name, device__driver="spacemouse") as process:
                process.wait_for_line("no SpaceMouse is plugged in")

    def test_recorder_without_output(self):
        self.refused("haptic_recorder", "output")

    def test_recorder_does_not_write_into_an_existing_folder(self):
        (self.folder / "bag").mkdir()
        self.refused("haptic_recorder", "bag", output=self.folder / "bag")

    def test_inspect_with_nowhere_to_draw(self):
        self.refused("haptic_inspect", "output")

    def test_inspect_that_cannot_write(self):
        self.refused("haptic_inspect", "missing", output=self.folder / "missing" / "a.rrd")


if __name__ == "__main__":
    unittest.main()

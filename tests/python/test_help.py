"""What the nodes say of themselves: `--help` ends in a parameter file that the node takes, `--version` is one line."""

import subprocess
import tempfile
import unittest
from pathlib import Path

from support import BIN, PATIENCE, enter, node

NODES = ["haptic_servo", "haptic_device", "haptic_recorder", "haptic_player", "haptic_inspect", "haptic_follower"]


def said(name, argument):
    """What a node prints for `argument`, which it answers without starting."""
    return subprocess.run([BIN / name, argument], capture_output=True, text=True, check=True, timeout=PATIENCE).stdout


class Help(unittest.TestCase):
    def test_help_names_every_parameter_with_default_and_meaning(self):
        for name in NODES:
            text = said(name, "--help")
            self.assertTrue(text.startswith(f"{name}: "), text)
            values = text.split("ros__parameters:\n")[1].splitlines()
            self.assertTrue(any(line.strip().startswith("# ") for line in values), text)
            self.assertTrue(any(": " in line and not line.strip().startswith("#") for line in values), text)

    def test_the_help_of_the_servo_is_a_parameter_file(self):
        file = Path(enter(self, tempfile.TemporaryDirectory())) / "from_help.yaml"
        text = said("haptic_servo", "--help")
        file.write_text(text[text.index("\n# Parameters") :])
        with node("haptic_servo", "--ros-args", "--params-file", file) as process:
            process.wait_ready()
            self.assertEqual(process.end(), 0, process.text)

    def test_version_is_one_line(self):
        for name in NODES:
            self.assertRegex(said(name, "--version"), rf"^{name} \d+\.\d+\.\d+\n$")


if __name__ == "__main__":
    unittest.main()

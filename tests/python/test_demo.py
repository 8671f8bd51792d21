"""`cargo xtask demo` as a person runs it: its summary, Ctrl-C, deaths in the family, bad input."""

import os
import re
import signal
import subprocess
import tempfile
import unittest
from pathlib import Path

from support import BIN, ROOT, Process, children, enter, is_alive, wait_until
from test_recording import check_bag, rerun

OUT = ROOT / "out"
NODES = ("haptic_servo", "haptic_recorder", "haptic_inspect")
# The build inside the demo may have to wait for another one.
LONG = 1200.0


def folders():
    return set(OUT.iterdir()) if OUT.is_dir() else set()


class Demo(unittest.TestCase):
    def demo(self, *arguments):
        return enter(self, Process(BIN / "xtask", "demo", *arguments, cwd=ROOT))

    def running_demo(self):
        demo = self.demo("--duration", "600")
        demo.wait_for_line("running for", LONG)
        family = wait_until(lambda: (f := children(demo.process.pid)) and set(NODES) <= set(f) and f, "the demo's processes")
        return demo, {name: family[name] for name in NODES}

    def gone(self, family):
        wait_until(lambda: not any(map(is_alive, family.values())), f"the end of {family}")

    def test_summary_bag_and_recording(self):
        before = folders()
        demo = self.demo("--duration", "10")
        self.assertEqual(demo.wait(LONG), 0, demo.text)
        (folder,) = folders() - before
        summary = (folder / "summary.txt").read_text()

        def number(name):
            found = re.search(rf"^{name}\s+(\d+)", summary, re.M)
            self.assertTrue(found, f"no {name} in\n{summary}")
            return int(found[1])

        # A busy machine skips ticks; none that was run is lost, and together they fill the time.
        self.assertEqual(number("ticks recorded"), number("ticks run"), summary)
        self.assertEqual(number("ticks lost"), 0, summary)
        self.assertGreaterEqual(number("time recorded"), 10, summary)
        kinds = set(re.findall(r"^ +\d+\.\d+ +\d+\.\d+  (\S+)", summary, re.M))
        self.assertIn("free", kinds)
        self.assertTrue(kinds & {"vertex-face", "edge-edge"}, kinds)
        self.assertTrue(kinds & {"edge-face", "face-face"}, kinds)
        verdict = check_bag(folder / "bag", "--ticks-at-least", str(number("ticks run")))
        self.assertEqual(verdict.returncode, 0, verdict.stdout + verdict.stderr)
        verdict = rerun("rrd", "verify", folder / "demo.rrd")
        self.assertEqual(verdict.returncode, 0, verdict.stdout + verdict.stderr)

    def test_control_c_is_a_clean_stop(self):
        before = folders()
        demo, family = self.running_demo()
        self.assertEqual(demo.end(signal.SIGINT, 90), 0, demo.text)
        self.gone(family)
        (folder,) = folders() - before
        self.assertIn("ended early", (folder / "summary.txt").read_text())

    def test_a_process_that_dies_is_named_and_the_others_end(self):
        for victim in NODES:
            with self.subTest(victim):
                before = folders()
                demo, family = self.running_demo()
                os.kill(family[victim], signal.SIGKILL)
                self.assertEqual(demo.wait(90), 1, demo.text)
                self.assertIn(victim, demo.lines[-1])
                self.assertTrue(demo.lines[-1].startswith("error: "), demo.text)
                self.gone(family)
                (folder,) = folders() - before
                summary = subprocess.run([BIN / "cspace-haptics", "bag", "summary", folder / "bag"], capture_output=True, text=True, timeout=600)
                if victim != "haptic_recorder" or "no topic" not in summary.stderr:
                    self.assertEqual(summary.returncode, 0, summary.stderr)

    def test_killed_itself_it_leaves_nobody_behind(self):
        demo, family = self.running_demo()
        demo.end(signal.SIGKILL)
        self.gone(family)

    def refused(self, part, *arguments):
        before = folders()
        demo = self.demo(*arguments)
        self.assertEqual(demo.wait(LONG), 1, demo.text)
        errors = [line for line in demo.lines if line.startswith("error: ")]
        self.assertEqual(len(errors), 1, demo.text)
        self.assertIn(part, errors[0])
        self.assertEqual(folders(), before, "something was left in out/")
        self.assertEqual(children(os.getpid()), {}, "a process was left behind")

    def test_bad_input(self):
        self.refused("no_such_scene", "--scene", "no_such_scene")
        self.refused("../config", "--scene", "../config")
        self.refused("gains.stiffness", "--param", "gains.stiffness:=-1.0")
        self.refused("gains.stiffness", "--param", "gains.stiffness:=.nan")
        self.refused("gains.stifness", "--param", "gains.stifness:=1.0")

    def test_a_domain_in_use(self):
        from client import Client

        with Client("occupant"):
            self.refused("in use", "--domain", os.environ["ROS_DOMAIN_ID"])

    def test_an_unreadable_mesh(self):
        with tempfile.TemporaryDirectory(dir=ROOT / "config/scenes", prefix="forbidden_") as folder:
            (Path(folder) / "a.obj").write_text("v 0 0 nonsense\n")
            (Path(folder) / "scene.yaml").write_text("name: bad\nmoving:\n  - mesh: a.obj\nfixed:\n  - mesh: a.obj\n")
            self.refused("a.obj", "--scene", Path(folder).name)


if __name__ == "__main__":
    unittest.main()

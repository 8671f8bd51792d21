"""haptic_recorder and haptic_inspect beside a servo: independent readers open what they wrote, even after a kill."""

import os
import shutil
import signal
import subprocess
import tempfile
import time
import unittest
from pathlib import Path

from support import BIN, ROOT, TOOLS, Process, enter, node, wait_until

SCENE = ROOT / "config/scenes/peg_in_hole/scene.yaml"
TOPICS = ",".join(f"/haptic_servo/{name}" for name in ("ticks", "pose", "proxy_pose", "wrench", "scene", "configuration"))


def check_bag(bag, *options):
    """The independent readers' verdict."""
    command = [TOOLS / "bin/python", ROOT / "tests/python/check_bag.py", *options, bag]
    return subprocess.run(list(map(str, command)), capture_output=True, text=True, timeout=600, env={"PATH": "/usr/bin:/bin"})


def rerun(*arguments):
    """The viewer's own command line."""
    program = next(TOOLS.glob("lib/python3*/site-packages/rerun_sdk/rerun_cli/rerun"))
    return subprocess.run([str(program), *map(str, arguments)], capture_output=True, text=True, timeout=300)


class Recording(unittest.TestCase):
    def setUp(self):
        self.folder = Path(enter(self, tempfile.TemporaryDirectory()))
        self.bag = self.folder / "bag"

    def start(self, name, **parameters):
        return enter(self, node(name, cwd=self.folder, **parameters)).wait_ready()

    def start_servo(self):
        return self.start("haptic_servo", scene=SCENE, enabled=True, device__operator__speed=2.0)

    def test_independent_readers_read_the_bag(self):
        recorder = self.start("haptic_recorder", output=self.bag)
        servo = self.start_servo()
        for topic in TOPICS.split(","):
            recorder.wait_for_line(f"recording {topic}")
        wait_until(lambda: sum(f.stat().st_size for f in self.bag.glob("*.mcap")) > 400_000, "400 kB in the bag")
        self.assertEqual(servo.end(), 0, servo.text)
        self.assertEqual(recorder.end(), 0, recorder.text)
        self.assertIn("lost=0", recorder.wait_for_line("ticks="))
        verdict = check_bag(self.bag, "--topics", TOPICS, "--ticks-at-least", "500")
        self.assertEqual(verdict.returncode, 0, verdict.stdout + verdict.stderr)

    def test_killed_at_any_moment_the_bag_lacks_at_most_a_second(self):
        cut = []
        for moment in (0.15, 0.7, 1.6, 2.9):
            # Each with a servo of its own: for a while after a kill -9 the middleware still serves the dead reader, whose port
            # the next recorder may have got, and a batch can be lost on it.
            servo = self.start_servo()
            bag = self.folder / f"bag-{moment}"
            recorder = self.start("haptic_recorder", output=bag)
            recorder.wait_for_line("/haptic_servo/ticks")
            # The moment is the test's input, not a wait for something. In small steps, each counted as if it took no longer than
            # it should: a machine that stands still records nothing either.
            steps = round(moment / 0.01)
            for _ in range(steps):
                time.sleep(0.01)
            recorder.end(signal.SIGKILL)
            lived = steps * 0.01
            self.assertEqual(servo.end(), 0, servo.text)
            summary = subprocess.run([BIN / "cspace-haptics", "bag", "summary", bag], capture_output=True, text=True, timeout=600)
            if lived < 1.0 and summary.returncode == 1:
                continue  # all of it may be within the last second
            self.assertEqual(summary.returncode, 0, summary.stderr)
            verdict = check_bag(bag)
            if verdict.returncode != 0:
                cut.append(verdict.stdout + verdict.stderr)
            recorded = next(float(l.split()[2]) for l in summary.stdout.splitlines() if l.startswith("time recorded"))
            self.assertGreater(recorded, lived - 1.0, summary.stdout)
            self.assertIn("ticks lost      0", summary.stdout)
        # Killed within a write, a file lacks its end, or metadata.yaml its newest count, and only our own reader gets past
        # that: a tenth of a millisecond out of 400.
        self.assertLessEqual(len(cut), 1, cut)

    def test_a_full_disk_ends_the_recording_and_leaves_what_was_recorded(self):
        disk = self.folder / "disk"
        disk.mkdir()
        mounted = subprocess.run(["mount", "-t", "tmpfs", "-o", "size=4m", "tmpfs", disk], capture_output=True, text=True)
        if mounted.returncode != 0:
            self.skipTest(f"a disk of 4 MB cannot be mounted: {mounted.stderr.strip()}")
        self.addCleanup(subprocess.run, ["umount", disk], check=True)
        # Ten seconds of ticks come at once to a recorder that is late, in chunks of a megabyte: some of them fit.
        bag = disk / "bag"
        recorder = self.start("haptic_recorder", output=bag, compression="none")
        self.start_servo()
        self.assertEqual(recorder.wait(), 1, recorder.text)
        for part in ("error: ", str(bag), "No space left", "what was recorded so far is complete"):
            self.assertIn(part, recorder.lines[-1])
        verdict = check_bag(bag, "--ticks-at-least", "100")
        self.assertEqual(verdict.returncode, 0, verdict.stdout + verdict.stderr)

    def test_a_folder_that_may_not_be_written_is_named(self):
        closed = self.folder / "closed"
        closed.mkdir(mode=0o555)
        command = [BIN / "haptic_recorder", "--ros-args", "-p", f"output:={closed / 'bag'}"]
        if os.geteuid() == 0:
            # Root may write anywhere, unless it gives that up.
            command = ["setpriv", "--bounding-set=-dac_override", "--inh-caps=-dac_override", *command]
            if shutil.which("setpriv") is None:
                self.skipTest("there is no setpriv to give up root's rights with")
        recorder = enter(self, Process(*command, cwd=self.folder))
        self.assertEqual(recorder.wait(), 1, recorder.text)
        (line,) = recorder.lines
        for part in ("error: ", str(closed / "bag"), "Permission denied", "choose a folder that you may write to"):
            self.assertIn(part, line)
        self.assertEqual(list(closed.iterdir()), [])

    def test_the_recording_for_rerun_is_whole(self):
        file = self.folder / "demo.rrd"
        inspect = self.start("haptic_inspect", output=file, scene=SCENE)
        servo = self.start_servo()
        wait_until(lambda: file.stat().st_size > 500_000, "500 kB in the recording")
        self.assertEqual(servo.end(), 0, servo.text)
        self.assertEqual(inspect.end(), 0, inspect.text)
        verdict = rerun("rrd", "verify", file)
        self.assertEqual(verdict.returncode, 0, verdict.stdout + verdict.stderr)
        printed = rerun("rrd", "print", file)
        self.assertEqual(printed.returncode, 0, printed.stderr)
        for part in ("blueprint", "/physical", "/cspace"):
            self.assertIn(part, printed.stdout)


if __name__ == "__main__":
    unittest.main()

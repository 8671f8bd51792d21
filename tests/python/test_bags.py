"""The offline program and other people's bags: theirs drive ours, ours open with theirs."""

import math
import random
import subprocess
import tempfile
import unittest
from pathlib import Path

from support import BIN, ROOT, TOOLS, enter

PROGRAM = BIN / "cspace-haptics"
SCENE = ROOT / "config/scenes/peg_in_hole/scene.yaml"


def run(*command):
    return subprocess.run(list(map(str, command)), capture_output=True, text=True, timeout=600)


def script(name, *arguments):
    """One of the programs beside this one, run by the Python that has the independent bag libraries."""
    return run(TOOLS / "bin/python", ROOT / "tests/python" / name, *arguments)


class Bags(unittest.TestCase):
    def setUp(self):
        self.folder = Path(enter(self, tempfile.TemporaryDirectory()))
        self.poses = self.folder / "poses.csv"
        with self.poses.open("w") as rows:
            print("t,x,y,z,qx,qy,qz,qw", file=rows)
            for i in range(1500):
                t = i / 1000
                z = 0.03 - 0.02 * min(1, t)
                print(f"{t!r},{0.004 * math.sin(4 * t)!r},0.0,{z!r},0.0,0.0,0.0,1.0", file=rows)

    def succeeds(self, result):
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        return result.stdout

    def replay(self, out, *arguments):
        return run(PROGRAM, "replay", "--out", self.folder / out, *arguments)

    def record(self, name):
        """A bag of ticks rendered from the poses."""
        bag = self.folder / name
        self.succeeds(self.replay("recorded.csv", "--scene", SCENE, "--poses", self.poses, "--bag-out", bag))
        return bag

    def refused(self, result, *parts):
        self.assertEqual(result.returncode, 1, result.stdout + result.stderr)
        self.assertEqual(len(result.stderr.splitlines()), 1, result.stderr)
        for part in ("error: ", *parts):
            self.assertIn(part, result.stderr)

    def test_a_bag_of_poses_by_other_people_gives_the_same_bytes_as_the_csv(self):
        self.succeeds(self.replay("csv.csv", "--scene", SCENE, "--poses", self.poses))
        for version in ("8", "9"):
            bag = self.folder / f"poses{version}"
            self.succeeds(script("write_pose_bag.py", self.poses, bag, "--version", version))
            self.succeeds(self.replay("bag.csv", "--scene", SCENE, "--bag", bag))
            self.assertEqual((self.folder / "bag.csv").read_bytes(), (self.folder / "csv.csv").read_bytes())

    def test_sqlite3_is_refused_with_the_reason(self):
        bag = self.folder / "sqlite"
        self.succeeds(script("write_pose_bag.py", self.poses, bag, "--storage", "sqlite3"))
        self.refused(self.replay("no.csv", "--scene", SCENE, "--bag", bag), "sqlite3", "only MCAP is read")
        self.assertFalse((self.folder / "no.csv").exists())

    def test_a_bag_of_ticks_renders_again_bit_for_bit(self):
        bag = self.record("ticks")
        recorded = (self.folder / "recorded.csv").read_bytes()
        for _ in range(2):
            text = self.succeeds(self.replay("again.csv", "--bag", bag))
            self.assertIn("1500 ticks, all identical to the recorded ones", text)
            self.assertEqual((self.folder / "again.csv").read_bytes(), recorded)
        self.assertIn("differ from the recorded ones", self.succeeds(self.replay("other.csv", "--bag", bag, "--law", "paper")))

    def test_independent_readers_read_a_bag_of_ticks(self):
        bag = self.record("ticks")
        text = self.succeeds(script("check_bag.py", "--messages", ROOT / "msgs/msg", "--ticks-at-least", "1500", bag))
        self.assertIn("1500 ticks", text)

    def test_contact_states_of_a_run_and_of_many(self):
        bag = self.record("ticks")
        out = self.folder / "states.csv"
        self.succeeds(run(PROGRAM, "bag", "segment", bag, "--out", out))
        rows = [line.split(",") for line in out.read_text().splitlines()]
        self.assertEqual(rows[0][:7], "t_begin,t_end,formation,principal_contacts,mean_force_n,max_force_n,work_j".split(","))
        self.assertEqual(rows[1][2:4], ["free", "free"])
        self.assertGreater(len(rows), 2, "no contact state found")
        graph = self.folder / "states.dot"
        self.assertIn("2 runs", self.succeeds(run(PROGRAM, "bag", "graph", bag, bag, "--out", graph)))
        self.assertIn("digraph", graph.read_text())

    def test_a_truncated_and_a_flipped_bag_say_what_is_wrong_and_give_the_rest(self):
        bag = self.record("ticks")
        file = next(bag.glob("*.mcap"))
        good = file.read_bytes()
        chance = random.Random(3)
        for _ in range(20):
            bad = bytearray(good[: chance.randrange(len(good))] if chance.random() < 0.5 else good)
            if bad:
                bad[chance.randrange(len(bad))] ^= 1 << chance.randrange(8)
            file.write_bytes(bad)
            for command in (("bag", "info", bag), ("bag", "segment", bag, "--out", self.folder / "s.csv")):
                result = run(PROGRAM, *command)
                self.assertIn(result.returncode, (0, 1), result.stderr)
                self.assertNotIn("panicked", result.stderr)


if __name__ == "__main__":
    unittest.main()

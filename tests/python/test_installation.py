"""An ordinary colcon workspace: both packages build and install into an empty prefix, and what was installed runs from
there as the launch files say, with nothing of the sources at hand."""

import os
import subprocess
import sys
import tempfile
import unittest
import xml.etree.ElementTree as ElementTree
from pathlib import Path

from client import Client, norm, qos
from cspace_haptics_msgs.msg import SceneDescription, TickBatch
from launch_stub import Launch
from support import BIN, ROOT, enter, wait_until
from std_srvs.srv import SetBool

PACKAGES = ("cspace_haptics", "cspace_haptics_msgs")
# What `cargo xtask test` brought: modules of colcon-ros-cargo, and the folder of cargo-ament-build.
COLCON = os.environ["CSPACE_HAPTICS_COLCON"]
CARGO_AMENT = os.environ["CSPACE_HAPTICS_CARGO_AMENT"]
# A build may have to wait for another one.
LONG = 1200


def without_our_messages(variable):
    """A list of folders without the messages that `cargo xtask env` built: the installed ones are to serve."""
    return ":".join(f for f in os.environ.get(variable, "").split(":") if "/msgs-" not in f)


class Installation(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.workspace = Path(enter(cls, tempfile.TemporaryDirectory()))
        (cls.workspace / "src").mkdir()
        # Linked, so that cargo finds our sources where it built them before.
        (cls.workspace / "src/cspace_haptics").symlink_to(ROOT)
        cls.colcon("build", "--packages-select", "cspace_haptics_msgs",
                   "--cmake-args", "-DBUILD_TESTING=OFF", f"-DPython3_EXECUTABLE={sys.executable}")
        # The target folder of all tests: dependencies of half a thousand crates are not built twice. The nodes' workspace
        # is searched alone, for colcon would put the fresh messages before the ones that the bindings in there were made
        # from, and all would be made anew.
        (cls.workspace / "build/cspace_haptics").symlink_to(BIN.parent)
        cls.colcon("build", "--base-paths", "src/cspace_haptics/nodes/ros")
        cls.install = cls.workspace / "install"
        cls.prefix = cls.install / "cspace_haptics"
        cls.share = cls.prefix / "share/cspace_haptics"
        cls.bin = cls.prefix / "lib/cspace_haptics"

    @classmethod
    def colcon(cls, *arguments):
        environment = {
            **os.environ,
            "PYTHONPATH": f"{COLCON}:{os.environ['PYTHONPATH']}",
            "PATH": f"{CARGO_AMENT}:{os.environ['PATH']}",
            "COLCON_HOME": str(cls.workspace / "colcon"),
        }
        command = ["colcon", "--log-base", "log", *arguments]
        result = subprocess.run(command, cwd=cls.workspace, env=environment, capture_output=True, text=True, timeout=LONG)
        if result.returncode != 0:
            raise AssertionError(f"{' '.join(command)}:\n{result.stdout}\n{result.stderr}")
        return result.stdout

    def environment(self):
        """What `. install/local_setup.sh` makes of an environment that knows ROS but not us."""
        before = {**os.environ}
        for variable in ("AMENT_PREFIX_PATH", "CMAKE_PREFIX_PATH", "LD_LIBRARY_PATH", "PYTHONPATH"):
            before[variable] = without_our_messages(variable)
        script = f". {self.install}/local_setup.sh && env -0"
        said = subprocess.run(["sh", "-c", script], env=before, capture_output=True, check=True, timeout=600).stdout.decode()
        return dict(line.split("=", 1) for line in said.split("\0") if line)

    def test_1_colcon_finds_the_two_packages_and_no_others(self):
        found = {tuple(line.split("\t")[::2]) for line in self.colcon("list").splitlines()}
        self.assertEqual(found, {("cspace_haptics", "(ament_cargo)"), ("cspace_haptics_msgs", "(ros.ament_cmake)")})

    def test_2_the_manifests_are_complete(self):
        for file in (ROOT / "nodes/ros/package.xml", ROOT / "msgs/package.xml"):
            package = ElementTree.parse(file).getroot()
            for tag in ("name", "version", "description", "maintainer", "license"):
                self.assertTrue(package.findtext(tag), f"{file}: {tag}")
            self.assertRegex(package.find("maintainer").get("email"), r"^[\w.+-]+@[\w-]+(\.[\w-]+)+$")
            # colcon takes a package for one of another kind when a dependency stands in two ways.
            for tag in ("exec_depend", "build_depend"):
                both = {d.text for d in package.findall("depend")} & {d.text for d in package.findall(tag)}
                self.assertEqual(both, set(), file)

    def test_3_everything_is_where_ros_looks_for_it(self):
        nodes = {f.stem for f in (ROOT / "nodes/ros/src/bin").glob("*.rs")}
        self.assertEqual({f.name for f in self.bin.iterdir()}, nodes)
        for folder in ("launch", "config"):
            ours = {f.relative_to(ROOT / folder): f.read_bytes() for f in (ROOT / folder).rglob("*") if f.is_file()}
            installed = self.share / folder
            self.assertEqual({f.relative_to(installed): f.read_bytes() for f in installed.rglob("*") if f.is_file()}, ours)
        self.assertIn(Path("udev/60-cspace-haptics.rules"), {f.relative_to(self.share / "config") for f in self.share.rglob("*.rules")})
        for package in PACKAGES:
            share = self.install / package / "share"
            self.assertTrue((share / "ament_index/resource_index/packages" / package).is_file())
            self.assertTrue((share / package / "package.xml").is_file())
        # In this index colcon looks for crates to build other packages on.
        self.assertFalse((self.prefix / "share/ament_index/resource_index/rust_packages").exists())

    def test_4_the_prefix_stands_by_itself(self):
        environment = self.environment()
        for package in PACKAGES:
            self.assertIn(str(self.install / package), environment["AMENT_PREFIX_PATH"].split(":"))
        libraries = subprocess.run(["ldd", self.bin / "haptic_servo"], env=environment, capture_output=True, text=True, timeout=600).stdout
        ours = [line for line in libraries.splitlines() if "libcspace_haptics_msgs" in line]
        self.assertTrue(ours)
        for line in ours:
            self.assertIn(str(self.install / "cspace_haptics_msgs/lib"), line)
        self.assertNotIn("not found", libraries)
        script = "import cspace_haptics_msgs.msg as m; print(m.__file__); print(m.TickBatch())"
        said = subprocess.run(["python3", "-c", script], env=environment, capture_output=True, text=True, timeout=600)
        self.assertEqual(said.returncode, 0, said.stderr)
        self.assertIn(str(self.install), said.stdout)

    def test_5_the_installed_servo_recorder_and_pictures_run_as_launched(self):
        environment = self.environment()
        elsewhere = Path(enter(self, tempfile.TemporaryDirectory()))

        def launch(file, **arguments):
            return Launch(file, self.share, **arguments).start(self, self.bin, env=environment, cwd=elsewhere)

        client = enter(self, Client("operator"))
        batches = client.listen(TickBatch, "/haptic_servo/ticks", qos(reliable=True))
        recorder = launch("record.launch.py", output=str(elsewhere / "bag"))["haptic_recorder"]
        inspect = launch("inspect.launch.py", output=str(elsewhere / "run.rrd"))["haptic_inspect"]
        servo = launch("servo.launch.py", scene="corner", law="blended")["haptic_servo"]
        scenes = client.listen(SceneDescription, "/haptic_servo/scene", qos(reliable=True, latched=True, depth=1))
        self.assertEqual(client.wait(scenes)[0].name, "corner")
        self.assertTrue(client.call(SetBool, "/haptic_servo/enable", SetBool.Request(data=True)).success)
        wait_until(lambda: any(norm(t.out_wrench.force) > 0.2 for b in list(batches) for t in b.ticks), "force on the hand")
        wait_until(lambda: (elsewhere / "run.rrd").stat().st_size > 10_000, "something in the recording")
        for process in (servo, recorder, inspect):
            self.assertEqual(process.end(), 0, process.text)
        self.assertIn("lost=0", recorder.wait_for_line("ticks="))

    def test_6_the_installed_teleoperation_runs_as_launched(self):
        environment = self.environment()
        client = enter(self, Client("observer"))
        batches = client.listen(TickBatch, "/left/haptic_servo/ticks", qos(reliable=True))
        nodes = Launch("teleop.launch.py", self.share, namespace="left", enabled="true").start(self, self.bin, env=environment)
        self.assertEqual(set(nodes), {"haptic_device", "haptic_servo", "haptic_follower"})
        wait_until(lambda: any(norm(t.out_wrench.force) > 0.2 for b in list(batches) for t in b.ticks), "force on the hand")
        for process in nodes.values():
            self.assertEqual(process.end(), 0, process.text)


if __name__ == "__main__":
    unittest.main()

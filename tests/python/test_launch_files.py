"""The launch files, with recorders in place of launch and launch_ros, which PyPI does not have: they load, name
executables and files that exist, describe every argument, and the XML twin says the same as its Python one."""

import importlib.util
import sys
import types
import unittest
import xml.etree.ElementTree as ElementTree

from support import ROOT

LAUNCH = ROOT / "launch"


class Recorded:
    """Stands for any class of launch: keeps what it was made with."""

    def __init__(self, *arguments, **options):
        self.arguments = arguments
        self.options = options


def module(name, *classes):
    made = types.ModuleType(name)
    for each in classes:
        setattr(made, each, type(each, (Recorded,), {}))
    return made


STUBS = [
    module("launch", "LaunchDescription"),
    module("launch.actions", "DeclareLaunchArgument"),
    module("launch.conditions", "IfCondition"),
    module("launch.substitutions", "LaunchConfiguration", "PathJoinSubstitution", "PythonExpression"),
    module("launch_ros"),
    module("launch_ros.actions", "Node"),
    module("launch_ros.parameter_descriptions", "ParameterValue"),
    module("launch_ros.substitutions", "FindPackageShare"),
]


def load(path):
    """The actions of a launch file."""
    spec = importlib.util.spec_from_file_location(path.name.replace(".", "_"), path)
    loaded = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(loaded)
    return loaded.generate_launch_description().arguments[0]


def kind(action, name):
    return type(action).__name__ == name


class LaunchFiles(unittest.TestCase):
    def setUp(self):
        before = {stub.__name__: sys.modules.get(stub.__name__) for stub in STUBS}
        sys.modules.update({stub.__name__: stub for stub in STUBS})

        def restore():
            for name, value in before.items():
                if value is None:
                    del sys.modules[name]
                else:
                    sys.modules[name] = value

        self.addCleanup(restore)

    def test_arguments_are_described_and_used_ones_declared(self):
        files = sorted(LAUNCH.glob("*.launch.py"))
        self.assertEqual([f.name for f in files], ["inspect.launch.py", "record.launch.py", "servo.launch.py", "teleop.launch.py"])
        for file in files:
            declared = {a.arguments[0]: a.options for a in load(file) if kind(a, "DeclareLaunchArgument")}
            for name, options in declared.items():
                self.assertTrue(options.get("description"), f"{file.name}: {name}")
                if "choices" in options and "default_value" in options:
                    self.assertIn(options["default_value"], options["choices"], f"{file.name}: {name}")
            text = file.read_text()
            used = {part.split('"')[1] for part in text.split("LaunchConfiguration(")[1:] if part.startswith('"')}
            self.assertEqual(used, set(declared), file.name)

    def test_nodes_are_executables_of_the_package(self):
        executables = {f.stem for f in (ROOT / "nodes/ros/src/bin").glob("*.rs")}
        for file in LAUNCH.glob("*.launch.py"):
            nodes = [a for a in load(file) if kind(a, "Node")]
            self.assertTrue(nodes, file.name)
            for node in nodes:
                self.assertEqual(node.options["package"], "cspace_haptics")
                self.assertIn(node.options["executable"], executables)
                self.assertEqual(node.options["name"], node.options["executable"])

    def test_the_xml_twin_says_the_same(self):
        actions = load(LAUNCH / "servo.launch.py")
        python = {
            a.arguments[0]: (a.options.get("default_value"), a.options.get("choices", []), a.options["description"])
            for a in actions
            if kind(a, "DeclareLaunchArgument")
        }
        root = ElementTree.parse(LAUNCH / "servo.launch.xml").getroot()
        twin = {
            a.get("name"): (a.get("default"), [c.get("value") for c in a.findall("choice")], a.get("description"))
            for a in root.findall("arg")
        }
        self.assertEqual(set(twin), set(python))
        for name in set(twin) - {"params_file"}:
            self.assertEqual(twin[name], python[name], name)
        (node,) = [a for a in actions if kind(a, "Node")]
        values = node.options["parameters"][1]
        self.assertEqual({p.get("name") for p in root.find("node").findall("param") if p.get("name")}, set(values))

    def test_the_parameter_file_exists_and_is_installed(self):
        self.assertTrue((ROOT / "config/haptic_servo.param.yaml").is_file())
        manifest = (ROOT / "nodes/ros/Cargo.toml").read_text()
        self.assertIn('install_to_share = ["launch", "config"]', manifest)
        for folder in ("launch", "config"):
            self.assertTrue((ROOT / "nodes/ros" / folder).is_dir())
        package = ElementTree.parse(ROOT / "nodes/ros/package.xml").getroot()
        self.assertEqual(package.find("export/build_type").text, "ament_cargo")


if __name__ == "__main__":
    unittest.main()

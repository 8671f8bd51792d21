"""The launch files: they load, name executables and files that exist, describe every argument, and the XML twin says the
same as its Python one. What they start is started in test_installation.py and test_two_hands.py."""

import unittest
import xml.etree.ElementTree as ElementTree

from launch_stub import LAUNCH, Launch, arguments_of, load
from support import ROOT

# Arguments that have no default.
NEEDED = {"record.launch.py": {"output": "bag"}}


class LaunchFiles(unittest.TestCase):
    def test_arguments_are_described_and_used_ones_declared(self):
        files = sorted(LAUNCH.glob("*.launch.py"))
        self.assertEqual([f.name for f in files], ["inspect.launch.py", "record.launch.py", "servo.launch.py", "teleop.launch.py"])
        for file in files:
            declared = arguments_of(load(file))
            for name, options in declared.items():
                self.assertTrue(options.get("description"), f"{file.name}: {name}")
                if "choices" in options and "default_value" in options:
                    self.assertIn(options["default_value"], options["choices"], f"{file.name}: {name}")
            text = file.read_text()
            used = {part.split('"')[1] for part in text.split("LaunchConfiguration(")[1:] if part.startswith('"')}
            self.assertEqual(used, set(declared), file.name)

    def test_nodes_are_executables_of_the_package_with_files_that_exist(self):
        executables = {f.stem for f in (ROOT / "nodes/ros/src/bin").glob("*.rs")}
        for file in LAUNCH.glob("*.launch.py"):
            commands = list(Launch(file.name, **NEEDED.get(file.name, {})).commands())
            self.assertTrue(commands, file.name)
            for executable, words in commands:
                self.assertIn(executable, executables)
                self.assertIn(f"__node:={executable}", words)
                for flag, value in zip(words, words[1:]):
                    if flag == "--params-file":
                        self.assertTrue((ROOT / value).is_file(), value)

    def test_two_computers_start_what_one_would(self):
        def names(**arguments):
            return [name for name, _ in Launch("teleop.launch.py", **arguments).commands()]

        self.assertEqual(names(side="device") + names(side="robot"), names())

    def test_the_xml_twin_says_the_same(self):
        actions = load(LAUNCH / "servo.launch.py")
        python = {
            name: (options.get("default_value"), options.get("choices", []), options["description"])
            for name, options in arguments_of(actions).items()
        }
        root = ElementTree.parse(LAUNCH / "servo.launch.xml").getroot()
        twin = {
            a.get("name"): (a.get("default"), [c.get("value") for c in a.findall("choice")], a.get("description"))
            for a in root.findall("arg")
        }
        self.assertEqual(list(twin), list(python))
        self.assertEqual(twin["params_file"][0], "$(find-pkg-share cspace_haptics)/config/haptic_servo.param.yaml")
        for name in set(twin) - {"params_file"}:
            self.assertEqual(twin[name], python[name], name)
        (node,) = [a for a in actions if a.kind == "Node"]
        twin = root.find("node")
        for attribute, option in (("exec", "executable"), ("pkg", "package"), ("name", "name"), ("output", "output")):
            self.assertEqual(twin.get(attribute), node.options[option])
        values = {name: value.arguments[0].arguments[0] for name, value in node.options["parameters"][1].items()}
        self.assertEqual({p.get("name"): p.get("value") for p in twin.findall("param") if p.get("name")},
                         {name: f"$(var {argument})" for name, argument in values.items()})
        self.assertEqual({r.get("from"): r.get("to") for r in twin.findall("remap")},
                         {old: f"$(var {new.arguments[0]})" for old, new in node.options["remappings"]})


if __name__ == "__main__":
    unittest.main()

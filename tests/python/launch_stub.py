"""Stands for launch and launch_ros, which PyPI does not have: loads the launch files and says what they would start."""

import importlib.util
import sys
import types

from support import BIN, ROOT, Process, enter

LAUNCH = ROOT / "launch"


class Recorded:
    """Stands for any class of launch: keeps what it was made with."""

    def __init__(self, *arguments, **options):
        self.arguments = arguments
        self.options = options

    @property
    def kind(self):
        return type(self).__name__


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
    before = {stub.__name__: sys.modules.get(stub.__name__) for stub in STUBS}
    sys.modules.update({stub.__name__: stub for stub in STUBS})
    try:
        spec = importlib.util.spec_from_file_location(path.name.replace(".", "_"), path)
        loaded = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(loaded)
        return loaded.generate_launch_description().arguments[0]
    finally:
        for name, value in before.items():
            if value is None:
                del sys.modules[name]
            else:
                sys.modules[name] = value


def arguments_of(actions):
    """The declared arguments, by name."""
    return {a.arguments[0]: a.options for a in actions if a.kind == "DeclareLaunchArgument"}


class Launch:
    """A launch file with its arguments given, as `ros2 launch cspace_haptics FILE NAME:=VALUE...` takes them."""

    def __init__(self, file, share=ROOT, **given):
        self.share = share
        self.actions = load(share / "launch" / file)
        declared = arguments_of(self.actions)
        self.values = {}
        for name in given:
            assert name in declared, f"{file} has no argument {name}"
        for name, options in declared.items():
            value = given.get(name, options.get("default_value"))
            assert value is not None, f"{file} needs the argument {name}"
            self.values[name] = self.text(value)
            assert self.values[name] in options.get("choices", [self.values[name]]), f"{file}: {name}:={value}"

    def text(self, what):
        """What a substitution stands for."""
        if isinstance(what, (list, tuple)):
            return "".join(map(self.text, what))
        if not isinstance(what, Recorded):
            return str(what)
        if what.kind == "LaunchConfiguration":
            return self.values[what.arguments[0]]
        if what.kind == "FindPackageShare":
            assert what.arguments == ("cspace_haptics",)
            return str(self.share)
        if what.kind == "PathJoinSubstitution":
            return "/".join(map(self.text, what.arguments[0]))
        if what.kind == "PythonExpression":
            return str(eval(self.text(what.arguments[0]), {}))
        assert what.kind == "ParameterValue", what.kind
        value = self.text(what.arguments[0])
        kind = what.options["value_type"]
        return f"'{value}'" if kind is str else str(kind(value) if kind is not bool else value)

    def commands(self):
        """Executable and arguments of every node, as launch_ros writes them."""
        for node in (a for a in self.actions if a.kind == "Node"):
            options = node.options
            if "condition" in options and self.text(options["condition"].arguments[0]) != "True":
                continue
            words = ["--ros-args", "-r", f"__node:={self.text(options['name'])}"]
            namespace = self.text(options.get("namespace", ""))
            if namespace:
                words += ["-r", f"__ns:=/{namespace}"]
            for source in options.get("parameters", []):
                if isinstance(source, dict):
                    for name, value in source.items():
                        words += ["-p", f"{name}:={self.text(value)}"]
                else:
                    words += ["--params-file", self.text(source)]
            for old, new in options.get("remappings", []):
                words += ["-r", f"{self.text(old)}:={self.text(new)}"]
            assert options["package"] == "cspace_haptics"
            yield options["executable"], words

    def start(self, test, bin=BIN, **options):
        """Starts the nodes; they end with the test. By the executables' names, all ready."""
        running = {name: enter(test, Process(bin / name, *words, **options)) for name, words in self.commands()}
        for process in running.values():
            process.wait_ready()
        return running

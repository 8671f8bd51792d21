"""Processes under test and the places of things. Every wait has an end, and nothing is left running."""

import os
import queue
import signal
import subprocess
import threading
import time
from pathlib import Path

ROOT = Path(os.environ["CSPACE_HAPTICS_ROOT"])
BIN = Path(os.environ["CSPACE_HAPTICS_BIN"])
TOOLS = Path(os.environ["CSPACE_HAPTICS_TOOLS"])
# Generous: build machines stall. No test passes or fails by how long something took below this.
PATIENCE = 30.0


def wait_until(condition, what, patience=PATIENCE):
    """Waits until `condition()` is true and returns what it returned."""
    end = time.monotonic() + patience
    while True:
        result = condition()
        if result:
            return result
        if time.monotonic() > end:
            raise AssertionError(f"waited {patience:.0f} s in vain: {what}")
        time.sleep(0.02)


def enter(test, context):
    """Enters a context that is left when the test, or the class of tests, is over."""
    value = context.__enter__()
    cleanup = test.addClassCleanup if isinstance(test, type) else test.addCleanup
    cleanup(context.__exit__, None, None, None)
    return value


class Process:
    """A program with its output read all the time; a context that ends with the program."""

    def __init__(self, program, *arguments, env=None, cwd=None):
        self.name = Path(program).name
        self.lines = []
        self.process = subprocess.Popen(
            [str(program), *map(str, arguments)],
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            errors="replace",
            env={**os.environ, **(env or {})},
            cwd=cwd,
        )
        self._news = queue.Queue()
        self._reader = threading.Thread(target=self._read, daemon=True)
        self._reader.start()

    def _read(self):
        for line in self.process.stdout:
            self.lines.append(line.rstrip("\n"))
            self._news.put(line)
        self._news.put(None)

    @property
    def text(self):
        return "\n".join(self.lines)

    def wait_for_line(self, part, patience=PATIENCE):
        """Waits for a line that contains `part`; an early end is told with all that was said."""

        def look():
            for line in list(self.lines):
                if part in line:
                    return line
            if self.process.poll() is not None and not self._reader.is_alive():
                raise AssertionError(f"{self.name} ended ({self.process.returncode}) before it said {part!r}:\n{self.text}")
            return None

        return wait_until(look, f"{self.name} to say {part!r}; it said:\n{self.text}", patience)

    def wait_ready(self):
        self.wait_for_line("ready:")
        return self

    def end(self, by=signal.SIGINT, patience=PATIENCE):
        """Signals it and returns its exit code."""
        if self.process.poll() is None:
            self.process.send_signal(by)
        return self.wait(patience)

    def wait(self, patience=PATIENCE):
        code = self.process.wait(timeout=patience)
        self._reader.join(timeout=5)
        return code

    def __enter__(self):
        return self

    def __exit__(self, *_):
        if self.process.poll() is None:
            self.process.kill()
            self.process.wait(timeout=PATIENCE)
        self._reader.join(timeout=5)
        self.process.stdout.close()


def node(name, *arguments, env=None, cwd=None, remap=(), **parameters):
    """Starts one of our nodes; `parameters` with `__` for the dots between levels."""
    ros = ["--ros-args"]
    for key, value in parameters.items():
        if isinstance(value, bool):
            value = str(value).lower()
        ros += ["-p", f"{key.replace('__', '.')}:={value}"]
    for rule in remap:
        ros += ["-r", rule]
    return Process(BIN / name, *arguments, *(ros if len(ros) > 1 else []), env=env, cwd=cwd)


def is_alive(pid):
    """Whether a process runs; one that ended and was not waited for does not."""
    try:
        state = Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()[0]
    except (FileNotFoundError, ProcessLookupError):
        return False
    return state not in "ZX"


def children(pid):
    """The processes that `pid` started, by the name of their program."""
    found = {}
    for stat in Path("/proc").glob("[0-9]*/stat"):
        try:
            parent = int(stat.read_text().rsplit(")", 1)[1].split()[1])
            if parent == pid:
                words = (stat.parent / "cmdline").read_bytes().split(b"\0")
                found[Path(words[0].decode(errors="replace")).name] = int(stat.parent.name)
        except (OSError, ValueError, IndexError):
            continue  # it has ended meanwhile
    return found

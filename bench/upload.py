"""How long an upload takes over a line of 115,200 baud: from the call of `rsc upload robot.rsl`, including its start
and the compilation, to the first step of the new program.

The emulator does not pace the line, so a tap in between does (tap.py). The board reports by its own clock, which
follows the host's, when the program began. Everything runs in real time: on a busy machine it takes longer.
"""

import os
import random
import statistics
import sys
import tempfile
import time
from pathlib import Path

import rsc
from board import Board
from counting import ROOT
from tap import Tap
from workloads import PAPER

sys.path.append(str(ROOT / "tests/e2e"))
import wire  # noqa: E402

RUNS = 5
LARGE = 16 * 1024  # bytes of the image, at least
ROBOT = """{"sensors": [{"name": "near", "type": "VIRTUAL", "channels": {"X": {"range": [0, 10000]}}}],
 "actuators": [{"name": "arm", "type": "PWM", "pin": 3, "device": "servo", "range": ["0deg", "180deg"]}]}"""


class Line:
    """A board behind a paced line, and an rsc that has never seen it. After `forget()` it does not know the board's
    program either."""

    def __init__(self, folder):
        self._cache = Path(folder) / "cache"
        os.environ["XDG_CACHE_HOME"] = str(self._cache)
        self._board = Board()
        self.tap = Tap(folder, self._board.port)

    def forget(self):
        for file in self._cache.rglob("*.rsb"):
            file.unlink()

    def upload(self, program):
        """Returns the milliseconds until the program's first step."""
        begun = time.monotonic()
        rsc.run("upload", program, "--port", self.tap.port, "--anyway")
        time.sleep(0.05)  # until the tap releases the board's socket
        with wire.Line(self._board.port) as line:
            asked = time.monotonic()
            program_us = line.status().program_us
            return 1000 * ((asked + time.monotonic()) / 2 - begun) - program_us / 1000

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.tap.close()
        self._board.stop()
        del os.environ["XDG_CACHE_HOME"]


def large_program(folder):
    """Rules with random numbers."""
    drawn = random.Random(16)
    path = Path(folder) / "large.rsl"
    path.with_suffix(".json").write_text(ROBOT)
    rules, size, behaviors = [], 0, 0
    while size < LARGE:
        behaviors += 1
        rules.append(f"BEHAVIOR number_{behaviors} PRIORITY {behaviors}\n")
        for _ in range(20):
            low, degrees, speed = drawn.randrange(1, 9_999_999), drawn.randrange(1, 179_999), drawn.randrange(1, 59_999)
            rules.append(f"WHEN near X > {low / 1000} DO MOVE arm TO {degrees / 1000}deg AT {speed / 1000}deg/s END\n")
        rules.append("END\n")
        path.write_text("".join(rules))
        image = path.with_suffix(".rsb")
        rsc.run("compile", path, "--strip", "-o", image, "--anyway")
        size = image.stat().st_size
    return path, size


def upload_figures():
    with tempfile.TemporaryDirectory() as folder, Line(folder) as line:
        robot = Path(folder) / "robot.rsl"
        robot.with_suffix(".json").write_text(PAPER.with_suffix(".json").read_text())
        paper, threshold = [], []
        for run in range(RUNS):
            line.forget()
            robot.write_text(PAPER.read_text())
            paper.append(line.upload(robot))
            robot.write_text(PAPER.read_text().replace("LEVEL < 3", f"LEVEL < {4 + run % 2}"))
            threshold.append(line.upload(robot))
        large, size = large_program(folder)
        line.forget()
        large_ms = line.upload(large)
        wire_ms = 1000 * line.tap.wire_seconds(size)
    return {
        "link/upload_paper_ms": (round(statistics.median(paper), 1), "ms"),
        "link/upload_threshold_ms": (round(statistics.median(threshold), 1), "ms"),
        "link/upload_over_wire_time_16k": (round(large_ms / wire_ms, 2), "x"),
    }

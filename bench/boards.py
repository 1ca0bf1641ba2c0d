"""What the shipped firmware needs on each board except the reference board, on which everything else is measured:
NAME/….

flash, ram_fixed          as firmware/flash and firmware/ram_fixed
power_up_to_first_step    from reset until the first step of the paper's program, which the board has kept: the
                          instructions until the kernel's clock starts, at the time that QEMU takes for each, plus what
                          that clock then shows, which advances in milliseconds
reading_to_command…       the three conditions of path.py, with one power-up
idle_second               as firmware/idle_second

Everything is counted in QEMU and independent of this machine's clock (played.py), so every run gives the same figures.
Each board is measured by its own process, because ROBOSYNC_BOARD selects the board.
"""

import functools
import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path

import figures
import idle
import memory
import path
import rsc
from board import NAME, REFERENCE, ROOT
from counting import BenchError, Marks, functions, plugin_arguments
from played import INSTRUCTION_NS, TouchedBoard, hello, store_with
from workloads import PAPER

sys.path.append(str(ROOT / "tests/e2e"))
import wire  # noqa: E402
from support import wired_as_it_can  # noqa: E402

STEP = "robosync::layers::ProcessingLayer::next_due("  # called at the end of the first step, and of others
CLOCK_BEGINS = "robosync::port::start_tick("
# The figures of the reference board whose bars apply to figures without their own.
BARS = {"power_up_to_first_step": "firmware/power_up_to_program", "idle_second": "firmware/idle_second",
        **{name: f"path/{name}" for name in ("reading_to_command", "reading_to_command_busy", "reading_to_command_monitored")}}


@functools.cache
def others():
    return sorted(file.stem for file in (ROOT / "stdlib/boards").glob("*.json") if file.stem != REFERENCE)


def whose_bar(name):
    board, _, what = name.partition("/")
    return BARS.get(what, name) if board in others() else name


def paper_for_this_board(folder):
    """Compiles the paper's program for pins that the board has; returns the image."""
    robot = json.loads(PAPER.with_name("robot.json").read_text())
    wired_as_it_can(robot["actuators"])
    config, image = folder / "robot.json", folder / "paper.rsb"
    config.write_text(json.dumps({**robot, "board": NAME}))
    rsc.run("compile", PAPER, "--config", config, "-o", image)
    return image


def begin_of_monitor():
    """What `rsc monitor` sends to a board first."""
    return b"\0" + wire.frame("hello", hello(), 1) + wire.frame("trace_on", wire.pack("TraceOn", on=1), 2)


def touch_again_and_again(board):
    def pause():
        for _ in range(path.BETWEEN):
            board.give()

    path.touch_again_and_again(board, pause, path.AWAKE + path.CHANGES)


def drive(board):
    """Runs from power-up to the end of what path.py does with the reference board. Returns the time of the first step
    on the kernel's clock."""
    board.run_to(functions(STEP)[STEP])
    first_step = board.uptime_us()
    board.set_touch(path.LIGHT)
    for _ in range(path.BETWEEN):
        board.give()
    touch_again_and_again(board)
    for byte in begin_of_monitor():
        board.say(bytes([byte]))
        board.give()
    before = len(board.messages("event"))
    touch_again_and_again(board)
    if len(board.messages("event")) < before + path.CHANGES:
        raise BenchError("the board tells nothing to who monitors it")
    return first_step


def time_of_first_step(marks, by_the_clock):
    [before] = [count for name, count in marks.all if name == CLOCK_BEGINS]
    return round(before * INSTRUCTION_NS / 1000) + by_the_clock


def conditions(marks):
    """The worst case for each of path.py's three conditions."""
    found = path.ways(marks)
    if len(found) != 1 + 2 * (path.AWAKE + path.CHANGES):
        raise BenchError(f"not every touch led to a command: {found}")
    (free, moved_before), busy, monitored = found[0], found[1 + path.AWAKE:][:path.CHANGES], found[-path.CHANGES:]
    if moved_before or not all(stopped for _, stopped in busy + monitored):
        raise BenchError(f"the arms moved too soon, or stood still: {found}")
    return {"": free, "_busy": max(count for count, _ in busy), "_monitored": max(count for count, _ in monitored)}


def touched_figures():
    known = functions(*path.WAY, CLOCK_BEGINS)
    with tempfile.TemporaryDirectory(prefix="robosync-bench-") as folder:
        folder = Path(folder)
        out = folder / "marks"
        store = store_with(paper_for_this_board(folder), folder / "fed")
        with TouchedBoard(folder / "touched", store, plugin_arguments(known, out)) as board:
            by_the_clock = drive(board)
        marks = Marks(known, out)
    return {"power_up_to_first_step": (time_of_first_step(marks, by_the_clock), "us"),
            **{f"reading_to_command{name}": (count, "insn") for name, count in conditions(marks).items()}}


def figures_of_this_board():
    return {"flash": (figures.firmware_flash(), "B"), "ram_fixed": (memory.firmware_ram(), "B"), **touched_figures(),
            "idle_second": (idle.idle_alone(), "insn")}


def board_figures():
    asked = {name: subprocess.Popen([sys.executable, __file__], env={**os.environ, "ROBOSYNC_BOARD": name}, text=True,
                                    stdin=subprocess.DEVNULL, stdout=subprocess.PIPE) for name in others()}
    said = {name: process.communicate()[0] for name, process in asked.items()}
    failed = [name for name, process in asked.items() if process.returncode != 0]
    if failed:
        raise BenchError(f"no figures of {', '.join(failed)}")
    return {f"{name}/{what}": figure for name, found in said.items() for what, figure in json.loads(found).items()}


if __name__ == "__main__":
    print(json.dumps(figures_of_this_board()))

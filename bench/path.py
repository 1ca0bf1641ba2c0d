"""The path of a reading in the shipped firmware, with isolation on: instructions from the paper's reading in its
mailbox to the command at the driver of the first arm that must move. Everything in between counts, including
interrupts. The figure is the worst of several readings.

An arm that follows the touch takes the same path, from the reading to its new target.

There are three conditions, as users meet them. The arms are free: the first reading after power-up, with no bytes from
a host, whose interrupts would make the count depend on their timing. The arms are moving, so that a response is
interrupted and both arms are stopped first. The arms are moving while `rsc monitor` listens.
"""

import functools
import subprocess
import tempfile
import time
from pathlib import Path

import kept
import rsc
from board import REAL_TIME, Board
from counting import PATIENCE, READING, BenchError, Marks, ends_of, functions, plugin_arguments, wait_for_readings
from workloads import PAPER, W3

COMMAND = "robosync::drivers::servo::start("
RELEASE = "robosync::drivers::servo::release("
RULE = "robosync::layers::BehaviorLayer::judge_rule("
SIGNAL = "robosync::kernel::Kernel::signal("  # to an actuator's thread, when a command is in its queue
RESPONSE = "robosync::layers::BehaviorLayer::run_response("
CONCLUDE = "robosync::layers::ProcessingLayer::conclude("  # stages what the response has SET
WAY = (READING, COMMAND, RELEASE)
START_UPS = 4
CHANGES = 8
AWAKE = 2  # touches after which the arms are certain to move
FOLLOWING = "WHILE touch LEVEL >= 0\nDO FOLLOW left_arm TO (touch LEVEL * 10deg)\nEND\n"
LIGHT, FIRM = 1, 9  # touches on either side of the paper's threshold
BETWEEN = 15  # readings between two touches, 300 ms; the arms move for longer


def touch_again_and_again(board, pause, changes=CHANGES):
    for change in range(changes):
        board.set_touch((FIRM, LIGHT)[change % 2])
        pause()


def wait_until_it_listens(told):
    """Waits for the first output of `rsc monitor`: it names the board when the trace has begun."""
    deadline = time.monotonic() + PATIENCE
    while told.stat().st_size == 0:
        if time.monotonic() > deadline:
            raise BenchError("rsc monitor says nothing")
        time.sleep(0.01)


def drive(board, image, pause, told):
    """Touches CHANGES times while the arms move, then again with a monitor. Some touches before each make the arms
    move."""
    rsc.run("upload", image, "--port", board.port)
    pause()
    touch_again_and_again(board, pause, AWAKE + CHANGES)
    with open(told, "wb") as output, subprocess.Popen([rsc.TOOL, "monitor", "--port", board.port], stdin=subprocess.DEVNULL,
                                                      stdout=output, stderr=subprocess.DEVNULL) as monitor:
        try:
            wait_until_it_listens(told)
            touch_again_and_again(board, pause, AWAKE + CHANGES)
        finally:
            monitor.terminate()


def power_ups(image, folder, known):
    """The marks of START_UPS power-ups with that program."""
    store, out = kept.store_with(image, folder), Path(folder) / "marks-of-power-up"
    for _ in range(START_UPS):
        with Board(icount=REAL_TIME, extra=plugin_arguments(known, out), store=store):
            wait_for_readings(out, BETWEEN)
        yield Marks(known, out)


def pacer(out):
    return functools.partial(wait_for_readings, out, BETWEEN)


def ways(marks):
    """[(instructions, whether an arm was stopped on the way)] from the last reading before each first command."""
    found, start, stopped = [], None, False
    for name, count in marks.all:
        if name == READING:
            start, stopped = count, False
        elif name == RELEASE:
            stopped = True
        elif name == COMMAND and start is not None:
            found.append((count - start, stopped))
            start = None
    return found


def rule_to_queue(marks):
    """Instructions from the last rule evaluated before each first command to the last signal before it."""
    found, rule, signal, waits = [], 0, 0, False
    for name, count in marks.all:
        if name == READING:
            waits = True
        elif name == RULE:
            rule = count
        elif name == SIGNAL:
            signal = count
        elif name == COMMAND and waits:
            found.append(signal - rule)
            waits = False
    return found


def follow_update(known):
    """The worst of several new targets of an arm that follows."""
    with tempfile.TemporaryDirectory() as folder:
        program, image, out = (Path(folder) / name for name in ("follow.rsl", "follow.rsb", "marks"))
        program.write_text(FOLLOWING)
        rsc.run("compile", program, "--config", PAPER.with_name("robot.json"), "-o", image)
        with Board(icount=REAL_TIME, extra=plugin_arguments(known, out)) as board:
            board.set_touch(LIGHT)
            rsc.run("upload", image, "--port", board.port)
            pause = pacer(out)
            pause()
            touch_again_and_again(board, pause)
        found = ways(Marks(known, out))
    if len(found) < CHANGES or any(stopped for _, stopped in found[-CHANGES:]):
        raise BenchError(f"not every touch led to a new target, or the arm was stopped: {found}")
    return {"path/follow_update": (max(count for count, _ in found[-CHANGES:]), "insn")}


def sets_staged():
    """W3 in its behaviour's thread, until the step thread has staged its SETs: the worst of several times."""
    known = functions(RESPONSE, READING) | {CONCLUDE: ends_of(CONCLUDE)[-1]}
    with tempfile.TemporaryDirectory() as folder:
        image, out = Path(folder) / "w3.rsb", Path(folder) / "marks"
        rsc.run("compile", W3, "-o", image)
        with Board(icount=REAL_TIME, extra=plugin_arguments(known, out)) as board:
            rsc.run("upload", image, "--port", board.port)
            for raw in (LIGHT, FIRM) * CHANGES:
                board.set_touch(raw)
                wait_for_readings(out, 2)
        spans = Marks(known, out).spans(RESPONSE, CONCLUDE)
    if len(spans) < CHANGES:
        raise BenchError(f"W3 ran {len(spans)} times only")
    return {"vm/W3_staged": (max(spans), "insn")}


def path_figures():
    known = functions(*WAY, RULE, SIGNAL)
    with tempfile.TemporaryDirectory() as folder:
        image, out, told = (Path(folder) / name for name in ("paper.rsb", "marks", "told"))
        rsc.run("compile", PAPER, "-o", image)
        alone = list(power_ups(image, folder, known))
        with Board(icount=REAL_TIME, extra=plugin_arguments(known, out)) as board:
            drive(board, image, pacer(out), told)
        found = ways(Marks(known, out))
    free = [way for marks in alone for way in ways(marks)]
    busy, monitored = found[1 + AWAKE:][:CHANGES], found[-CHANGES:]
    if (len(free) != START_UPS or len(found) != 1 + 2 * (AWAKE + CHANGES) or any(stopped for _, stopped in free) or
            not all(stopped for _, stopped in busy + monitored)):
        raise BenchError(f"not every touch led to a command, or the arms stood still: {free} {found}")
    queued = [count for marks in alone for count in rule_to_queue(marks)]
    return follow_update(functions(*WAY)) | sets_staged() | {"vm/W1_queue": (max(queued), "insn")} | {
        f"path/reading_to_command{name}": (max(count for count, _ in way), "insn")
        for name, way in (("", free), ("_busy", busy), ("_monitored", monitored))}

"""One program and one script of readings, by the reference and by rsc run; what differs first.

Compared is, for every millisecond, which events there are, and in which order each actuator gets its
commands. Not compared: the numbers of steps and rules; zero_divide, which depends on how often a
condition is looked at; that a WHILE tries in vain again (`lose` without `fire`).

A *tie* is a millisecond in which rsc makes several steps: which of them sees what is a matter of the threads' ranks, and not of
the language. A difference that begins in a tie ends the comparison of that script, and is counted.
"""

import functools
import itertools
import json
import os
import re
import subprocess
from collections import Counter, defaultdict
from pathlib import Path
from typing import NamedTuple

import drawn

ROOT = Path(__file__).resolve().parents[2]
BUILD = Path(os.environ.get("ROBOSYNC_BUILD", ROOT / "build/host"))
REFERENCE = BUILD / "tests/oracles/rsl/reference"
RSC = BUILD / "rsc"
AFTER_MS = 3_000  # after the last reading
TIMEOUT = 60
SEED = 20_250_711  # of what programs draw: the board must not take one of its own
LEVELS = [("-O0",), ("-O1",)]  # of rsc compile, each of which must give the same
IGNORED = {"activated", "zero_divide"}
WITHOUT_STEP = {"done", "trip", "halt", "resume", "release"}  # come between steps


class Refused(Exception):
    """The program cannot be compiled; the message is the compiler's."""


class Difference(NamedTuple):
    at_ms: int
    tie: bool
    rsc: list  # events that only rsc has
    reference: list

    def __str__(self):
        lines = [f"first difference at {self.at_ms} ms"]
        lines += [f"  only rsc:       {event}" for event in self.rsc]
        lines += [f"  only reference: {event}" for event in self.reference]
        return "\n".join(lines)


def call(*arguments):
    return subprocess.run([str(a) for a in arguments], check=False, text=True, timeout=TIMEOUT,
                          stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE)


@functools.cache
def options_of(rsc):
    """What a compiler without levels has: one, which is not named."""
    return LEVELS if re.search("-O ?0", call(rsc, "compile", "--help").stdout) else [()]


@functools.cache
def anyway(rsc):
    """A drawn program may be more than a board can keep up with; an older rsc does not ask."""
    return ["--anyway"] if "--anyway" in call(rsc, "compile", "--help").stdout else []


@functools.cache
def fresh(rsc):
    """Each run by itself, whatever the program keeps; an older rsc keeps nothing."""
    return ["--fresh"] if "--fresh" in call(rsc, "run", "--help").stdout else []


def config_in(folder):
    """The robot, with the board that the environment says, as for the end-to-end tests."""
    if "ROBOSYNC_BOARD" not in os.environ:
        return drawn.CONFIG
    path = Path(folder) / "robot.json"
    path.write_text(json.dumps({**json.loads(drawn.CONFIG.read_text()), "board": os.environ["ROBOSYNC_BOARD"]}))
    return path


def compile_program(text, folder, *options, rsc=RSC):
    """The program and its image in `folder`."""
    source = Path(folder) / "program.rsl"
    image = Path(folder) / ("program" + "".join(options) + ".rsb")
    source.write_text(text)
    done = call(rsc, "compile", source, "--config", config_in(folder), "--seed", SEED, "-o", image, *options,
                *anyway(rsc))
    if done.returncode:
        raise Refused(done.stderr)
    return source, image


def compile_levels(text, folder, rsc=RSC):
    """The program and its images, one of each level."""
    compiled = [compile_program(text, folder, *options, rsc=rsc) for options in options_of(rsc)]
    return compiled[0][0], [image for _, image in compiled]


def write_scenario(readings, folder):
    stimuli = []
    for at_ms, channel, value in readings:
        sensor, name = channel.split(".")
        stimuli.append({"at": f"{at_ms}ms", "sensor": sensor, "channel": name,
                        "value": f"{value}{drawn.UNITS[channel]}"})
    path = Path(folder) / "scenario.json"
    path.write_text(json.dumps({"stimuli": stimuli}))
    return path


def by_millisecond(lines):
    events = defaultdict(list)
    for line in lines:
        event = json.loads(line)
        if event["event"] in IGNORED:
            continue
        event.pop("step", None)
        event.pop("rule", None)
        events[event["t_us"] // 1000].append(event)
    return {at: [e for e in found if not is_incidental(e, found)] for at, found in events.items()}


def is_incidental(event, others):
    return event["event"] == "lose" and not any(o["event"] == "fire" and o.get("line") == event["line"] for o in others)


def commands(events):
    found = defaultdict(list)
    for event in events:
        if event["event"] == "command":
            found[event["actuator"]].append(text_of(event))
    return found


def text_of(event):
    return json.dumps(event, sort_keys=True)


def is_tie(lines, at_ms):
    trace = [json.loads(line) for line in lines]
    events = [e for e in trace if e["t_us"] // 1000 == at_ms]
    kinds = {e["event"] for e in events}
    steps = {e["step"] for e in events if e["event"] not in WITHOUT_STEP}
    before = max((e["step"] for e in trace if e["t_us"] // 1000 < at_ms), default=0)
    # A step without events, of a WAIT UNTIL that looks in vain: it may have been in this millisecond.
    hidden = "input" in kinds and min(steps) > before + 1
    return len(steps) > 1 or hidden


def first_difference(rsc_lines, reference_lines):
    """Nothing when they are the same."""
    rsc, reference = by_millisecond(rsc_lines), by_millisecond(reference_lines)
    for at in sorted(rsc.keys() | reference.keys()):
        left, right = rsc.get(at, []), reference.get(at, [])
        ours, theirs = Counter(map(text_of, left)), Counter(map(text_of, right))
        if ours != theirs:
            return Difference(at, is_tie(rsc_lines, at), list((ours - theirs).elements()),
                              list((theirs - ours).elements()))
        if commands(left) != commands(right):
            return Difference(at, is_tie(rsc_lines, at), [*map(text_of, left)], [*map(text_of, right)])
    return None


def first_other_line(wanted, lines, why="whole"):
    """Where the board's trace, of which its player says `why` it ends, is not what rsc says; nothing when it is."""
    for number, (ours, theirs) in enumerate(itertools.zip_longest(wanted, lines)):
        if ours != theirs:
            return f"line {number} ({why})\n  rsc:   {ours}\n  board: {theirs}"
    return None


def end_of(readings):
    return (readings[-1].at_ms if readings else 0) + AFTER_MS


def rsc_trace(image, scenario, end_ms, rsc=RSC):
    """The lines of rsc run."""
    done = call(rsc, "run", image, "--scenario", scenario, "--duration", f"{end_ms}ms", "--format", "json",
                *fresh(rsc))
    if done.returncode:
        raise (Refused if "would refuse" in done.stderr else RuntimeError)(done.stderr)
    return done.stdout.splitlines()


def reference_trace(source, scenario, end_ms):
    """The lines of the reference."""
    done = call(REFERENCE, source, drawn.CONFIG, scenario, end_ms, SEED)
    if done.returncode:
        raise RuntimeError(done.stderr)
    return done.stdout.splitlines()


def traces(source, images, readings, folder, rsc=RSC):
    """The lines of rsc run, of each image, and those of the reference."""
    scenario, end_ms = write_scenario(readings, folder), end_of(readings)
    return [rsc_trace(image, scenario, end_ms, rsc) for image in images], reference_trace(source, scenario, end_ms)


def compare(source, images, readings, folder, rsc=RSC):
    """What is different first, of each image."""
    ours, theirs = traces(source, images, readings, folder, rsc)
    return [first_difference(lines, theirs) for lines in ours]

"""Measures what programs really cost on the Cortex-M4, and holds it against `rsc check --timing`.

Programs are compiled into a block (pack.cpp) that QEMU loads into the board's memory; a firmware
(firmware/) runs each through many steps; the counting plugin of bench/ says how many instructions
were executed between the markers around each entry into the VM. Assumes that the presets host and
m4 have been built.
"""

import itertools
import json
import re
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path += [str(ROOT / "bench"), str(ROOT / "tests/generators/programs")]

import counting  # noqa: E402
from generator import TOO_LARGE, Generator  # noqa: E402

PACK = ROOT / "build/host/tests/timing/timing_pack"
FIRMWARE = ROOT / "build/m4/bench/timing"
CONFIG = ROOT / "tests/e2e/programs/robot.json"
BLOCK_ADDRESS = 0x21000000  # kBlockAddress of firmware/block.hpp
BATCH = 250  # programs a boot
STEPS = 40  # random ones, for each program


class Part:
    """A condition or a response: what it costs at most, and what it has cost."""

    def __init__(self, name, bound):
        self.name, self.bound, self.worst = name, bound, 0

    def ran(self, count):
        self.worst = max(self.worst, count)


class Program:
    """What rsc says that a program costs, and what it has cost."""

    def __init__(self, said):
        self.file = said["file"]
        self.step = Part("step", said["step"]["used"])
        rules = sorted((rule for behavior in said["behaviors"] for rule in behavior["rules"]),
                       key=lambda rule: rule["rule"])
        self.rules = [{part: Part(f"rule {rule['rule']} (line {rule['line']}), {part}", rule[part])
                       for part in ("condition", "do", "else")} for rule in rules]
        self.opcodes = set(said["opcodes"])
        self.conditions = [rule["condition"] for rule in self.rules if rule["condition"].bound]

    def parts(self):
        return [self.step, *(part for rule in self.rules for part in rule.values())]

    def over(self):
        """What has cost more than was said."""
        return [f"{self.file}: {part.name} takes {part.worst} instructions, said to take {part.bound}"
                for part in self.parts() if part.worst > part.bound]

    def looseness(self):
        return self.step.bound / self.step.worst


class Observer:
    """Goes through the marks of one boot and gives each part of each program its counts."""

    def __init__(self, programs):
        self._programs = iter(programs)
        self._program = self._conditions = self._rules = self._rule = None
        self._side, self._sides = None, {}
        self._start = self._step = 0

    def go(self, marks):
        for name, count in marks:
            getattr(self, name)(count)

    def mark_program(self, _):
        self._program = next(self._programs)

    def mark_step(self, _):
        self._conditions, self._rules = iter(self._program.conditions), iter(self._program.rules)
        self._step = 0

    def mark_condition_begin(self, count):
        self._start = count

    mark_response_begin = mark_condition_begin

    def mark_condition_end(self, count):
        self._add(next(self._conditions), count - self._start)

    def mark_rule(self, _):
        self._rule = next(self._rules)

    def mark_then(self, _):
        self._sides[id(self._rule)] = "do"

    def mark_otherwise(self, _):
        self._sides[id(self._rule)] = "else"

    def mark_response_end(self, count):
        self._add(self._rule[self._sides[id(self._rule)]], count - self._start)

    def _add(self, part, count):
        part.ran(count)
        self._step += count
        self._program.step.ran(self._step)


def pack(block, steps, arguments):
    """What timing_pack says of each program; one that is refused must be too large, nothing else."""
    said = subprocess.run([str(PACK), str(block), str(steps), *map(str, arguments)], check=True,
                          text=True, stdout=subprocess.PIPE).stdout
    programs = json.loads(said)
    for program in programs:
        if set(program.get("errors", [])) - {TOO_LARGE}:
            raise counting.BenchError(f"{program['file']}: {program['errors']}")
    return [Program(program) for program in programs if "errors" not in program]


def measure(arguments, steps=STEPS):
    """Runs programs, each `FILE` or `FILE:SCENARIO`, in one boot; gives them as Program."""
    with tempfile.TemporaryDirectory(prefix="robosync-timing-") as folder:
        block = Path(folder) / "block"
        programs = pack(block, steps, arguments)
        marks = counting.run(FIRMWARE, ["-device", f"loader,file={block},addr={BLOCK_ADDRESS:#x},"
                                        "force-raw=on"])
    Observer(programs).go(marks.all)
    return programs


def measure_random(count, steps=STEPS):
    """`count` programs drawn over the whole language, the same every time; yields them in batches."""
    seeds = itertools.count()
    while count > 0:
        with tempfile.TemporaryDirectory(prefix="robosync-timing-") as folder:
            files = []
            for seed in itertools.islice(seeds, min(count, BATCH)):
                files.append(Path(folder) / f"seed-{seed}.rsl")
                files[-1].write_text(Generator(seed).program())
            programs = measure(["--config", CONFIG, *files], steps)
        count -= len(programs)
        yield programs


def opcodes():
    """Every opcode there is."""
    return set(re.findall(r"^OPCODE\((\w+),", (ROOT / "vm/opcodes.def").read_text(), re.M))


def examples():
    """(program, its scenario or None) of each example."""
    for folder in sorted((ROOT / "examples").iterdir()):
        program = folder / "robot.rsl"
        if not program.exists():
            continue
        scenarios = [file for file in sorted(folder.glob("*.json")) if file.name != "robot.json"]
        yield program, scenarios[0] if scenarios else None

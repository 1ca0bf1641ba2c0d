"""What compiling costs on the computer: CPU time of `rsc check`, and how time and memory grow.

CPU time is that of the process and of the system for it. It is the least of several runs, so that other work on the
machine adds little. Growth compares 2n with n, after subtracting what rsc needs for any program.
"""

import json
import subprocess
import tempfile
from pathlib import Path

import compile_programs
import rsc
from compile_programs import RULE_LINES
from counting import ROOT, BenchError

PAPER = ROOT / "examples/paper/robot.rsl"
USAGE = ROOT / "build/host/bench/usage"
LARGE = 100_000  # lines
RUNS = 5
MOST_RUNS = 25  # while a ratio is above its bar: other work on the machine may be the reason
BARS = json.loads((Path(__file__).parent / "bars.json").read_text())
GROWTH_BAR = BARS["compile/growth_of_memory"]
LITTLE, LITTLE_TIME = 4096, 1e-3  # KiB, seconds; below that, growth cannot be measured


def write(source, folder):
    """Writes the program's files; returns the path of robot.rsl."""
    program = Path(folder) / "robot.rsl"
    program.write_text("\n".join(source.lines) + "\n")
    robot = compile_programs.the_robot() if source.robot is None else source.robot
    text = robot if isinstance(robot, str) else json.dumps(robot, indent=1)
    program.with_suffix(".json").write_text(text)
    for name, module in source.modules.items():
        program.with_name(name).write_text(module)
    return program


def check(program, *options):
    """Returns (seconds of CPU, KiB of memory, exit code) of `rsc check`."""
    said = subprocess.run([str(USAGE), str(rsc.TOOL), "check", str(program), *options], check=True, text=True,
                          timeout=rsc.TIMEOUT, stdout=subprocess.PIPE).stdout
    microseconds, memory, code = map(int, said.split())
    if code not in (0, 1):
        raise BenchError(f"rsc check {program} ended with {code}")
    return microseconds / 1e6, memory, code


def least(program, runs=RUNS, options=()):
    """Returns (seconds, KiB), each the least of several runs."""
    measured = [check(program, *options)[:2] for _ in range(runs)]
    return tuple(map(min, zip(*measured)))


class Growing:
    """A program of size n and one of 2n, measured until their ratio meets the bar, at most MOST_RUNS times."""

    def __init__(self, make, n, base):
        self._base = base
        with tempfile.TemporaryDirectory() as folder:
            programs = []
            for times in (1, 2):
                place = Path(folder) / str(times)
                place.mkdir()
                programs.append(write(make(times * n), place))
            self._ratios = self._measure(programs)
            for _ in range(MOST_RUNS // RUNS - 1):
                if max(self._ratios) <= GROWTH_BAR:
                    break
                self._ratios = tuple(map(min, self._ratios, self._measure(programs)))

    def _measure(self, programs):
        """Measures the two programs in turn, so that a slow phase of the machine affects both. Returns the ratios, as
        below."""
        rounds = [[check(program)[:2] for program in programs] for _ in range(RUNS)]
        (few, few_kib), (many, many_kib) = (
            [min(used) - base for used, base in zip(zip(*each), self._base)] for each in zip(*rounds))
        return max(many, 0) / max(few, LITTLE_TIME), max(many_kib, 0) / max(few_kib, LITTLE)

    def ratios(self):
        """(time, memory): the least of several rounds."""
        return self._ratios


def lines_per_second(source, without=0):
    """`without`: seconds to subtract."""
    with tempfile.TemporaryDirectory() as folder:
        program = write(source, folder)
        anyway = ["--anyway"]  # a board cannot keep up with this many rules
        if check(program, *anyway)[2] != 0:
            raise BenchError("rsc check finds errors in the large program")
        return round(len(source.lines) / (least(program, options=anyway)[0] - without))


def compile_figures():
    base = least(PAPER, 2 * RUNS)
    large = compile_programs.large_program(LARGE)
    rules = compile_programs.Source(compile_programs.large_rules(RULE_LINES))
    figures = {
        "compile/lines_per_second": (lines_per_second(large), "lines/s"),
        "compile/rule_lines_per_second": (lines_per_second(rules, base[0]), "lines/s"),
        "compile/paper": (round(base[0] * 1000, 1), "ms"),
    }
    memory = 0
    for make, n in compile_programs.REPEATED.items():
        time_ratio, memory_ratio = Growing(make, n, base).ratios()
        figures[f"compile/growth_{make.__name__}"] = (round(time_ratio, 2), "x")
        memory = max(memory, memory_ratio)
    figures["compile/growth_of_memory"] = (round(memory, 2), "x")
    return figures

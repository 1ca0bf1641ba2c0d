"""scripts/bench: measures all figures, and compares each with its bar and its recorded value.

Prints a table; with --json one object a line; with --markdown the page docs/measurements.md. Figures are executed
Cortex-M4 instructions (in QEMU, exact), bytes and times. Bars come from the design and are not adjusted: a figure that
misses its bar is shown as missed. Exit code 1 if a figure misses a bar that it met when it was recorded, or a counted
figure grew (recorded.py).
"""

import argparse
import json
import os
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import answer
import boards
import bus
import compile_figures
import figures
import growth
import idle
import memory
import page
import path
import profiled
import recorded
import safety
import upload
import workloads
from board import BoardError
from counting import BenchError
from rsc import RscError

BARS = json.loads((Path(__file__).parent / "bars.json").read_text())
GROUPS = (workloads.workload_figures, workloads.smoothing_figures, figures.opcode_figures, figures.image_figures,
          figures.kernel_figures, figures.size_figures, memory.memory_figures, growth.growth_figures,
          figures.link_figures, answer.answer_figures, upload.upload_figures, figures.signature_figures, figures.power_up_figures, figures.ear_figures, figures.algorithms_figures,
          path.path_figures, safety.safety_figures, idle.idle_figures, compile_figures.compile_figures,
          figures.tool_figures, bus.i2c_figures, boards.board_figures)
# Those that measure time. Another busy core would make them slower, so each runs alone; the others count, and run in parallel.
TIMED = {figures.link_figures, answer.answer_figures, upload.upload_figures, compile_figures.compile_figures}
BY_NAME = {group.__name__.removesuffix("_figures"): group for group in GROUPS}


def measure(groups):
    """Yields every figure of the groups as {"name", "value", "unit", "bar"}, in their order; raises if one cannot be measured."""
    timed = {group: group() for group in groups if group in TIMED}
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        counted = {group: pool.submit(group) for group in groups if group not in TIMED}
        for group in groups:
            for name, (value, unit) in (timed[group] if group in TIMED else counted[group].result()).items():
                yield {"name": name, "value": value, "unit": unit, "bar": BARS.get(boards.whose_bar(name))}


def as_line(figure, grew):
    bar = "" if figure["bar"] is None else f"bar {figure['bar']}"
    verdict = page.verdict(figure)
    return (f"{figure['name']:32} {figure['value']:>10} {figure['unit']:8} {bar:11} "
            f"{verdict}{' GREW' if grew else ''}").rstrip()


def complain(messages):
    """Prints the messages to stderr; returns how many there were."""
    messages = list(messages)
    for message in messages:
        print(f"bench: {message}", file=sys.stderr)
    return len(messages)


# The ratio of CPU times for 2n and n: near 2 if linear, near 4 if quadratic. Other work on the machine moves it by some
# tenths, so a missed bar is only shown; a ratio that is clearly not linear fails.
NOT_LINEAR = 3.0


def fails(figure, before):
    """True if a bar is missed, unless the speed of this machine may be the reason: that is for people to judge.
    `before`: the recorded value, or None."""
    if page.verdict(figure) != page.MISSED:
        return False
    if figure["name"].startswith("compile/growth_"):
        return figure["value"] > NOT_LINEAR
    if figure["unit"] in recorded.NOT_EXACT:
        return False
    return before is None or page.verdict(figure | {"value": before}) != page.MISSED


def measure_all(groups, show, comparison):
    """Shows each figure as soon as it is measured. Returns (figures, how many of them failed)."""
    found, failed = [], 0
    for figure in measure(groups):
        grew = not comparison.add(figure)
        failed += grew or fails(figure, comparison.before(figure))
        found.append(figure)
        show(figure, grew)
    return found, failed


def what_is_gone(found, comparison):
    gone = BARS.keys() - {figure["name"] for figure in found}
    yield from (f"nothing measures {name}, which has a bar" for name in sorted(gone))
    yield from (f"nothing measures {name}, which is recorded" for name in comparison.missing())


def arguments():
    parser = argparse.ArgumentParser(prog="scripts/bench")
    parser.add_argument("--record", action="store_true")
    parser.add_argument("--only", choices=BY_NAME, metavar="GROUP")
    style = parser.add_mutually_exclusive_group()
    style.add_argument("--json", action="store_true")
    style.add_argument("--markdown", action="store_true")
    style.add_argument("--profile", metavar="NAME")
    return parser.parse_args()


def main():
    wanted = arguments()

    def show(figure, grew):
        if wanted.json:
            print(json.dumps(figure), flush=True)
        elif not wanted.markdown:
            print(as_line(figure, grew), flush=True)

    comparison = recorded.Comparison(None if wanted.record else recorded.load())
    try:
        if wanted.profile:
            profiled.show(wanted.profile)
            return 0
        groups = GROUPS if wanted.only is None else [BY_NAME[wanted.only]]
        found, failed = measure_all(groups, show, comparison)
    except (BenchError, BoardError, RscError, OSError, subprocess.SubprocessError) as error:
        print(f"bench: {error}", file=sys.stderr)
        return 1
    passed = len(found) - failed
    if wanted.record:
        recorded.save(found, before=recorded.load() if wanted.only else {})
    if wanted.markdown:
        print("\n".join(map(page.as_row, found)) if wanted.only else page.page(found))
    complain(comparison.grown + comparison.shrunk)
    if not wanted.only:
        failed += complain(what_is_gone(found, comparison))
    if not wanted.json and not wanted.markdown:
        print(f"{passed} passed, {failed} failed")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())

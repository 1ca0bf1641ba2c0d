"""scripts/bench: measures every figure there is, and holds it against its bar.

Prints a table for people, with --json one object a line for programs, with --markdown the page
docs/measurements.md. Figures are executed Cortex-M4 instructions (in QEMU, exact), bytes and times.
Exit code 1 when a bar is missed.
"""

import argparse
import json
import subprocess
import sys
from pathlib import Path

import figures
from board import BoardError
from counting import BenchError
from rsc import RscError

BARS = json.loads((Path(__file__).parent / "bars.json").read_text())
GROUPS = (figures.vm_figures, figures.image_figures, figures.kernel_figures,
          figures.size_figures, figures.link_figures, figures.path_figures,
          figures.compiler_figures)


def measure():
    """Every figure as {"name", "value", "unit", "bar"}; what could not be measured raises."""
    for group in GROUPS:
        for name, (value, unit) in group().items():
            yield {"name": name, "value": value, "unit": unit, "bar": BARS.get(name)}


def verdict(figure):
    if figure["bar"] is None:
        return ""
    return "ok" if figure["value"] <= figure["bar"] else "MISSED"


def as_line(figure):
    bar = "" if figure["bar"] is None else f"bar {figure['bar']}"
    return (f"{figure['name']:32} {figure['value']:>10} {figure['unit']:8} {bar:11} "
            f"{verdict(figure)}").rstrip()


def as_row(figure):
    bar = "–" if figure["bar"] is None else f"≤ {figure['bar']}"
    return f"| `{figure['name']}` | {figure['value']} | {figure['unit']} | {bar} | {verdict(figure)} |"


MARKDOWN_HEAD = """# Measurements

Printed by `scripts/bench --markdown`. `insn` are executed Cortex-M4 instructions, counted exactly by a plugin in
QEMU 7.2 (`bench/count_plugin/`); they are not cycles. Bytes are what the linker kept. Times are wall clock on the
machine that printed this page. What each figure means: `bench/figures.py`; bars: `bench/bars.json`.

`vm/flash` and `vm/verify_per_word` stand above the design's bars (4,096 bytes, 60 a word): those were for arithmetic,
comparisons and commands. The whole language came since: time words, blocks, loops, waits, variables, CHECKs, SAFETY, and
the verification of all of them. Their bars in `bench/bars.json` keep them from growing unnoticed.

| figure | value | unit | bar | |
|---|---|---|---|---|"""


def main():
    parser = argparse.ArgumentParser(prog="scripts/bench")
    style = parser.add_mutually_exclusive_group()
    style.add_argument("--json", dest="show", action="store_const", const=json.dumps)
    style.add_argument("--markdown", dest="show", action="store_const", const=as_row)
    show = parser.parse_args().show or as_line
    if show is as_row:
        print(MARKDOWN_HEAD)
    passed = failed = 0
    seen = set()
    try:
        for figure in measure():
            seen.add(figure["name"])
            missed = verdict(figure) == "MISSED"
            passed, failed = passed + (not missed), failed + missed
            print(show(figure), flush=True)
    except (BenchError, BoardError, RscError, OSError, subprocess.SubprocessError) as error:
        print(f"bench: {error}", file=sys.stderr)
        failed += 1
    else:
        for name in sorted(BARS.keys() - seen):
            print(f"bench: nothing measures {name}", file=sys.stderr)
            failed += 1
    if show is as_line:
        print(f"{passed} passed, {failed} failed")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())

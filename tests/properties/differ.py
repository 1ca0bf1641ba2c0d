#!/usr/bin/env python3
"""Compares rsc run with the reference interpreter on drawn programs and drawn readings.

    tests/properties/differ.py --programs 1000 --seed 0

Ends with code 1 and the smallest case that it finds when something differs.
"""

import argparse
import functools
import os
import re
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import NamedTuple

import comparison
import drawn
import shrink

SCRIPTS = 3  # of readings for each program
LEVELS = [("-O0",), ("-O1",)]  # of rsc compile, each of which must give the same


@functools.cache
def options_of(rsc):
    """What a compiler without levels has: one, which is not named."""
    return LEVELS if re.search("-O ?0", comparison.call(rsc, "compile", "--help").stdout) else [()]


class Case(NamedTuple):
    text: str
    readings: list
    difference: comparison.Difference


class Result(NamedTuple):
    compared: int = 0  # scripts
    ties: int = 0
    cases: tuple = ()  # that differ


def check(seed, rsc=comparison.RSC, scripts=SCRIPTS):
    """Nothing is compared when the compiler refuses the program."""
    text = drawn.program(seed)
    compared, ties, cases = 0, 0, []
    with tempfile.TemporaryDirectory(prefix="robosync-reference-") as folder:
        for options in options_of(rsc):
            try:
                source, image = comparison.compile_program(text, folder, *options, rsc=rsc)
                for script in range(scripts):
                    readings = drawn.readings(seed * scripts + script, text)
                    difference = comparison.compare(source, image, readings, folder, rsc)
                    compared += 1
                    if difference is not None and difference.tie:
                        ties += 1
                    elif difference is not None:
                        cases.append(Case(text, readings, difference))
            except comparison.Refused:
                return Result()
    return Result(compared, ties, tuple(cases))


def shown(case):
    readings = "\n".join(f"  {r.at_ms} ms {r.channel} = {r.value}" for r in case.readings)
    return f"{case.text}\n{readings}\n\n{case.difference}"


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("--programs", type=int, default=100)
    parser.add_argument("--seed", type=int, default=0, help="of the first program")
    parser.add_argument("--rsc", type=Path, default=comparison.RSC, help="another build of it")
    parser.add_argument("--no-shrink", action="store_true")
    parser.add_argument("--all", action="store_true", help="go on after a difference")
    wanted = parser.parse_args()
    seeds = range(wanted.seed, wanted.seed + wanted.programs)
    compared = ties = differ = refused = 0
    with ThreadPoolExecutor(os.cpu_count() or 1) as pool:
        for seed, result in zip(seeds, pool.map(lambda s: check(s, wanted.rsc), seeds)):
            compared += result.compared
            ties += result.ties
            differ += len(result.cases)
            refused += result.compared == 0
            for case in result.cases[:1]:
                print(f"program {seed}: {case.difference}", flush=True)
            if result.cases and not wanted.all:
                pool.shutdown(cancel_futures=True)
                report(result.cases[0], wanted)
                break
    print(f"{compared} scripts compared, {differ} differ, {ties} as far as a tie; "
          f"{refused} programs refused")
    return 1 if differ or not compared else 0


def report(case, wanted):
    if not wanted.no_shrink:
        text, readings = shrink.shrunk(case.text, case.readings, wanted.rsc)
        case = case._replace(text=text, readings=readings)
    print(shown(case))


if __name__ == "__main__":
    sys.exit(main())

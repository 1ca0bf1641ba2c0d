#!/usr/bin/env python3
"""Compares rsc run with the reference interpreter on drawn programs and drawn readings.

    tests/reference/differ.py --programs 1000 --seed 0

Ends with code 1 and the smallest case that it finds when something differs.
"""

import argparse
import os
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import NamedTuple

import comparison
import programs
import shrink

SCRIPTS = 3  # of readings for each program
OPTIONS = [()]  # of rsc compile, each of which must give the same


class Case(NamedTuple):
    text: str
    readings: list
    difference: comparison.Difference


def check(seed, rsc=comparison.RSC, scripts=SCRIPTS):
    """None: refused by the compiler; else the cases that differ."""
    text = programs.program(seed)
    cases = []
    with tempfile.TemporaryDirectory(prefix="robosync-reference-") as folder:
        for options in OPTIONS:
            try:
                source, image = comparison.compile_program(text, folder, *options, rsc=rsc)
                for script in range(scripts):
                    readings = programs.drawn_readings(seed * scripts + script, text)
                    difference = comparison.compare(source, image, readings, folder, rsc)
                    if difference is not None:
                        cases.append(Case(text, readings, difference))
            except comparison.Refused:
                return None
    return cases


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
    compared = refused = differ = 0
    with ThreadPoolExecutor(os.cpu_count() or 1) as pool:
        for seed, cases in zip(seeds, pool.map(lambda s: check(s, wanted.rsc), seeds)):
            if cases is None:
                refused += 1
                continue
            compared += 1
            if not cases:
                continue
            differ += 1
            print(f"program {seed}: {cases[0].difference}", flush=True)
            if wanted.all:
                continue
            pool.shutdown(cancel_futures=True)
            if not wanted.no_shrink:
                text, readings = shrink.shrunk(cases[0].text, cases[0].readings, wanted.rsc)
                print(text, *readings, sep="\n")
            break
    print(f"{compared} programs compared, {differ} differ; {refused} are no programs")
    return 1 if differ or not compared else 0


if __name__ == "__main__":
    sys.exit(main())

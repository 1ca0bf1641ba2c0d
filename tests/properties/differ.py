#!/usr/bin/env python3
"""Compares rsc run with the reference interpreter on drawn programs and drawn readings; and the board with both.

    tests/properties/differ.py --programs 1000 --seed 0 [--board]

Ends with code 1 and the smallest case that it finds when something differs.
"""

import argparse
import contextlib
import itertools
import os
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import NamedTuple

import comparison
import drawn
import shrink

sys.path.append(str(comparison.ROOT / "scripts/python"))

from board import BoardError, end_on_signals  # noqa: E402
from boards import Boards  # noqa: E402

SCRIPTS = 3  # of readings for each program
TOLD = 100  # programs, and then how many it were
# What a board's readings come later, which must be there before their time is; it does not wait for them.
LEADS_MS = (1_500, 6_000, 24_000, 96_000)
ATTEMPTS = 6  # at a trace that must not lose events, if one differs


class Case(NamedTuple):
    text: str
    readings: list
    difference: object  # which says itself as a text
    on_board: bool = False


class Result(NamedTuple):
    compared: int = 0  # scripts, at each level
    ties: int = 0
    cases: tuple = ()  # that differ
    refused: int = 0  # programs, by the compiler
    played: int = 0  # … by a board
    refused_by_board: int = 0
    too_much: int = 0  # more than fits on the line, each time: nothing is compared
    unsteady: int = 0  # played otherwise the first time, but not again

    def __add__(self, other):
        return Result(*(a + b for a, b in zip(self, other)))


def compare(program, readings, rsc):
    """One script, at each level."""
    text, source, images, folder = program
    found = [d for d in comparison.compare(source, images, readings, folder, rsc) if d is not None]
    return Result(len(images), sum(d.tie for d in found), tuple(Case(text, readings, d) for d in found if not d.tie))


def check(seed, rsc=comparison.RSC, scripts=SCRIPTS, board=None):
    """Nothing is compared when the compiler refuses the program."""
    text = drawn.program(seed)
    with tempfile.TemporaryDirectory(prefix="robosync-reference-") as folder:
        try:
            program = (text, *comparison.compile_levels(text, folder, rsc), folder)
            of_scripts = [drawn.readings(seed * scripts + script, text) for script in range(scripts)]
            result = sum((compare(program, readings, rsc) for readings in of_scripts), Result())
            if board is not None:
                result += check_board(seed, program, of_scripts[0], rsc, board)
            return result
        except comparison.Refused:
            return Result(refused=1)


def delayed(readings, by_ms):
    return [reading._replace(at_ms=reading.at_ms + by_ms) for reading in readings]


def check_board(seed, program, readings, rsc, board):
    """What rsc, the reference and the board do with the same readings. Every other program is played as it is written."""
    text, source, images, folder = program
    image = images[seed % len(images)]
    for lead_ms in LEADS_MS:
        later = delayed(readings, lead_ms)
        result = compare((text, source, [image], folder), later, rsc)
        difference, why = play(image, later, folder, rsc, board)
        if why == "refused":
            return Result(refused_by_board=1)
        if difference and why == "lost":
            return result + Result(too_much=1)
        if why != "late":
            break
    if difference:  # on the board time passes while the line is busy: a movement may end a millisecond late
        again, _ = play(image, later, folder, rsc, board)
        if again is None:
            print(f"program {seed}, not again: {difference}", flush=True)
            return result + Result(played=1, unsteady=1)
    cases = (Case(text, later, difference, on_board=True),) if difference else ()
    return result + Result(cases=cases, played=1)


def play(image, readings, folder, rsc, board):
    """What the board does otherwise than rsc, if anything, and what the player says of its trace."""
    scenario, end_ms = comparison.write_scenario(readings, folder), comparison.end_of(readings)
    wanted = comparison.rsc_trace(image, scenario, end_ms, rsc)
    for _ in range(ATTEMPTS):
        try:
            lines, why = board.play(image, scenario, end_ms)
        except BoardError as error:
            return f"on the board: {error}", "no end"
        if lines == wanted or why != "lost":
            break
    return comparison.first_other_line(wanted, lines, why), why


def stay_on(cores):
    """The next core, for a thread, its board and the player that it starts: they wait for each other most of the time."""
    os.sched_setaffinity(0, {next(cores)})


def said(total):
    text = (f"{total.compared} scripts compared, {len(total.cases)} differ, {total.ties} as far as a tie; "
            f"{total.refused} programs refused")
    if total.played or total.refused_by_board:
        text += (f"; {total.played} programs played by the board, which refused {total.refused_by_board}; "
                 f"of {total.too_much} the trace does not fit on the line, {total.unsteady} were unsteady")
    return text


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("--programs", type=int, default=100)
    parser.add_argument("--seed", type=int, default=0, help="of the first program")
    parser.add_argument("--board", action="store_true", help="play each to the board in QEMU as well")
    parser.add_argument("--jobs", type=int, default=os.cpu_count() or 1, help="programs at a time, each on its board")
    parser.add_argument("--rsc", type=Path, default=comparison.RSC, help="another build of it")
    parser.add_argument("--no-shrink", action="store_true")
    parser.add_argument("--all", action="store_true", help="go on after a difference")
    return parser.parse_args()


def shown(case):
    readings = "\n".join(f"  {r.at_ms} ms {r.channel} = {r.value}" for r in case.readings)
    return f"{case.text}\n{readings}\n\n{case.difference}"


def report(case, wanted):
    if not wanted.no_shrink and not case.on_board:
        case = Case(*shrink.shrunk(case.text, case.readings, wanted.rsc))
    print(shown(case))


def main():
    wanted = arguments()
    end_on_signals()
    seeds = range(wanted.seed, wanted.seed + wanted.programs)
    total = Result()
    cores = itertools.cycle(sorted(os.sched_getaffinity(0)))
    with ThreadPoolExecutor(wanted.jobs, initializer=stay_on, initargs=(cores,)) as pool, \
            (Boards() if wanted.board else contextlib.nullcontext()) as board:
        for seed, result in zip(seeds, pool.map(lambda s: check(s, wanted.rsc, board=board), seeds)):
            total += result
            for case in result.cases[:1]:
                print(f"program {seed}: {case.difference}", flush=True)
            if result.cases and not wanted.all:
                pool.shutdown(cancel_futures=True)
                report(result.cases[0], wanted)
                break
            if (seed - wanted.seed + 1) % TOLD == 0:
                print(f"programs {wanted.seed} to {seed}: {said(total)}", flush=True)
    print(said(total))
    return 1 if total.cases or not total.compared else 0


if __name__ == "__main__":
    sys.exit(main())

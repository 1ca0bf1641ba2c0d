"""Optimised or not, a program does the same: random programs have the same trace at -O0 and -O1.

Run it as a program to test any number of programs: test_levels.py --count 1000 --first 0
"""

import argparse
import json
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "scripts/python"), str(ROOT / "tests/generators/programs")]

import rsc
import stimuli
from generator import Generator
from support import CONFIG

COUNT = 40  # programs in the test suite
REFUSED = 1  # exit code of rsc
MOST_TOO_LARGE = 0.15  # of the programs
AFTER_MS = 4_000  # program time for everything that was started to continue


def scenario_of(readings):
    entries = [{"at": f"{r.at_ms}ms", "sensor": r.channel.split(".")[0],
                "channel": r.channel.split(".")[1], "value": f"{r.value}{stimuli.UNITS[r.channel]}"}
               for r in readings]
    return json.dumps({"stimuli": entries})


def traces(seed, folder):
    """The traces of one program, unoptimised and optimised, and its text.

    Some programs are too large for a robot. The unoptimised one may be too large while the optimised one fits;
    then there is nothing to compare, and both traces are empty.
    """
    text = Generator(seed).program()
    readings = stimuli.drawn(seed, text)
    program, scenario = folder / "drawn.rsl", folder / "scenario.json"
    program.write_text(text)
    scenario.write_text(scenario_of(readings))
    until_ms = readings[-1].at_ms + AFTER_MS
    runs = [rsc.call("run", program, level, "--fresh", "--config", CONFIG, "--scenario", scenario,
                     "--duration", f"{until_ms}ms", "--format", "json") for level in ("-O0", "-O1")]
    if runs[0].returncode == REFUSED:
        return (), (), text
    return (*((run.returncode, *run.stdout.splitlines()) for run in runs), text)


class Levels(unittest.TestCase):
    def test_drawn_programs(self):
        print(f"seeds 0 to {COUNT - 1}")
        events = too_large = 0
        with tempfile.TemporaryDirectory(prefix="robosync-levels-") as folder:
            for seed in range(COUNT):
                with self.subTest(seed=seed):
                    plain, optimized, text = traces(seed, Path(folder))
                    self.assertEqual(plain, optimized, text)
                    events += len(plain)
                    too_large += not plain
        self.assertLess(too_large, MOST_TOO_LARGE * COUNT)
        self.assertGreater(events, 20 * COUNT)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--count", type=int, default=COUNT)
    parser.add_argument("--first", type=int, default=0, help="the first seed")
    wanted = parser.parse_args()
    failed = []
    with tempfile.TemporaryDirectory(prefix="robosync-levels-") as folder:
        for seed in range(wanted.first, wanted.first + wanted.count):
            plain, optimized, _ = traces(seed, Path(folder))
            if plain != optimized:
                failed.append(seed)
                print(f"seed {seed}: the traces differ")
    print(f"{wanted.count - len(failed)} passed, {len(failed)} failed")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())

"""rsc run does what the reference interpreter says; and the comparison can tell when it does not."""

import json
import os
import re
import tempfile
import unittest
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import comparison
import differ
import drawn
import relaid
import shrink

PROGRAMS = int(os.environ.get("ROBOSYNC_REFERENCE_PROGRAMS", "100"))
LEAST_COMPARED = 4 * PROGRAMS  # scripts, at both levels; the compiler refuses some programs, as too large
MOST_TIES = 0.05  # of the scripts, which are few under sanitizers

FINE = """\
WHEN touch LEVEL > 4
DO LIGHT lamp ON
END
WHILE proximity DISTANCE > 1m
DO
  WAIT 40ms
  LOG "far"
END
"""
READINGS = [drawn.Reading(5, "touch.LEVEL", 2), drawn.Reading(15, "proximity.DISTANCE", 400),
            drawn.Reading(25, "touch.LEVEL", 7), drawn.Reading(95, "touch.LEVEL", 0)]


class Reference(unittest.TestCase):
    def test_drawn_programs(self):
        with ThreadPoolExecutor(os.cpu_count() or 1) as pool:
            results = list(pool.map(differ.check, range(PROGRAMS)))
        for seed, result in enumerate(results):
            for case in result.cases:
                with self.subTest(seed=seed):
                    self.fail(differ.shown(differ.Case(*shrink.shrunk(case.text, case.readings))))
        compared = sum(result.compared for result in results)
        self.assertGreaterEqual(compared, LEAST_COMPARED)
        self.assertLess(sum(result.ties for result in results) / compared, MOST_TIES)


class Formatted(unittest.TestCase):
    """rsc fmt changes what is between the words of a program, not what it does; and its own texts not at all. However the words
    are laid out, no two statements share a line then."""

    def test_drawn_programs(self):
        with ThreadPoolExecutor(os.cpu_count() or 1) as pool:
            compared = sum(pool.map(self.check, range(PROGRAMS)))
        self.assertGreater(compared, PROGRAMS / 2)

    def check(self, seed):
        text = drawn.program(seed)
        with tempfile.TemporaryDirectory(prefix="robosync-formatted-") as folder:
            before = self.code_of(text, Path(folder) / "before.rsl")
            other = relaid.relaid(text, seed)
            formatted = self.formatted(other, Path(folder) / "relaid.rsl")
            self.assertEqual(relaid.contents(formatted), relaid.contents(other))
            self.assertEqual(relaid.crowded(formatted) + relaid.glued(formatted), [], formatted)
            self.assertEqual(self.formatted(formatted, Path(folder) / "again.rsl"), formatted)
            self.assertEqual(self.code_of(formatted, Path(folder) / "after.rsl"), before, text)
        return before is not None

    def formatted(self, text, file):
        file.write_text(text)
        done = comparison.call(comparison.RSC, "fmt", file)
        self.assertEqual(done.returncode, 0, done.stderr)
        return file.read_text()

    def code_of(self, text, file):
        """The image as `rsc dump` shows it, without source lines and the sums over its text; None: the compiler refuses it."""
        file.write_text(text)
        image = file.with_suffix(".rsb")
        if comparison.call(comparison.RSC, "compile", file, "--config", drawn.CONFIG, "-o", image, "--anyway", "--strip").returncode != 0:
            return None
        dumped = comparison.call(comparison.RSC, "dump", image)
        self.assertEqual(dumped.returncode, 0, dumped.stderr)
        return re.sub(r"\bline \d+", "", dumped.stdout.partition("\n")[2])


class Comparison(unittest.TestCase):
    """A trace that is changed by one thing is another one."""

    def setUp(self):
        with tempfile.TemporaryDirectory() as folder:
            source, images = comparison.compile_levels(FINE, folder)
            (self.rsc, _), self.reference = comparison.traces(source, images, READINGS, folder)

    def test_both_levels_are_compared(self):
        self.assertEqual(comparison.options_of(comparison.RSC), comparison.LEVELS)

    def test_the_same(self):
        self.assertGreater(len(self.reference), 20)
        self.assertIsNone(comparison.first_difference(self.rsc, self.reference))

    def test_one_event_more_or_less(self):
        for at in range(len(self.reference)):
            less = self.reference[:at] + self.reference[at + 1:]
            self.assertIsNotNone(comparison.first_difference(self.rsc, less))

    def test_one_event_later(self):
        for at, line in enumerate(self.reference):
            event = json.loads(line)
            event["t_us"] += 1000
            other = [*self.reference[:at], json.dumps(event), *self.reference[at + 1:]]
            self.assertIsNotNone(comparison.first_difference(self.rsc, other))


if __name__ == "__main__":
    unittest.main()

"""The board, `rsc run` and the reference do the same with random programs (tests/properties/differ.py)."""

import os
import sys
import tempfile
import unittest
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parents[1] / "properties"))

import comparison  # noqa: E402
import differ  # noqa: E402
import drawn  # noqa: E402
from boards import Boards  # noqa: E402

PROGRAMS = int(os.environ.get("ROBOSYNC_REFERENCE_PROGRAMS", "24"))
MOST_REFUSED = 0.2  # of the programs, by the compiler or the board

LAMP = """\
WHEN touch LEVEL > 4
DO LIGHT lamp {}
END
WHEN touch LEVEL > 4
DO LIGHT lamp ON
END
"""
READINGS = [drawn.Reading(0, "touch.LEVEL", 2), drawn.Reading(100, "touch.LEVEL", 7)]


class Reference(unittest.TestCase):
    def setUp(self):
        self.boards = self.enterContext(Boards())

    def test_drawn_programs(self):
        total = differ.Result()
        for seed in range(PROGRAMS):
            result = differ.check(seed, scripts=1, board=self.boards)
            for case in result.cases:
                self.fail(differ.shown(case))
            total += result
        print(differ.said(total))
        self.assertGreaterEqual(total.played, (1 - MOST_REFUSED) * PROGRAMS)
        self.assertEqual(total.unsteady, 0)

    def test_another_program_is_noticed(self):
        with tempfile.TemporaryDirectory() as folder:
            wanted, same = self.traces("OFF", "OFF", folder)
            self.assertEqual(same, wanted)
            wanted, other = self.traces("OFF", "TO 50%", folder)
            self.assertIn('"actuator":"lamp"', comparison.first_other_line(wanted, other))

    def traces(self, told, played, folder):
        """The lines of rsc with one program, and the board's with another."""
        def image(word):
            return comparison.compile_program(LAMP.format(word), folder, "-O1")[1]

        for lead_ms in differ.LEADS_MS:
            readings = differ.delayed(READINGS, lead_ms)
            scenario, end_ms = comparison.write_scenario(readings, folder), comparison.end_of(readings)
            wanted = comparison.rsc_trace(image(told), scenario, end_ms)
            lines, why = self.boards.play(image(played), scenario, end_ms)
            if why != "late":
                break
        self.assertEqual(why, "whole")
        return wanted, lines


if __name__ == "__main__":
    unittest.main()

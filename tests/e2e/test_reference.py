"""The board does what `rsc run` does, for programs on which that does what the reference says.

tests/reference compares the same programs, with the same readings, with the interpreter that is
written from docs/language.md.
"""

import sys
import unittest
from pathlib import Path

from traces import TraceTest

sys.path.append(str(Path(__file__).resolve().parents[1] / "reference"))

import differ  # noqa: E402
import drawn  # noqa: E402

PROGRAMS = 4


class Reference(TraceTest):
    units = drawn.UNITS

    def test_drawn_programs(self):
        compared = seed = 0
        while compared < PROGRAMS:
            result = differ.check(seed, scripts=1)
            if result.compared and not result.ties:
                with self.subTest(seed=seed):
                    self.assertEqual(result.cases, ())
                    text = drawn.program(seed)
                    program = self.folder / f"reference{seed}.rsl"
                    program.write_text(text)
                    self.check(program, drawn.readings(seed, text), drawn.CONFIG)
                compared += 1
            seed += 1


if __name__ == "__main__":
    unittest.main()

"""The board does what `rsc run` does, for programs on which that does what the reference says.

tests/oracles/rsl compares the same programs, with the same readings, with the interpreter that is
written from docs/language.md. A board of its own for each: some of them never rest.
"""

import sys
import unittest
from pathlib import Path

from traces import TraceTest

sys.path.append(str(Path(__file__).resolve().parents[1] / "properties"))

import differ  # noqa: E402
import drawn  # noqa: E402


class Reference(TraceTest):
    units = drawn.UNITS

    def check_drawn(self, seed):
        result = differ.check(seed, scripts=1)
        self.assertEqual((result.ties, result.cases), (0, ()))
        self.assertGreater(result.compared, 0)
        text = drawn.program(seed)
        program = self.folder / f"reference{seed}.rsl"
        program.write_text(text)
        self.check(program, drawn.readings(seed, text), drawn.CONFIG)

    def test_commands_and_fading(self):
        self.check_drawn(2)

    def test_repeats_and_chance(self):
        self.check_drawn(9)

    def test_stale_sensors(self):
        self.check_drawn(19)

    def test_safety(self):
        self.check_drawn(21)


if __name__ == "__main__":
    unittest.main()

"""What does not declare its cost does not compile: a driver, a board. Compiles a small source over changed lists."""

import os
import subprocess
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
COMPILER = os.environ.get("CXX", "c++")
BOARDS = sorted(path.parent.name for path in (ROOT / "runtime-m4/boards").glob("*/board.cmake"))
SOURCE = """#include "runtime-m4/boards/costs.hpp"
static_assert(robosync::boards::kCosts.instructions_per_ms() > 0);
"""


class Declared(unittest.TestCase):
    def compiles(self, board, changed=None, costs=None):
        """With the files {path: text} of `changed` in the place of the repository's."""
        with tempfile.TemporaryDirectory() as folder:
            for path, text in (changed or {}).items():
                file = Path(folder) / path
                file.parent.mkdir(parents=True)
                file.write_text(text, "utf-8")
            source = Path(folder) / "source.cpp"
            source.write_text(SOURCE, "utf-8")
            listed = costs or f"runtime-m4/boards/{board}/costs.def"
            done = subprocess.run([COMPILER, "-std=gnu++20", "-fsyntax-only", f"-I{folder}", f"-I{ROOT}",
                                   f'-DROBOSYNC_BOARD_COSTS="{listed}"', str(source)],
                                  check=False, capture_output=True, text=True)
        return done.returncode == 0

    def test_every_board_declares_its_costs(self):
        self.assertTrue(BOARDS)
        for board in BOARDS:
            with self.subTest(board):
                self.assertTrue(self.compiles(board))

    def test_a_board_that_leaves_a_line_out(self):
        for board in BOARDS:
            path = f"runtime-m4/boards/{board}/costs.def"
            lines = (ROOT / path).read_text("utf-8").splitlines()
            declared = [line for line in lines if line.startswith("COST(")]
            for line in (declared[0], declared[-1]):
                with self.subTest(board, line=line):
                    short = "\n".join(other for other in lines if other != line)
                    self.assertFalse(self.compiles(board, {path: short}))

    def test_a_board_without_a_list(self):
        self.assertFalse(self.compiles("none", costs="runtime-m4/boards/none/costs.def"))

    def test_a_driver_without_its_cost(self):
        drivers = (ROOT / "vm/drivers.def").read_text("utf-8")
        added = {"a driver with its cost": ('SENSOR_DRIVER(lidar, i2c(3, 9), "new")', True),
                 "without": ('SENSOR_DRIVER(lidar, "new")', False),
                 "of nothing": ('SENSOR_DRIVER(lidar, i2c(0, 0), "new")', False),
                 "as if it were fed": ('SENSOR_DRIVER(lidar, fed(), "new")', False),
                 "on a bus that no board declares": ('SENSOR_DRIVER(lidar, radio(3), "new")', False),
                 "an actuator with its costs": ('ACTUATOR_DRIVER(lamp, 1, 2, 3, at_once, level, "new")', True),
                 "an actuator without": ('ACTUATOR_DRIVER(lamp, "new")', False),
                 "an actuator that does not say when it ends": ('ACTUATOR_DRIVER(lamp, 1, 2, 3, level, "new")', False)}
        for what, (line, good) in added.items():
            with self.subTest(what):
                self.assertEqual(self.compiles(BOARDS[0], {"vm/drivers.def": f"{drivers}{line}\n"}), good)


if __name__ == "__main__":
    unittest.main()

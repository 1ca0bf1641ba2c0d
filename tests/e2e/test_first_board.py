"""The self-test for owners of a board, on the emulated one: the part that needs no person."""

import subprocess
import sys
import unittest

from board import DEVICES, NAME, REAL_TIME, REFERENCE, Board
from first_board import on_board, port_of
from rsc import ROOT, RscError
from support import PROFILE

OTHER = "microbit-v2" if NAME == REFERENCE else REFERENCE
ROWS = 10 + sum(len(channels) for _, channels in on_board(NAME))
# The board's own parts without readings here: QEMU has no I2C of these boards.
SILENT = [name for name, wiring in PROFILE.get("on_board", {}).items() if "pin" not in wiring and NAME not in DEVICES]


def first_board(name, port):
    return subprocess.run([sys.executable, ROOT / "scripts/python/first_board.py", name, "--port", port, "--no-flash"],
                          check=False, text=True, stdout=subprocess.PIPE, stderr=subprocess.PIPE)


class FirstBoard(unittest.TestCase):
    def test_a_good_board_is_told_so(self):
        with Board(icount=REAL_TIME) as board:
            done = first_board(NAME, board.port)
        rows = [row for row in done.stdout.splitlines() if row.endswith((" ok |", " **NOT** |"))]
        wrong = [row for row in rows if row.endswith(" **NOT** |")]
        self.assertEqual((len(rows), done.stderr), (ROWS, ""), done.stdout)
        # The emulator's second is longer while this machine is busy.
        expected = ["its second", *(f"`{name} " for name in SILENT)]
        self.assertTrue(all(any(what in row for what in expected) for row in wrong), done.stdout)
        self.assertEqual(done.returncode, int(bool(wrong)))

    def test_another_board_is_not_what_it_should_be(self):
        with Board(icount=REAL_TIME) as board:
            done = first_board(OTHER, board.port)
        self.assertIn(f"| board | {OTHER} | {NAME} | **NOT** |", done.stdout)
        self.assertNotEqual(done.returncode, 0)

    def test_the_port_is_found(self):
        listed = [{"port": "/dev/ttyS0", "description": "", "board": None, "may_be": []},
                  {"port": "/dev/ttyACM1", "description": "", "board": OTHER, "may_be": [], "firmware": "0.1.0"},
                  {"port": "/dev/ttyACM0", "description": "", "board": NAME, "may_be": [], "firmware": "0.1.0"},
                  {"drive": "/media/MICROBIT", "board": NAME}]
        self.assertEqual(port_of(NAME, listed), "/dev/ttyACM0")
        for wrong in (listed[:2], listed + listed[2:3]):
            with self.assertRaisesRegex(RscError, "name it with --port"):
                port_of(NAME, wrong)

    def test_nobody_there(self):
        done = first_board(NAME, "unix:/nowhere")
        self.assertEqual((done.returncode, done.stdout), (3, ""))
        self.assertIn("first-board: rsc info ended with 3", done.stderr)


if __name__ == "__main__":
    unittest.main()

"""A program that uses all processor time, above the rank of the link's thread: rsc reaches the robot nevertheless.

`rsc` uploads such a program only with --anyway."""

import statistics
import unittest

import rsc
import wire
from board import REAL_TIME
from support import PROGRAMS, RobotTest

BUSY = """REMEMBER round = 0
EVERY 1ms
DO
  REPEAT 900 TIMES
    SET round TO (round * 3 + 1) MOD 1000
  END
END
"""

ANSWERS = 20
STEP_US = 1_500
# 10 ms, plus the time this machine takes to read an answer and ask again. Without the link's share there would never be an
# answer. The robot's time continues while this machine is busy, so half of the answers may take longer; `scripts/bench --only
# answer` counts the worst case in the robot's instructions.
PATIENCE_US = 40_000


class Crowded(RobotTest):
    icount = REAL_TIME  # the program is never idle

    def setUp(self):
        super().setUp()
        source = self.folder / "busy.rsl"
        source.write_text(BUSY)
        refused = rsc.call("check", source, "--config", self.for_board(PROGRAMS / "robot.json"))
        self.assertIn("error[E0412]", refused.stderr)
        image = self.compile(source)
        for refusal, *program in (("error[E0412]", source, "--config", self.for_board(PROGRAMS / "robot.json")),
                                  ("--anyway uploads it anyway", image)):
            refused = rsc.call("upload", *program, "--port", self.board.port)
            self.assertEqual(refused.returncode, 1, refused.stderr)
            self.assertIn(refusal, refused.stderr)
        self.assertEqual(self.status()["activations"], 0)
        self.upload(image, "--anyway")

    def test_it_answers_in_time_and_the_program_goes_on(self):
        with wire.Line(self.board.port) as line:
            line.hello()
            said = [line.status() for _ in range(1 + ANSWERS)]
        took = [after.uptime_us - before.uptime_us for before, after in zip(said, said[1:])]
        self.assertLessEqual(statistics.median(took), PATIENCE_US, took)
        # The link gets its share and no more: at least 19 of each 20 ms are the program's, whose steps take 1.5 ms on this board.
        passed, steps = said[-1].uptime_us - said[0].uptime_us, said[-1].steps - said[0].steps
        self.assertGreater(steps * STEP_US, passed * 0.8)
        self.assertEqual((said[-1].faults, said[-1].reset_reason), (0, 0))

    def test_another_program_takes_its_place(self):
        image = self.compile(PROGRAMS / "priorities.rsl")
        self.upload(image)
        self.assertIn(rsc.info(self.board.port)["board"]["program"]["hash"], rsc.run("dump", image))

    def test_it_stops(self):
        rsc.run("stop", "--port", self.board.port)
        self.assertIn("stopped", rsc.run("info", "--port", self.board.port))


if __name__ == "__main__":
    unittest.main()

"""rsc feed shows and records what the board does while readings are still being sent, and however it ends."""

import json
import signal
import unittest

from support import LineReader, RobotTest  # also makes the imports below work

import rsc
from board import REAL_TIME

# One reading every 60 ms for a minute: far more than the board's queue takes, so that rsc is still sending them.
STEPS = 1000
LEAD_MS = 3000  # for a busy machine
PROGRAM = """WHEN touch LEVEL > 5 DO LOG "touched" END
EVERY 1s DO LOG "tick" END
"""
ROBOT = {"sensors": [{"name": "touch", "type": "VIRTUAL", "channels": {"LEVEL": {"range": [0, 10]}}}], "actuators": []}
PATIENCE = 40


class Feed(RobotTest):
    icount = REAL_TIME  # otherwise the board is past the readings before rsc has sent them

    def setUp(self):
        super().setUp()
        self.recording = self.folder / "r.jsonl"
        robot, program, scenario = (self.folder / name for name in ("base.json", "robot.rsl", "visit.json"))
        robot.write_text(json.dumps(ROBOT))
        self.for_board(robot)
        program.write_text(PROGRAM)
        scenario.write_text(json.dumps({"stimuli": [
            {"at": f"{LEAD_MS + 60 * i}ms", "sensor": "touch", "value": 9 if i % 10 == 5 else 1} for i in range(STEPS)]}))
        self.arguments = ("feed", "--upload", program, "--fresh", "--scenario", scenario, "--watch", "1s", "--format", "json",
                          "--record", self.recording, "--port")
        self.start()

    def start(self):
        self.feed = LineReader(*self.arguments, self.board.port)
        self.addCleanup(self.feed.stop)

    def logs(self, lines):
        return sum('"event":"log"' in line for line in lines)

    def is_shown(self):
        """Several seconds of program time, on stdout and on disk."""
        shown = self.feed.wait_for(lambda lines: self.logs(lines) > 8 and
                                   self.logs(self.recording.read_text().splitlines()) > 8, PATIENCE)
        self.assertTrue(shown, shown or self.feed.stop())

    def replayed(self):
        done = rsc.call("replay", self.recording, "--format", "json")
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        one, = json.loads(done.stdout)["programs"]
        self.assertGreater(one["events"], 8)

    def ends_in_order(self, ending):
        self.is_shown()
        code, errors = self.feed.end(ending)
        self.assertEqual(code, 0, errors)
        self.assertRegex(errors, rf"note: ended after \d+ of {STEPS} readings")
        self.assertEqual(json.loads(self.recording.read_text().splitlines()[-1]), {"event": "whole"})
        self.replayed()

    def test_events_are_shown_while_readings_are_sent_and_ctrl_c_ends_it_in_order(self):
        self.ends_in_order(signal.SIGINT)

    def test_sigterm_ends_it_in_order(self):
        self.ends_in_order(signal.SIGTERM)

    def test_what_was_recorded_is_there_after_a_kill(self):
        self.is_shown()
        code, _ = self.feed.end(signal.SIGKILL)
        self.assertEqual(code, -signal.SIGKILL)
        self.replayed()

    def test_what_was_recorded_is_there_when_the_board_falls_silent(self):
        self.is_shown()
        self.board.stop()
        code, errors = self.feed.end(None)
        self.assertEqual(code, 3, errors)
        self.replayed()


if __name__ == "__main__":
    unittest.main()

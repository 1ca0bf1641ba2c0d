"""A real device: the MAX34451 on the emulated I2C bus, set over QMP, read by our driver, bit by bit."""

import json
import unittest

import rsc
from board import DEVICES, NAME
from support import LineReader, RobotTest, needs_i2c

EXAMPLE = rsc.ROOT / "examples/touch_companion/robot.rsl"
PATIENCE = 20


def events(lines, **wanted):
    """The events of a trace that have all of the wanted values."""
    found = (json.loads(line) for line in lines)
    return [e for e in found if all(e.get(key) == value for key, value in wanted.items())]


class Touch(RobotTest):
    def setUp(self):
        super().setUp()
        if NAME in DEVICES:
            self.board.set_touch(0)
        self.upload(EXAMPLE, "--config", self.for_board(EXAMPLE.with_name("robot.json")))

    def monitor(self):
        """rsc monitor, once it listens: until it shows a reading, the touch alternates below the threshold."""
        reader = LineReader("monitor", "--port", self.board.port, "--format", "json")
        for value in [1, 2] * 100:
            self.board.set_touch(value)
            if reader.wait_for(lambda lines: events(lines, event="input"), 0.2):
                break
        self.board.set_touch(0)
        self.expect(reader, event="input", value=0)
        return reader

    def expect(self, reader, **wanted):
        came = reader.wait_for(lambda lines: events(lines, **wanted), PATIENCE)
        self.assertTrue(came, f"no {wanted} in {reader.lines}")

    @needs_i2c
    def test_the_right_response_runs(self):
        reader = self.monitor()
        try:
            self.board.set_touch(1)
            self.expect(reader, event="input", sensor="touch", value=1)
            self.board.set_touch(3)
            self.expect(reader, event="fire", side="ELSE")
            self.expect(reader, event="command", verb="PLAY", word="warning.wav")
            self.expect(reader, event="command", verb="MOVE", word="QUICKLY")
            self.board.set_touch(2)
            self.expect(reader, event="fire", side="DO")
            self.expect(reader, event="command", verb="PLAY", word="greeting.wav")
            self.expect(reader, event="command", verb="MOVE", word="SLOWLY")
        finally:
            reader.stop()
        self.assertEqual(len(events(reader.lines, event="fire")), 2)

    @needs_i2c
    def test_all_readings_arrive(self):
        reader = self.monitor()
        try:
            for value in (5, 4, 3, 2, 1, 0, 9):
                self.board.set_touch(value)
                self.expect(reader, event="input", value=value)
        finally:
            reader.stop()

    def test_a_sensor_of_the_board_cannot_be_fed(self):
        done = rsc.call("feed", "touch.LEVEL=2", "--port", self.board.port)
        self.assertEqual(done.returncode, 1)
        self.assertIn("measured by the board", done.stderr)


if __name__ == "__main__":
    unittest.main()

"""A sensor's stack has room for an interrupt at the deepest point of its driver.

How often an interrupt comes exactly there is random, so a board that runs well for minutes proves nothing. Here the debugger
measures the stack at that point, and the bytes pushed by the core and the context switch are added.
If the stack is far too small, the sensor's thread is stopped while the debugger waits for it, which times out.
"""

import sys
import unittest
from pathlib import Path

import rsc
from board import FIRMWARE
from debugger import DebuggedTest
from stack_depth import FRAMES
from support import needs_i2c

sys.path.append(str(Path(__file__).resolve().parents[2] / "bench"))
from counting import symbols  # noqa: E402

SP = 13
FIND = "robosync::boards::BusRequests::find("  # where a driver asks for its transfers, and collects them
TIMES = 20  # enough for several samples
PAINT = 0xA5A5A5A5
UNTOUCHED = 3  # this many painted words in a row count as never used
CONFIG = """{
  "sensors": [{"name": "touch", "type": "I2C", "bus": 0, "address": "0x70", "device": "max34451",
               "channels": {"LEVEL": {"input": 0, "range": [0, 10], "rate": "50Hz"}}}],
  "actuators": [{"name": "lamp", "type": "VIRTUAL"}]
}"""
PROGRAM = """
WHEN touch LEVEL > 3
DO LOG "touched"
END
"""


@needs_i2c
class Stacks(DebuggedTest):
    def setUp(self):
        super().setUp()
        (self.folder / "robot.json").write_text(CONFIG)
        (self.folder / "robot.rsl").write_text(PROGRAM)
        rsc.run("upload", self.folder / "robot.rsl", "--port", self.board.port)

    def sensor(self):
        return next(thread for thread in rsc.info(self.board.port)["threads"] if thread["name"] == "touch")

    def lowest_used(self, deepest, size):
        """The lowest word of the stack that was ever written."""
        with self.debugger() as debugger:
            words = debugger.read_words(deepest - size, size // 4)
        for i in range(len(words), UNTOUCHED - 1, -1):
            if words[i - UNTOUCHED:i] == [PAINT] * UNTOUCHED:
                return deepest - size + 4 * i
        return self.fail("nothing of the stack is left")

    def test_a_sensor_may_be_interrupted_anywhere(self):
        with self.debugger() as debugger:
            deepest = min(debugger.register_at(next(at for name, at in symbols(FIRMWARE).items() if name.startswith(FIND)), SP, TIMES))
        thread = self.sensor()
        bottom = self.lowest_used(deepest, thread["stack_bytes"]) + thread["stack_used"] - thread["stack_bytes"]
        self.assertEqual(thread["stack_used"], self.sensor()["stack_used"], "it grew meanwhile")
        self.assertGreaterEqual(deepest - FRAMES, bottom)


if __name__ == "__main__":
    unittest.main()

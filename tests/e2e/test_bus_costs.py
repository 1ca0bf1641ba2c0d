"""What the reference board's I2C bus costs the processor, whose interrupts drive the lines bit by bit: a sample, and at a stretch."""

import json
import re
import sys
import unittest
from pathlib import Path

import rsc
from board import FIRMWARE, NAME, ROOT
from debugger import PC, DebuggedTest
from support import needs_i2c

sys.path.append(str(Path(__file__).resolve().parents[2] / "bench"))
from counting import symbols  # noqa: E402

CONFIG = {"board": NAME, "actuators": [{"name": "lamp", "type": "VIRTUAL"}],
          "sensors": [{"name": "touch", "type": "I2C", "address": "0x70", "device": "max34451",
                       "channels": {"LEVEL": {"input": 0, "range": [0, 10], "rate": "50Hz"}}}]}
PROGRAM = 'WHEN touch LEVEL > 3\nDO LOG "touched"\nEND\n'
TRANSFERS, BYTES = 2, 8  # of a sample (vm/drivers.def)
# Rises of the clock: a page is selected, and a word is read.
BITS = (3 * 9 + 1) + (2 * 9 + 1 + 3 * 9 + 1)
SAMPLES = 3
LOOSEST = 1.5
INTERRUPT, DRIVER = "Timer0_Handler", "robosync::drivers::max34451::read("


def declared():
    costs = (ROOT / f"runtime-m4/boards/{NAME}/costs.def").read_text()
    return {name: int(value.replace("'", "")) for name, value in re.findall(r"^COST\((\w+),\s*([\d']+),", costs, re.M)}


@needs_i2c
class BusCosts(DebuggedTest):
    def setUp(self):
        super().setUp()
        (self.folder / "robot.json").write_text(json.dumps(CONFIG))
        (self.folder / "robot.rsl").write_text(PROGRAM)
        rsc.run("upload", self.folder / "robot.rsl", "--port", self.board.port)
        self.at = {start: next(at for name, at in symbols(FIRMWARE).items() if name.startswith(start))
                   for start in (INTERRUPT, DRIVER)}

    def call(self, debugger):
        """The instructions of the driver's next call."""
        debugger.run_to(self.at[DRIVER], lambda: None)
        return debugger.steps_to_return()

    def bit(self, debugger):
        """… of the next interrupt, up to its end; or until another follows at once."""
        debugger.run_to(self.at[INTERRUPT], lambda: None)
        mode, steps = debugger.mode(), 0
        while steps == 0 or (debugger.register(PC) != self.at[INTERRUPT] and debugger.mode() == mode):
            debugger.step()
            steps += 1
        return steps

    def test_what_a_sample_costs(self):
        asked, taken, bits = [], [], []
        with self.debugger() as debugger:
            debugger.register_at(self.at[INTERRUPT], 0, 2 * BITS)  # the first sample, whose requests are new
            self.call(debugger)
            for _ in range(SAMPLES):
                asked.append(self.call(debugger))
                bits.append([self.bit(debugger) for _ in range(BITS)])
                taken.append(self.call(debugger))
        costs = declared()
        self.longest_hold = max(map(max, bits))
        self.most_of_a_sample = max(map(sum, zip(asked, map(sum, bits), taken)))
        for what, said, measured in (
                ("asking, with the interrupts", TRANSFERS * costs["i2c_ask"] + BYTES * costs["i2c_ask_byte"],
                 max(asked) + max(map(sum, bits))),
                ("taking", TRANSFERS * costs["i2c_transfer"] + BYTES * costs["i2c_byte"], max(taken))):
            print(f"\n  {what}: {measured}, said {said}")
            self.assertGreaterEqual(said, measured)
        self.assertLessEqual(TRANSFERS * costs["i2c_ask"] + BYTES * costs["i2c_ask_byte"], LOOSEST * max(map(sum, bits)))
        print(f"\n  the longest interrupt: {self.longest_hold}")
        self.assertEqual((self.status()["safety_late_us"], self.status()["faults"]), (0, 0))


if __name__ == "__main__":
    unittest.main()

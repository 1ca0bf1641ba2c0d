"""A part on the emulated SPI bus of the reference board, a MAX1111, read by our driver for registers; and its select pin."""

import json
import sys
import unittest
from pathlib import Path

import pins
from board import FIRMWARE
from debugger import DebuggedTest
from support import PROFILE, LineReader

sys.path.append(str(Path(__file__).resolve().parents[2] / "bench"))
from counting import symbols  # noqa: E402

FIRST_ENABLE, SELECT, WORD = 36, 37, 4
LOW, HIGH = 0, 1
# The control bytes of its inputs 0 and 1: start, input, single, unipolar, powered. The result comes six bits to the left.
ROBOT = {"sensors": [{"name": "light", "type": "SPI", "bus": 0, "pin": SELECT, "channels": {
    "LEFT": {"input": "0x8f"}, "RIGHT": {"input": "0xcf"}}}]}
INPUTS, SHIFT = ("LEFT", "RIGHT"), 6
AT_START = (0x5A, 0xC3)
PROGRAM = """
WHEN light LEFT > 1000 DO LOG "left" END
WHEN light RIGHT > 1000 DO LOG "right" END
"""
PATIENCE = 20


@unittest.skipUnless(PROFILE["name"] == "mps2-an386", "QEMU has this part only there")
class OnSpi(DebuggedTest):
    def setUp(self):
        super().setUp()
        (self.folder / "robot.json").write_text(json.dumps(ROBOT))
        self.program = self.folder / "robot.rsl"
        self.program.write_text(PROGRAM)
        self.wires = pins.Pins(self.folder)
        self.addCleanup(self.wires.close)

    def qemu_arguments(self):
        return [*pins.arguments(self.folder), "-device", "max1111,id=light,input0={},input1={}".format(*AT_START),
                *super().qemu_arguments()]

    def level(self):
        return self.wires.word(symbols(FIRMWARE)["robosync_virtual_enables"] + WORD * (SELECT - FIRST_ENABLE))

    def expect(self, reader, place, counts):
        wanted = {"event": "input", "sensor": "light", "channel": INPUTS[place], "value": counts << SHIFT}
        self.assertTrue(reader.wait_for(lambda lines: any(wanted.items() <= json.loads(line).items() for line in lines),
                                        PATIENCE), (wanted, reader.lines[-8:]))

    def test_each_register_of_the_part_arrives(self):
        reader = LineReader("monitor", "--port", self.board.port, "--format", "json", "--upload", self.program)
        try:
            for place, counts in enumerate(AT_START):
                self.expect(reader, place, counts)
            for place, counts in ((0, 0xFF), (1, 0x01), (0, 0x00)):
                self.wires.set_line("/machine/peripheral/light", place, counts)
                self.expect(reader, place, counts)
        finally:
            reader.stop()

    def test_the_part_is_selected_during_each_transfer_only(self):
        self.status()
        self.assertEqual(self.level(), HIGH)
        self.upload(self.program)
        at = symbols(FIRMWARE)["robosync_virtual_enables"] + WORD * (SELECT - FIRST_ENABLE)
        with self.debugger() as debugger:
            self.assertEqual(debugger.written(at, 4, self.level), [LOW, HIGH] * 2)


if __name__ == "__main__":
    unittest.main()

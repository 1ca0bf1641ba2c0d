"""Tests what the shipped firmware of the micro:bit V2 writes to its SPI master for parts, which QEMU does not have: QEMU logs it.
Run with ROBOSYNC_BOARD=microbit-v2."""

import json
import re
import sys
import unittest
from pathlib import Path

import pins
import rsc
from debugger import DebuggedTest
from support import LineReader

sys.path.append(str(Path(__file__).resolve().parents[2] / "bench"))
from board import FIRMWARE, ROOT  # noqa: E402
from counting import symbols  # noqa: E402

PATIENCE = 20
WRITE = re.compile(r"device write \(size 4, offset 0x([0-9a-f]+), value 0x([0-9a-f]+)\)")
PERIPHERALS = 0x4000_0000
COSTS = ROOT / "runtime-m4/boards/microbit-v2/costs.def"
# A part on SPI at 13 to 15, its select pin 16: FREQUENCY, RXD.PTR, RXD.MAXCNT, TXD.PTR and TXD.MAXCNT of SPIM3.
SPIM3 = 0x4002_F000
KNOB = {"sensors": [{"name": "knob", "device": "mcp3008", "pin": 16, "channels": {"LEVEL": {"input": 5}}}], "actuators": []}
TURNED_UP = 'WHEN knob LEVEL > 50% DO LOG "up" END\n'
SPI_ENABLE, SPI_CLOCK, SPI_OUT, SPI_IN, SPI_SPEED, SPI_TO, SPI_READS, SPI_FROM, SPI_SENDS = (
    SPIM3 + at for at in (0x500, 0x508, 0x50C, 0x510, 0x524, 0x534, 0x538, 0x544, 0x548))
P0_17, P0_13, P0_01, AT_1MHZ, READ_5, SPI_ON = 17, 13, 1, 0x1000_0000, 0x3A, 7
PLAYER_ENABLE, PLAYER_ON = 0x4002_8500, 8
COST_OF_SPI = re.compile(r"^COST\((spi_\w+),\s*(\d+),", re.M)
ARM = {"actuators": [{"name": "arm", "type": "PWM", "pin": 13, "device": "servo"}]}


class Spi(DebuggedTest):
    def qemu_arguments(self):
        return ["-d", "unimp", "-D", str(self.folder / "told"), *pins.arguments(self.folder), *super().qemu_arguments()]

    def told(self, address):
        """The values that have been written to that address."""
        writes = WRITE.findall((self.folder / "told").read_text())
        return [int(value, 16) for at, value in writes if int(at, 16) + PERIPHERALS == address]

    def begin(self, robot=None, text=TURNED_UP):
        program, config = self.folder / "spi.rsl", self.folder / "spi.json"
        config.write_text(json.dumps({"board": "microbit-v2", **(robot or KNOB)}))
        program.write_text(text)
        return program, "--config", config

    def test_a_transfer_on_spi_that_does_not_end_is_told_and_holds_nobody_up(self):
        reader = LineReader("monitor", "--port", self.board.port, "--format", "json", "--upload", *self.begin())
        try:
            silent = {"event": "silent", "sensor": "knob", "bus": 0, "pin": 16}
            self.assertTrue(reader.wait_for(lambda lines: any(silent.items() <= json.loads(line).items() for line in lines), PATIENCE))
        finally:
            reader.stop()
        self.assertEqual([set(self.told(at)) for at in (SPI_CLOCK, SPI_OUT, SPI_IN, SPI_SPEED, SPI_READS, SPI_SENDS)],
                         [{P0_17}, {P0_13}, {P0_01}, {AT_1MHZ}, {3}, {3}])
        self.assertEqual((self.told(SPI_ENABLE)[0], self.told(PLAYER_ENABLE)), (SPI_ON, [PLAYER_ON, 0]))
        said = rsc.info(self.board.port)
        self.assertEqual((said["status"]["safety_late_us"], said["status"]["faults"]), (0, 0))
        [knob] = said["buses"]["devices"]
        self.assertEqual((knob["driver"], knob["pin"], knob["answers"], knob["failed"] > 0), ("mcp3008", 16, False, True))
        self.upload(*self.begin(ARM, "AT START DO MOVE arm TO 50deg END\n"))
        self.assertEqual((self.told(SPI_ENABLE)[-1], self.told(PLAYER_ENABLE)), (0, [PLAYER_ON, 0, PLAYER_ON]))

    def test_what_a_transfer_on_spi_is_told_and_costs(self):
        """QEMU has no interrupt for it: that costs what tests/e2e/on_l475.py counts."""
        self.upload(*self.begin())
        wires = pins.Pins(self.folder)
        self.addCleanup(wires.close)
        driver = next(at for name, at in symbols(FIRMWARE).items() if name.startswith("robosync::drivers::mcp3008::read("))
        asked, taken = [], []
        with self.debugger() as debugger:
            for _ in range(8):
                debugger.run_to(driver, lambda: None)
                before = len(self.told(SPI_SENDS))
                count = debugger.steps_to_return()
                (asked if len(self.told(SPI_SENDS)) > before else taken).append(count)
        self.assertEqual(wires.read(self.told(SPI_FROM)[-1], 3), bytes((READ_5, 0, 0)))
        declared = {name: int(value) for name, value in COST_OF_SPI.findall(COSTS.read_text())}
        print(f"\n  asked {asked}, given up {taken}, said {declared}")
        self.assertGreaterEqual(declared["spi_ask"], max(asked))
        self.assertGreaterEqual(declared["spi_transfer"], max(taken))


if __name__ == "__main__":
    unittest.main()

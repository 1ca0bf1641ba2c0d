"""Devices on the I2C bus that do not answer, fall silent and come back, or hold the bus: what `rsc upload`, `rsc info` and
`rsc monitor` report, and that the board keeps running. The touch sensor is the emulated MAX34451; there is no device at 0x33."""

import json
import sys
import unittest
from pathlib import Path

import rsc
from debugger import DebuggedTest
from support import LineReader, needs_i2c

sys.path.append(str(Path(__file__).resolve().parents[2] / "bench"))
from board import FIRMWARE, NAME  # noqa: E402
from counting import symbols  # noqa: E402

PATIENCE = 20
PC, LR = 15, 14
ROUNDS = 3  # until a device counts as silent, or as answering again (runtime-m4/layers/contact.hpp)
# Rises of the clock in a sample, up to the second bit that the device sends; its bits are zeros. Two bytes that select the page,
# behind the address, and a stop; a register, a start, and the address again.
TO_DATA = 3 * 9 + 1 + 2 * 9 + 1 + 9 + 2
TOUCH = {"name": "touch", "type": "I2C", "bus": 0, "address": "0x70", "device": "max34451",
         "channels": {"LEVEL": {"input": 0, "range": [0, 10], "rate": "20Hz", "stale_after": "500ms"}}}
GHOST = {"name": "ghost", "type": "I2C", "bus": 0, "address": "0x33", "device": "i2c_register",
         "channels": {"WORD": {"input": 1, "range": [0, 10], "rate": "20Hz", "stale_after": "500ms"}}}
ARM = {"name": "arm", "type": "VIRTUAL", "device": "virtual_actuator"}
RULE = "WHEN {} > 5 DO\n  MOVE arm\nEND\n"


@needs_i2c
class Bus(DebuggedTest):
    def setUp(self):
        super().setUp()
        self.board.set_touch(0)
        self.at = {name: address for name, address in symbols(FIRMWARE).items() if "AskedBus<" in name or "Timer0" in name}

    def begin(self, *sensors):
        """Uploads a program that reads the first channel of each; returns the finished rsc."""
        (self.folder / "robot.json").write_text(json.dumps({"board": NAME, "sensors": sensors, "actuators": [ARM]}))
        names = [f"{sensor['name']} {next(iter(sensor['channels']))}" for sensor in sensors]
        (self.folder / "robot.rsl").write_text("".join(map(RULE.format, names)))
        return rsc.call("upload", self.folder / "robot.rsl", "--port", self.board.port)

    def place(self, start):
        return next(at for name, at in self.at.items() if name.startswith(start))

    def buses(self):
        return rsc.info(self.board.port)["buses"]

    def fail_transfers(self, times):
        """Makes transfers fail as if no device acknowledged."""
        with self.debugger() as debugger:
            transfer = self.place("robosync::boards::AskedBus<robosync::boards::mps2::LineMaster>::collect(")
            for _ in range(times):
                debugger.run_to(transfer, lambda: None)
                back = debugger.register(LR)
                debugger.set_register(0, 0)
                debugger.set_register(PC, back & ~1)

    def test_a_device_that_is_not_there_is_told(self):
        done = self.begin(TOUCH, GHOST)
        self.assertEqual(done.returncode, 0, done.stderr)
        warnings = [line for line in done.stderr.splitlines() if line.startswith("warning: ")]
        self.assertEqual(len(warnings), 1, done.stderr)
        self.assertRegex(warnings[0], r"^warning: ghost at address 0x33 on i2c bus 0 does not answer \(\d+ transfers? failed\): "
                                      r"does it have power, are both wires of the bus connected, is this its address\?$")
        found = {device["sensor"]: device for device in self.buses()["devices"]}
        self.assertEqual((found["touch"]["answers"], found["touch"]["failed"]), (True, 0))
        self.assertEqual((found["ghost"]["answers"], found["ghost"]["bus"], found["ghost"]["address"]), (False, 0, "0x33"))
        self.assertGreater(found["ghost"]["failed"], 0)
        said = rsc.run("info", "--port", self.board.port)
        self.assertRegex(said, r"(?m)^buses     2 sensors, \d+ failed transfers, 0 bus clears$")
        self.assertRegex(said, r"(?m)^silent    ghost at address 0x33 on i2c bus 0 does not answer")
        self.assertRegex(said, r"(?m)^found     touch \(max34451\) at address 0x70 on i2c bus 0 answers$")
        self.assertNotIn("found     ghost", said)
        said = rsc.run("monitor", "--port", self.board.port, "--duration", "300ms")
        self.assertRegex(said, r"(?m)^ +silent  ghost at address 0x33")
        self.assertEqual(said.count("does not answer"), 1, said)  # in the first report only: the event itself is in the past
        self.assertEqual(self.status()["faults"], 0)

    def test_all_that_answer_are_no_matter(self):
        done = self.begin(TOUCH)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertEqual(self.buses(), {"clears": 0, "devices": [
            {"sensor": "touch", "driver": "max34451", "bus": 0, "address": "0x70", "answers": True, "bus_held": False, "failed": 0}]})
        said = rsc.run("info", "--port", self.board.port)
        self.assertNotIn("silent", said)
        self.assertRegex(said, r"(?m)^found     touch \(max34451\) at address 0x70 on i2c bus 0 answers$")

    def test_one_that_falls_silent_and_comes_back_is_told_of_once_each(self):
        self.begin(TOUCH)
        reader = LineReader("monitor", "--port", self.board.port, "--format", "json")
        try:
            self.assertTrue(reader.wait_for(lambda lines: lines, PATIENCE))
            self.fail_transfers(3 * ROUNDS)
            self.assertTrue(reader.wait_for(lambda lines: '"answers"' in "".join(lines[1:]), PATIENCE), reader.lines)
        finally:
            reader.stop()
        told = [json.loads(line) for line in reader.lines[1:]]
        told = [event for event in told if event["event"] in ("silent", "answers")]
        self.assertEqual([event["event"] for event in told], ["silent", "answers"])
        self.assertEqual([event["failed"] for event in told], [ROUNDS, 3 * ROUNDS])
        self.assertEqual({(event["sensor"], event["bus"], event["address"]) for event in told}, {("touch", 0, "0x70")})
        device = self.buses()["devices"][0]
        self.assertEqual((device["answers"], device["failed"]), (True, 3 * ROUNDS))
        self.assertIn(f"i2c bus 0 answers; {3 * ROUNDS} transfers failed\n", rsc.run("info", "--port", self.board.port))

    def test_a_device_that_was_interrupted_in_a_byte_gets_its_clocks(self):
        """The board is reset while the device sends a zero: the device holds the data line low until it gets more clocks."""
        self.begin(TOUCH)
        with self.debugger() as debugger:
            debugger.run_to(self.place("robosync::boards::AskedBus<robosync::boards::mps2::LineMaster>::ask("), lambda: None)
            debugger.register_at(self.place("Timer0_Handler"), PC, TO_DATA)
            self.board.qmp.command("system_reset")
        done = self.begin(TOUCH)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        buses = self.buses()
        self.assertEqual(buses["clears"], 1)
        self.assertTrue(buses["devices"][0]["answers"])


if __name__ == "__main__":
    unittest.main()

"""Servos on a PCA9685, on the shipped firmware. No emulator has that chip. At 0x40 there is no device: the firmware reports that,
the outputs stay off, and everything else continues. At 0x41 there is a thermometer of 32 degrees: it acknowledges every write, and
its register 0 reads like that of a running PCA9685. It gives no pulses, but the firmware's use of the enable pin is real."""

import json
import sys
import time
import unittest
from pathlib import Path

import pins
import rsc
from board import FIRMWARE, NAME
from debugger import IN_SAFETY, PC, DebuggedTest, endless_loop
from support import LineReader, needs_i2c

sys.path.append(str(Path(__file__).resolve().parents[2] / "bench"))
from counting import symbols  # noqa: E402

PATIENCE = 20
ON, OFF = 0, 1  # levels at OE
FIRST_ENABLE, WORD = 36, 4
NOBODY, STAND_IN = 36, 37  # the chips' enable pins
WHILE_NOTHING_MOVES = 1.0  # seconds
ADDRESS = {NOBODY: 0x40, STAND_IN: 0x41}
RUNS, ASLEEP = 32_000, 17_000  # thousandths of a degree: MODE1 would be 0x20, 0x11
PROGRAM = """
WHEN near X > 10 DO MOVE arm TO 90deg AT 90deg/s END
EVERY 100ms DO LOG "goes on" END
"""
BY_ITSELF = PROGRAM.replace("WHEN near X > 10 DO", "AT START DO")
WITHOUT_ARM = 'EVERY 100ms DO LOG "no arm" END\n'


@needs_i2c
class ServoChip(DebuggedTest):
    def setUp(self):
        super().setUp()
        self.wires = pins.Pins(self.folder)
        self.addCleanup(self.wires.close)
        self.heat(RUNS)
        self.levels_at = symbols(FIRMWARE)["robosync_virtual_enables"]

    def qemu_arguments(self):
        stand_in = f"tmp105,id=chip,address={ADDRESS[STAND_IN]:#x}"
        return [*pins.arguments(self.folder), "-device", stand_in, *super().qemu_arguments()]

    def level(self, pin):
        return self.wires.word(self.levels_at + WORD * (pin - FIRST_ENABLE))

    def await_level(self, pin, level):
        give_up = time.monotonic() + PATIENCE
        while self.level(pin) != level:
            self.assertLess(time.monotonic(), give_up, f"pin {pin} never came to {level}")

    def stays_off(self, pin):
        until = time.monotonic() + WHILE_NOTHING_MOVES
        while time.monotonic() < until:
            self.assertEqual(self.level(pin), OFF)

    def written(self, pin, program=PROGRAM):
        arm = {"name": "arm", "type": "I2C", "address": hex(ADDRESS[pin]), "channel": 3, "enable": pin, "device": "pca9685_servo"}
        near = {"name": "near", "type": "VIRTUAL", "channels": {"X": {"range": [0, 100]}}}
        (self.folder / "robot.json").write_text(json.dumps({"board": NAME, "sensors": [near], "actuators": [arm]}))
        (self.folder / "robot.rsl").write_text(program)
        return self.folder / "robot.rsl"

    def say(self, verb, *arguments):
        return rsc.call(verb, *arguments, "--port", self.board.port)

    def order(self):
        for value in (0, 20):
            rsc.run("feed", f"near.X={value}", "--port", self.board.port)

    def move(self):
        """Makes the arm move, and waits until it is there: a trigger is ignored while its response is running."""
        reader = LineReader("feed", "near.X=0", "near.X=20", "--watch", f"{PATIENCE}s", "--port", self.board.port)
        self.assertTrue(reader.wait_for(lambda lines: "arm is done" in "".join(lines), PATIENCE), reader.lines)
        reader.stop()

    def begin(self):
        """Uploads the program and makes the arm move."""
        done = self.say("upload", self.written(STAND_IN))
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertNotIn("does not answer", done.stderr)
        self.assertEqual(self.level(STAND_IN), OFF)
        self.move()
        self.await_level(STAND_IN, ON)
        self.assertEqual(self.level(NOBODY), OFF)

    def test_one_that_is_not_there_is_told_and_the_program_goes_on_without_it(self):
        reader = LineReader("monitor", "--port", self.board.port, "--format", "json", "--upload", self.written(NOBODY, BY_ITSELF))
        self.assertTrue(reader.wait_for(lambda lines: "".join(lines).count("goes on") > 30, PATIENCE), reader.lines)
        reader.stop()
        events = [json.loads(line) for line in reader.lines]
        silent = [event for event in events if event["event"] == "silent"]
        self.assertEqual([(event["sensor"], event["bus"], event["address"]) for event in silent], [("pca9685", 0, "0x40")])
        self.assertIn("arm", [event.get("actuator") for event in events if event["event"] == "command"], events)
        said = rsc.run("info", "--port", self.board.port)
        self.assertRegex(said, r"(?m)^silent    pca9685 at address 0x40 on i2c bus 0 does not answer")
        self.assertEqual(self.level(NOBODY), OFF)
        self.assertEqual(self.status()["faults"], 0)
        done = self.say("upload", self.written(NOBODY))
        self.assertEqual(done.returncode, 0)
        self.assertRegex(done.stderr, r"(?m)^warning: pca9685 at address 0x40 on i2c bus 0 does not answer")

    def test_it_is_on_only_while_somebody_may_move_it(self):
        self.begin()
        self.say("stop")
        self.await_level(STAND_IN, OFF)
        self.order()
        self.stays_off(STAND_IN)
        self.say("resume")
        self.stays_off(STAND_IN)
        self.move()
        self.await_level(STAND_IN, ON)
        self.say("upload", self.written(STAND_IN, WITHOUT_ARM))
        self.await_level(STAND_IN, OFF)
        self.stays_off(STAND_IN)

    def test_a_chip_that_has_lost_its_power_is_off_until_the_next_order(self):
        self.begin()
        self.heat(ASLEEP)
        self.await_level(STAND_IN, OFF)
        self.heat(RUNS)
        self.stays_off(STAND_IN)
        self.move()
        self.await_level(STAND_IN, ON)

    def heat(self, temperature):
        self.board.qmp.command("qom-set", path="/machine/peripheral/chip", property="temperature", value=temperature)

    def test_a_safety_thread_that_hangs_takes_its_outputs_away(self):
        self.begin()
        known = symbols(FIRMWARE)
        after = next(at for name, at in known.items() if "keep_watchdog_reset" in name)
        with self.debugger() as debugger:
            debugger.run_to(known[IN_SAFETY], lambda: None)
            debugger.set_register(PC, endless_loop())
            self.assertEqual(self.level(STAND_IN), ON)
            debugger.run_to(after, lambda: None)  # in the watchdog's NMI
            self.assertEqual(self.level(STAND_IN), OFF)
        self.stays_off(STAND_IN)


if __name__ == "__main__":
    unittest.main()

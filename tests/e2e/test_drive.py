"""A differential drive on the shipped firmware: the power of its four pins and the times of its commands, and what halts it."""

import json
import sys
import time
import unittest
from collections import namedtuple
from pathlib import Path

import outputs
import rsc
from board import NAME
from debugger import DebuggedTest
from support import AT_WILL, STOPS_WHEN_FAR, LineReader
from traces import TraceTest

sys.path.append(str(Path(__file__).resolve().parents[2] / "bench"))
from counting import functions  # noqa: E402

Reading = namedtuple("Reading", "at_ms channel value")
PATIENCE = 30
PINS = LEFT, LEFT_BACK, RIGHT, RIGHT_BACK = AT_WILL[:4]
DRIVE_WHEELS = "robosync::guard::OutputGuard::drive_wheels("  # (this, actuator, left, right, now)
STACK, LEFT_PULSE, RIGHT_PULSE = 13, 2, 3  # registers at its first instruction
QUARTER, HALF = 5_000, 10_000  # us of 20 ms
TURN_US = 471_200  # pi * 12 cm / 4 at 20 cm/s
LATE_US = 1_500  # a thread wakes in the tick after its time
CONFIG = {
    "board": NAME,
    "sensors": [{"name": "near", "type": "VIRTUAL", "channels": {"X": {"range": [0, 100]}}}],
    "actuators": [{"name": "base", "type": "PWM", "device": "differential_drive", "left": PINS[:2], "right": PINS[2:],
                   "speed": "40cm/s", "track": "12cm"}]}
PROGRAM = STOPS_WHEN_FAR + """
WHEN near X > 10
DO
  DRIVE base FORWARD 20cm AT 10cm/s
  TURN base LEFT 90deg
END
"""
# Long enough for somebody who looks now and then.
FOR_LONG = STOPS_WHEN_FAR + """
WHEN near X > 50
DO SPIN base LEFT FOR 80s
END
WHEN near X > 10
DO DRIVE base FORWARD 8m AT 10cm/s
END
"""
WITHOUT_WHEELS = "WHEN near X > 10 DO LOG \"nothing\" END\n"


def signed(word):
    return word - (1 << 32) if word >> 31 else word


class Drive(TraceTest, DebuggedTest):
    units = {"near.X": ""}

    def setUp(self):
        super().setUp()
        (self.folder / "robot.json").write_text(json.dumps(CONFIG))
        self.outputs = outputs.Outputs(self.board, self.folder)
        self.pulses = self.outputs.pulses

    def qemu_arguments(self):
        return [*outputs.arguments(self.folder), *super().qemu_arguments()]

    def written(self, program=PROGRAM):
        (self.folder / "robot.rsl").write_text(program)
        return self.folder / "robot.rsl"

    def say(self, verb, *arguments):
        return rsc.run(verb, *arguments, "--port", self.board.port)

    def feed(self, *values):
        for value in values:
            self.say("feed", f"near.X={value}")

    def await_pulses(self, pulses):
        give_up = time.monotonic() + PATIENCE
        while self.pulses() != pulses:
            self.assertLess(time.monotonic(), give_up, f"{self.pulses()}, but never {pulses}")

    def begin(self):
        self.say("upload", self.written(FOR_LONG))
        self.feed(0, 20)
        self.await_pulses({LEFT: QUARTER, RIGHT: QUARTER})

    def calls(self, count):
        """[(time in us, left, right, pulses of the pins after that)] of the guard's next calls, from the first that gives power; then
        the board runs on."""
        found = []
        address = functions(DRIVE_WHEELS)[DRIVE_WHEELS]
        feeder = None

        def start():
            nonlocal feeder
            feeder = feeder or LineReader("feed", "near.X=0", "near.X=20", "--watch", f"{PATIENCE}s", "--port", self.board.port)

        with self.debugger() as debugger:
            while len(found) <= count:
                debugger.run_to(address, start)
                if found:
                    found[-1] += (self.pulses(),)
                low, high = self.outputs.words(debugger.register(STACK), 2)
                power = signed(debugger.register(LEFT_PULSE)), signed(debugger.register(RIGHT_PULSE))
                if found or power != (0, 0):  # a halt before the first reading may still end
                    found.append((low | high << 32, *power))
                debugger.step()
        feeder.stop()
        return found[:count]

    def test_each_command_gives_its_pins_their_power_for_its_time(self):
        again = PROGRAM.replace("  TURN base LEFT 90deg\n", "  TURN base LEFT 90deg\n  DRIVE base BACKWARD 1m\n")
        self.say("upload", self.written(again))
        drive, end, turn, turned, back = self.calls(5)
        self.assertEqual(drive[1:], (QUARTER, QUARTER, {LEFT: QUARTER, RIGHT: QUARTER}))
        self.assertEqual(end[1:], (0, 0, {}))
        self.assertEqual(turn[1:], (-HALF, HALF, {LEFT_BACK: HALF, RIGHT: HALF}))
        self.assertEqual(turned[1:], (0, 0, {}))
        for begun, ended, said in ((drive, end, 2_000_000), (turn, turned, TURN_US)):
            self.assertGreaterEqual(ended[0] - begun[0], said)
            self.assertLess(ended[0] - begun[0], said + LATE_US)
        self.assertEqual(back[1:], (-HALF, -HALF, {LEFT_BACK: HALF, RIGHT_BACK: HALF}))

    def test_a_rule_of_safety_switches_all_pins_off_in_the_middle(self):
        self.begin()
        self.feed(95)
        self.assertEqual(self.pulses(), {})
        self.feed(60)
        self.assertEqual(self.pulses(), {})
        self.feed(3)
        self.assertEqual(self.pulses(), {})
        self.feed(60)
        self.await_pulses({LEFT_BACK: HALF, RIGHT: HALF})
        self.feed(95)
        self.assertEqual(self.pulses(), {})

    def test_a_person_or_another_program_ends_it(self):
        self.begin()
        self.say("stop")
        self.assertEqual(self.pulses(), {})
        self.say("resume")
        self.assertEqual(self.pulses(), {})
        self.feed(0, 20)
        self.await_pulses({LEFT: QUARTER, RIGHT: QUARTER})
        self.say("upload", self.written(WITHOUT_WHEELS))
        self.assertEqual(self.pulses(), {})

    def test_the_trace_is_that_of_the_host(self):
        config = self.folder / "wired.json"
        config.write_text(json.dumps(CONFIG))
        readings = [Reading(at, "near.X", value) for at, value in
                    ((0, 2), (500, 20), (3800, 5), (4000, 30), (5100, 95), (5600, 3), (6000, 40), (8200, 95), (8300, 2))]
        lines = self.check(self.written(), readings, config)
        self.assertEqual(sum('"done"' in line and '"base"' in line for line in lines), 3)


if __name__ == "__main__":
    unittest.main()

"""A drive that goes by the encoders of its wheels, on the shipped firmware. The reference board's wheels are virtual, as the host's
are; on the other boards the test plays their edges. ROBOSYNC_BOARD selects the board."""

import json
import sys
import time
import unittest
from collections import namedtuple
from pathlib import Path

import outputs
import pins
import rsc
from board import FIRMWARE, NAME, REFERENCE
from support import AT_WILL, STOPS_WHEN_FAR, RobotTest
from traces import TraceTest

sys.path.append(str(Path(__file__).resolve().parents[2] / "bench"))
from counting import symbols  # noqa: E402

Reading = namedtuple("Reading", "at_ms channel value")
PATIENCE = 30
LEFT, LEFT_BACK, RIGHT, RIGHT_BACK = AT_WILL[:4]
ENCODERS = {"nucleo-l476rg": (7, 9), REFERENCE: (pins.VIRTUAL[0], pins.VIRTUAL[2])}.get(NAME, (7, 8))
MM_OF_EDGE = 65 * 3.14159265 / 40
ROBOT = {
    "board": NAME,
    "sensors": [{"name": "near", "type": "VIRTUAL", "channels": {"X": {"range": [0, 100]}}},
                *({"name": name, "type": "GPIO", "device": "encoder", "pin": pin, "pulses_per_turn": 20, "wheel": "65mm"}
                  for name, pin in zip(("left", "right"), ENCODERS))],
    "actuators": [{"name": "base", "type": "PWM", "device": "differential_drive", "left": [LEFT, LEFT_BACK], "right": [RIGHT, RIGHT_BACK],
                   "speed": "40cm/s", "track": "12cm", "encoders": ["left", "right"], "simulated_difference": "11%"}]}
BOTH_WAYS = {"pins": [pins.VIRTUAL[0], pins.VIRTUAL[1]]}, {"pins": [pins.VIRTUAL[2], pins.VIRTUAL[3]]}
COURSE = STOPS_WHEN_FAR + """
WHEN near X > 50
DO
  SPIN base LEFT AT 7cm/s FOR 1300ms
  DRIVE base TO 0cm
END
WHEN near X > 10
DO
  DRIVE base FORWARD 20cm AT 10cm/s
  TURN base LEFT 90deg
  DRIVE base BACKWARD 31cm OVER 1s
  THEN
  LOG "there"
END
WHEN left SPEED > 9cm/s DO LOG "fast" END
"""
# It begins to drive when the test has turned a wheel by two edges.
TURNED = """
WHEN left DISTANCE > 8mm DO DRIVE base FORWARD 3cm AT 0.5cm/s END
WHEN right DISTANCE > 8mm DO DRIVE base FORWARD 100m AT 0.5cm/s END
"""
EDGES = 6  # of 3 cm
PULSE_US = 250  # of 0.5 cm/s


class Counted(RobotTest):
    def written(self, program, robot):
        (self.folder / "robot.rsl").write_text(program)
        (self.folder / "wired.json").write_text(json.dumps(robot))
        return self.folder / "robot.rsl", self.folder / "wired.json"


@unittest.skipUnless(NAME == REFERENCE, "its wheels are virtual")
class VirtualWheels(Counted, TraceTest):
    units = {"near.X": ""}

    def robot(self):
        near, left, right = (dict(sensor) for sensor in ROBOT["sensors"])
        for sensor, both in zip((left, right), BOTH_WAYS):
            del sensor["pin"]
            sensor.update(both)
        return ROBOT | {"sensors": [near, left, right]}

    def test_the_trace_is_that_of_the_host(self):
        readings = [Reading(at, "near.X", value) for at, value in
                    ((0, 2), (500, 20), (6500, 5), (6600, 60), (9000, 30), (10_100, 95), (10_600, 3), (11_000, 40), (12_200, 95), (12_300, 2))]
        for robot in (ROBOT, self.robot()):
            program, config = self.written(COURSE, robot)
            lines = [json.loads(line) for line in self.check(program, readings, config)]
            self.assertFalse([line for line in lines if line["event"] == "blocked"])
            self.assertGreaterEqual(sum(line["event"] == "done" for line in lines), 4)
            self.assertGreater(sum(line.get("channel") == "DISTANCE" for line in lines), 100)
            self.assertTrue(any(line.get("text") == "there" for line in lines))

    def test_lost_edges_block_it(self):
        program, config = self.written("AT START DO DRIVE base FORWARD 100m END\n", ROBOT)
        wires = pins.Pins(self.folder)
        self.addCleanup(wires.close)
        self.upload(program, "--config", config)
        pulses = outputs.Outputs(self.board, self.folder).pulses
        reader = self.listen()
        self.await_event(reader, event="input", sensor="left")
        self.assertEqual(set(pulses()), {LEFT, RIGHT})
        wires.write(symbols(FIRMWARE)["robosync_virtual_edges"], (1000).to_bytes(4, "little"))
        self.await_event(reader, event="blocked", actuator="base")
        self.assertEqual(pulses(), {})

    def test_a_stop_in_the_middle_of_a_movement(self):
        program, config = self.written("AT START DO DRIVE base FORWARD 100m END\n", ROBOT)
        self.upload(program, "--config", config)
        pulses = outputs.Outputs(self.board, self.folder).pulses
        give_up = time.monotonic() + PATIENCE
        while set(pulses()) != {LEFT, RIGHT}:
            self.assertLess(time.monotonic(), give_up, "it never begins")
        for verb in ("stop", "resume", "info"):
            rsc.run(verb, "--port", self.board.port)
            self.assertEqual(pulses(), {}, verb)

    def qemu_arguments(self):
        return [*pins.arguments(self.folder), *super().qemu_arguments()]


@unittest.skipUnless(NAME in ("b-l475e-iot01a", "nucleo-l476rg"), "QEMU has no edges of pins elsewhere")
class PlayedEdges(Counted):
    def setUp(self):
        super().setUp()
        self.wires = pins.Pins(self.folder)
        self.addCleanup(self.wires.close)
        self.pulses = outputs.Outputs(self.board, self.folder).pulses
        self.turned = {"left": 0, "right": 0}
        for pin in ENCODERS:
            self.wires.set(pin, False)
        self.upload(*self.arguments())
        self.reader = self.listen()

    def arguments(self):
        program, config = self.written(TURNED, ROBOT)
        return program, "--config", config

    def qemu_arguments(self):
        return [*outputs.arguments(self.folder), *pins.arguments(self.folder), *super().qemu_arguments()]

    def await_distance(self, wheel):
        def came(lines):
            told = [event["value"] for event in map(json.loads, lines)
                    if event["event"] == "input" and (event["sensor"], event["channel"]) == (wheel, "DISTANCE")]
            return told and abs(told[-1] - self.turned[wheel] * MM_OF_EDGE) < 0.02
        self.assertTrue(self.reader.wait_for(came, PATIENCE), (wheel, self.turned, self.reader.lines[-8:]))

    def turn(self, wheel, edges=1):
        for _ in range(edges):
            self.turned[wheel] += 1
            self.wires.set(ENCODERS[wheel == "right"], self.turned[wheel] % 2 == 1)
            self.await_distance(wheel)

    def await_pulses(self, pulses):
        give_up = time.monotonic() + PATIENCE
        while self.pulses() != pulses:
            self.assertLess(time.monotonic(), give_up, f"{self.pulses()}, but never {pulses}")

    def test_each_wheel_goes_off_at_its_edge(self):
        self.turn("left", 2)
        self.await_pulses({LEFT: PULSE_US, RIGHT: PULSE_US})
        self.turn("left")
        self.await_pulses({LEFT: PULSE_US * 80 // 100, RIGHT: PULSE_US})  # 5.1 mm ahead
        self.turn("right")
        self.await_pulses({LEFT: PULSE_US, RIGHT: PULSE_US})
        for _ in range(EDGES - 2):
            self.turn("right")
            self.turn("left")
        self.await_pulses({LEFT: PULSE_US, RIGHT: PULSE_US})
        self.turn("left")
        self.turn("right")
        self.await_event(self.reader, event="done", actuator="base")
        self.await_pulses({})

    def test_a_silent_encoder_blocks_it(self):
        self.turn("left", 2)
        self.await_pulses({LEFT: PULSE_US, RIGHT: PULSE_US})
        self.turn("left")
        self.await_event(self.reader, event="blocked", actuator="base")
        self.await_pulses({})
        self.assertFalse([line for line in self.reader.lines if json.loads(line)["event"] == "done"])

    def test_a_wire_that_swings_blocks_it(self):
        self.turn("right", 2)
        self.await_pulses({LEFT: PULSE_US, RIGHT: PULSE_US})
        give_up = time.monotonic() + PATIENCE
        while time.monotonic() < give_up and not self.reader.wait_for(lambda lines: any('"blocked"' in line for line in lines), 0):
            for swing in range(2000):
                self.wires.set(ENCODERS[0], swing % 2 == 0)
        self.await_event(self.reader, event="blocked", actuator="base")
        self.await_pulses({})


if __name__ == "__main__":
    unittest.main()

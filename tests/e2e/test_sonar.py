"""The ultrasonic sensor on the boards' firmware: the test plays the sensor, and the trace shows its readings. ROBOSYNC_BOARD
selects the board."""

import json
import sys
import time
import unittest
from pathlib import Path

import pins
from board import FIRMWARE, NAME
from debugger import LINK_REGISTER
from support import PATIENCE
from wired import WiredTest, counted, place_of, said

sys.path.append(str(Path(__file__).resolve().parents[2] / "bench"))
from counting import symbols  # noqa: E402

MM_PER_CM = 10
US_PER_CM = 1 / 0.01715
REFERENCE = NAME not in pins.LINES
ECHO = pins.VIRTUAL[0] if REFERENCE else 7
ARM = 6 if NAME == "nucleo-l476rg" else 2
ROBOT = {"board": NAME, "actuators": [{"name": "arm", "type": "PWM", "pin": ARM, "device": "servo"}],
         "sensors": [{"name": "sonar", "type": "GPIO", "trigger": 3, "echo": ECHO, "device": "hc-sr04"}]}
PROGRAM = """
SAFETY wall
  WHEN sonar DISTANCE < 30cm
  DO
    STOP arm
    ALERT "stands still"
  RESUME WHEN sonar DISTANCE > 40cm
END
WHEN sonar DISTANCE < 120cm
MARGIN 5cm
DO LOG "near"
END
"""
KICK = "watchdog_kick()"  # every 10 ms, by SAFETY
KICK_US = 10_000


class Sonar(WiredTest):
    PROGRAM, ROBOT = PROGRAM, ROBOT

    def distances(self, lines):
        told = (json.loads(line) for line in lines)
        return [None if event["value"] is None else event["value"] / MM_PER_CM for event in told
                if event.get("event") == "input" and event.get("sensor") == "sonar"]

    def await_distance(self, reader, cm, within):
        def came(lines):
            return any(abs(value - cm) <= within for value in self.distances(lines) if value is not None)
        self.assertTrue(reader.wait_for(came, PATIENCE), (cm, reader.lines[-8:]))


@unittest.skipUnless(REFERENCE, "its echoes are words of the reference board's memory")
class OfMemory(Sonar):
    def echo(self, us):
        self.wires.write(symbols(FIRMWARE)["robosync_virtual_echoes"], us.to_bytes(4, "little"))

    def test_echoes_are_distances_and_silence_trips_safety(self):
        reader = self.begin()
        for cm in (100, 350, 35):
            self.echo(round(cm * US_PER_CM))
            self.await_distance(reader, cm, 0.05)
        self.await_event(reader, event="log", text="near")
        self.assertFalse(any('"stands still"' in line for line in reader.lines[-3:]))
        self.echo(0)
        self.await_event(reader, event="silent")
        self.await_event(reader, event="alert", text="stands still")


@unittest.skipUnless(NAME in ("b-l475e-iot01a", "nucleo-l476rg"), "QEMU has no edges of pins elsewhere")
class OfEdges(Sonar):
    """The core is stopped while the test changes a level; between two kicks of the watchdog it runs for 10 ms."""

    def setUp(self):
        super().setUp()
        self.wires.set(ECHO, False)

    def echo(self, debugger, level_changes):
        """From the next pulse on, sets the next level at each kick of the watchdog."""
        debugger.run_to(place_of("Board::ping("), lambda: None)
        debugger.run_to(debugger.register(LINK_REGISTER) & ~1, lambda: None)
        for high in level_changes:
            debugger.run_to(place_of(KICK), lambda: None)
            self.wires.set(ECHO, high)
            debugger.step()

    def test_an_echo_of_ten_milliseconds_is_a_distance(self):
        reader = self.begin()
        with self.debugger() as debugger:
            for _ in range(3):
                self.echo(debugger, (True, False))
        self.await_distance(reader, KICK_US / US_PER_CM, 2)
        self.assertNotIn(True, [value is not None and abs(value - KICK_US / US_PER_CM) > 2 for value in self.distances(reader.lines)])
        self.await_event(reader, event="silent")  # afterwards there are no echoes

    def test_an_echo_that_stays_and_edges_that_nobody_asked_for_are_no_reading(self):
        self.upload(self.program, "--config", self.config)
        with self.debugger() as debugger:
            self.echo(debugger, (True,))
        self.wires.set(ECHO, False)
        before = self.status()["safety_checks"]
        give_up = time.monotonic() + PATIENCE
        while (status := self.status())["safety_checks"] < before + 50:
            for high in (True, False):
                self.wires.set(ECHO, high)
            self.assertLess(time.monotonic(), give_up)
        self.assertEqual((status["safety_late_us"], status["faults"]), (0, 0))
        reader = self.listen()
        self.assertFalse(reader.wait_for(self.distances, 1), reader.lines)

    def test_what_a_measurement_costs(self):
        """From the guard on, the pulse with both edges, and the sample: at most the values in costs.def, and 1,500 in all."""
        self.begin()
        with self.debugger() as debugger:
            asked = counted(debugger, place_of("Board::ping("))
            edges = []
            for high in (True, False):
                debugger.run_to(place_of(KICK), lambda: None)
                self.wires.set(ECHO, high)
                edges.append(counted(debugger, symbols(FIRMWARE)["Echo_Handler"]))
            read = counted(debugger, place_of("drivers::hc_sr04::read("))
        print(f"\n  asked {asked}, edges {edges}, sampled {read}")
        self.assertGreaterEqual(said("ping"), asked + sum(edges))
        self.assertGreaterEqual(said("echo"), read)
        self.assertLessEqual(asked + sum(edges) + read, 1500)


if __name__ == "__main__":
    unittest.main()

"""Encoders of wheels on the boards' firmware: the test turns the wheels. ROBOSYNC_BOARD selects the board."""

import json
import re
import subprocess
import sys
import unittest
from pathlib import Path

import pins
import rsc
from board import FIRMWARE, NAME
from debugger import MOST_STEPS
from support import PATIENCE
from wired import WiredTest, counted, place_of, said

sys.path.append(str(Path(__file__).resolve().parents[2] / "bench"))
from counting import symbols  # noqa: E402

MM_OF_EDGE = 65 * 3.14159265 / 40
REFERENCE, MICROBIT = NAME not in pins.LINES, NAME == "microbit-v2"
ARM = {"nucleo-l476rg": 6, "microbit-v2": 1}.get(NAME, 2)
A, B = {"microbit-v2": (5, 9), "nucleo-l476rg": (7, 9)}.get(NAME, (pins.VIRTUAL[0], pins.VIRTUAL[1]) if REFERENCE else (7, 8))
ROBOT = {"board": NAME, "actuators": [{"name": "arm", "type": "PWM", "pin": ARM, "device": "servo"}],
         "sensors": [{"name": "wheel", "device": "encoder", "pins": [A, B], "pulses_per_turn": 20, "wheel": "65mm"}]}
PROGRAM = """
SAFETY blind
  WHEN wheel SPEED > 190cm/s
  DO
    STOP arm
    ALERT "blind"
END
WHEN wheel DISTANCE > 10cm DO LOG "far" END
WHEN wheel DISTANCE < -1cm DO LOG "back" END
"""
KICK = "watchdog_kick()"  # every 10 ms, by SAFETY
TAKE, STEPS_OF_TAKE = "take_edges", 80
KICKS, SAMPLE_MS, KICK_MS = 30, 20, 10
SLACK = 4  # interrupts: the one that ends the counting, and one of each sample that comes while it is stopped
SWINGS = 5000
INSTRUCTIONS_PER_MS, MOST_OF_TIME = 80_000_000 // 2000, 0.06  # as docs/timing.md assumes; between two checks of SAFETY
FORWARD = ((A, True), (B, True), (A, False), (B, False))
BACKWARD = ((B, True), (A, True), (B, False), (A, False))


def most_edges():
    """Of a sample."""
    drivers, rules = ((rsc.ROOT / path).read_text() for path in ("vm/drivers.hpp", "runtime-m4/policy/rules.hpp"))
    late = int(re.search(r"kSafetyPeriodMs = (\d+);", rules)[1])
    return int(re.search(r"kEdgesPerMs = (\d+);", drivers)[1]) * (SAMPLE_MS + late)


class Encoder(WiredTest):
    PROGRAM, ROBOT = PROGRAM, ROBOT

    def await_distance(self, reader, edges):
        def came(lines):
            told = [event["value"] for event in map(json.loads, lines) if event.get("channel") == "DISTANCE" and event["event"] == "input"]
            return told and told[-1] is not None and abs(told[-1] - edges * MM_OF_EDGE) < 0.01
        self.assertTrue(reader.wait_for(came, PATIENCE), (edges, reader.lines[-8:]))


@unittest.skipUnless(REFERENCE, "its edges are words of the reference board's memory")
class OfMemory(Encoder):
    def turn(self, edges):
        self.wires.write(symbols(FIRMWARE)["robosync_virtual_edges"], (edges & 0xFFFF_FFFF).to_bytes(4, "little"))

    def pass_a_sample(self):
        """Otherwise both turns could be one sample's, or two's."""
        with self.debugger() as debugger:
            for _ in range(3 * SAMPLE_MS // KICK_MS):
                debugger.run_to(place_of(KICK), lambda: None)
                debugger.step()

    def test_edges_are_a_distance_and_too_many_are_lost(self):
        reader = self.begin()
        for edges in (1, 40, -3):
            self.turn(edges)
            self.await_distance(reader, edges)
        self.await_event(reader, event="log", text="far")
        self.await_event(reader, event="log", text="back")
        lost = most_edges() + 1
        self.turn(-3 + lost)
        self.pass_a_sample()
        for edges in (-2, -2 + most_edges()):
            self.turn(edges + lost)
            self.await_distance(reader, edges)


class OfEdges(Encoder):
    """The core is stopped while the test changes a level; between two kicks of the watchdog it runs for 10 ms."""

    def turn(self, debugger, changes):
        for pin, high in changes:
            debugger.run_to(place_of(KICK), lambda: None)
            self.wires.set(pin, high)
            debugger.step()

    def rest(self):
        for pin in (A, B):
            self.wires.set(pin, False)


@unittest.skipUnless(NAME in ("b-l475e-iot01a", "nucleo-l476rg"), "QEMU has no edges of pins elsewhere")
class OfInterrupts(OfEdges):
    HANDLER = "Echo_Handler"

    def test_a_wheel_that_turns_is_a_distance_forward_and_back(self):
        self.rest()
        reader = self.begin()
        with self.debugger() as debugger:
            self.turn(debugger, 10 * FORWARD)
        self.await_distance(reader, 20)
        self.await_event(reader, event="log", text="far")
        with self.debugger() as debugger:
            self.turn(debugger, 12 * BACKWARD)
        self.await_distance(reader, -4)
        self.await_event(reader, event="log", text="back")
        self.assert_in_time(reader)

    def test_an_edge_while_a_sample_is_taken_counts(self):
        """QEMU forgets an edge of a masked line, and lets the wire change where the processor writes to a register."""
        self.rest()
        reader = self.begin()
        with self.debugger() as debugger:
            for steps in range(STEPS_OF_TAKE):
                debugger.run_to(place_of(TAKE), lambda: None)
                for _ in range(steps):
                    debugger.step()
                self.wires.set(A, steps % 2 == 0)
                self.turn(debugger, ((B, steps % 2 == 0),))
        self.await_distance(reader, STEPS_OF_TAKE)

    def assert_in_time(self, reader):
        reader.stop()  # it has the line
        status = self.status()
        self.assertEqual((status["safety_late_us"], status["faults"]), (0, 0))

    def test_a_wire_that_swings_whenever_it_can_leaves_safety_its_time(self):
        """A changes again as soon as the processor has come to its interrupt, so the next one is there when this one ends. QEMU's clock
        runs on at each stop, so the test counts the interrupts, and what they cost."""
        self.rest()
        reader = self.begin()
        handler, kick, handled, high = symbols(FIRMWARE)[self.HANDLER], place_of(KICK), [0], True
        with self.debugger() as debugger:
            self.turn(debugger, ((A, True),))
            debugger.stop_at(handler)
            debugger.stop_at(kick)
            while len(handled) < KICKS and debugger.go_on():
                if debugger.register(15) & ~1 == handler & ~1:
                    handled[-1] += 1
                else:
                    handled.append(0)
                high = not high  # where the interrupt is masked, this is seen when it is no longer
                self.wires.set(A, high)
                debugger.step()
        print(f"\n  interrupts between two checks of SAFETY: {max(handled)}, of {most_edges()} in a sample")
        self.assertGreater(max(handled), most_edges() // 2)
        self.assertLessEqual(max(handled), most_edges() + SLACK)
        self.assertLessEqual(sum(handled), (KICKS * KICK_MS / SAMPLE_MS + 1) * (most_edges() + SLACK))
        self.assertLessEqual(max(handled) * said("edge"), KICK_MS * INSTRUCTIONS_PER_MS * MOST_OF_TIME)
        self.await_event(reader, event="silent", sensor="wheel")
        self.await_event(reader, event="alert", text="blind")

    def test_no_check_of_safety_is_late_while_a_wire_swings(self):
        self.rest()
        reader = self.begin()
        for swing in range(SWINGS):
            self.wires.set(A, swing % 2 == 0)
        self.assert_in_time(reader)

    def test_what_an_edge_and_a_sample_cost(self):
        self.rest()
        self.begin()
        of_edge, of_sample = said("edge"), said("encoder")
        with self.debugger() as debugger:
            edges = []
            for pin, high in 3 * FORWARD:
                debugger.run_to(place_of(KICK), lambda: None)
                self.wires.set(pin, high)
                if pin == A:
                    edges.append(counted(debugger, symbols(FIRMWARE)[self.HANDLER]))
                else:
                    debugger.step()
            reads = [counted(debugger, place_of("drivers::Encoders::sample(")) for _ in range(4)]
        print(f"\n  edges {edges}, said {of_edge}; samples {reads}, said {of_sample}")
        self.assertGreaterEqual(of_edge, max(edges))
        self.assertLessEqual(of_edge, 1.3 * max(edges))
        self.assertGreaterEqual(of_sample, max(reads))


@unittest.skipUnless(MICROBIT, "on the micro:bit the test plays the edges")
class OfPlayedEdges(OfEdges):
    """QEMU has the micro:bit's pins, but not its GPIOTE: the test requests its interrupt and gives what its register of A's edges reads."""

    CORE, GPIOTE, EVENT_OF_A = "/machine/nrf51/armv6m", 6, 0x4000_6100
    LOAD = re.compile(r"^\s*([0-9a-f]+):.*\sldr(?:\.w)?\s+r(\d+), \[r(\d+)(?:, (?:#(\d+)|r(\d+)(?:, lsl #(\d+))?))?\]$")

    def loads(self):
        """{address of an instruction that loads a word: (register it loads, register of the address, offset, register of an index, its
        shift)}"""
        listing = subprocess.run(["arm-none-eabi-objdump", "-d", FIRMWARE], check=True, text=True, stdout=subprocess.PIPE).stdout
        found = {}
        for load in filter(None, map(self.LOAD.match, listing.splitlines())):
            at, register, base, offset, index, shift = load.groups()
            found[int(at, 16)] = int(register), int(base), int(offset or 0), index and int(index), int(shift or 0)
        return found

    def interrupt(self, debugger, handler, loads):
        self.wires.interrupt(self.CORE, self.GPIOTE)
        debugger.run_to(handler, lambda: None)
        mode, steps = debugger.mode(), 0
        while debugger.mode() == mode and steps < MOST_STEPS:
            core = debugger.core()
            load = loads.get(core[15])
            debugger.step()
            steps += 1
            if load and self.place(core, *load[1:]) == self.EVENT_OF_A:
                debugger.set_register(load[0], 1)
        return steps

    def place(self, core, base, offset, index, shift):
        return core[base] + offset + (0 if index is None else core[index] << shift)

    def test_a_wheel_that_turns_is_a_distance_and_what_an_edge_costs(self):
        self.rest()
        reader, handler, steps = self.begin(), symbols(FIRMWARE)["Echo_Handler"], []
        loads = self.loads()
        with self.debugger() as debugger:
            for pin, high in 3 * BACKWARD:
                debugger.run_to(place_of(KICK), lambda: None)
                self.wires.set(pin, high)
                debugger.step()
                if pin == A:
                    steps.append(self.interrupt(debugger, handler, loads))
        self.await_distance(reader, -6)
        self.await_event(reader, event="log", text="back")
        of_edge = said("edge")
        print(f"\n  edges {steps}, said {of_edge}")
        self.assertGreaterEqual(of_edge, max(steps))
        self.assertLessEqual(of_edge, 1.3 * max(steps))


if __name__ == "__main__":
    unittest.main()

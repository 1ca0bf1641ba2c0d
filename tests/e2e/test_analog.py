"""Analog inputs on the boards' firmware, and what only the micro:bit has: outputs that are inputs of other programs, and its logo.
The reference board's inputs are words of its memory, which the test writes. QEMU does not have the other boards' converters, so
there they never answer. ROBOSYNC_BOARD selects the board."""

import json
import sys
import unittest
from pathlib import Path

import pins
import rsc
from board import FIRMWARE, NAME
from debugger import PC, DebuggedTest
from support import PATIENCE, LineReader

sys.path.append(str(Path(__file__).resolve().parents[2] / "bench"))
from counting import symbols  # noqa: E402

FULL = 4095
WORD = 4
REFERENCE = NAME not in pins.LINES
ANALOG = {"b-l475e-iot01a": range(40, 45), "nucleo-l476rg": range(40, 45), "microbit-v2": range(3)}.get(NAME, range(44, 48))
CLAW = 14 if NAME == "microbit-v2" else 3
ROBOT = {"board": NAME, "actuators": [{"name": "claw", "type": "PWM", "pin": CLAW, "device": "servo"}],
         "sensors": [{"name": f"a{pin}", "type": "ADC", "pin": pin, "device": "force"} for pin in ANALOG]}
FIRST, LAST = ANALOG[0], ANALOG[-1]
LINK_REGISTER, MOST_COUNTED, LOOSEST = 14, 10_000, 1.3
PROGRAM = f"""
SAFETY soft_hand
  WHEN a{FIRST} FORCE > 70%
  DO
    STOP claw
    ALERT "lets go"
  RESUME WHEN a{FIRST} FORCE < 30%
END
""" + "".join(f'WHEN a{pin} FORCE > 50%\nDO LOG "{pin} is held"\nELSE LOG "{pin} is free"\nEND\n' for pin in ANALOG)
OTHER = 'WHEN a%d FORCE > 50%%\nDO LOG "held"\nEND\n' % LAST
GPIO_CONFIGURATION = 0x5000_0700  # nRF52833 and its predecessor: a word for each pin of port 0
LOW_OUTPUT, NOT_DRIVEN, PULLED_UP = 0b11, 0b10, 0b1100
PINS_OF_RINGS = {0: 2, 1: 3, 2: 4}
PINS_OF_OUTPUTS = {**PINS_OF_RINGS, 12: 12, 13: 17, 14: 1}


def switch(pin):
    return {"name": f"s{pin}", "type": "GPIO", "pin": pin, "device": "switch"}


class Analog(DebuggedTest):
    def setUp(self):
        super().setUp()
        self.readers = []
        (self.folder / "robot.json").write_text(json.dumps(ROBOT))
        self.wires = pins.Pins(self.folder)
        self.addCleanup(self.wires.close)

    def qemu_arguments(self):
        return [*pins.arguments(self.folder), *super().qemu_arguments()]

    def written(self, program):
        (self.folder / "analog.rsl").write_text(program)
        return self.folder / "analog.rsl", "--config", self.folder / "robot.json"

    def begin(self):
        """Uploads the program and reads its trace from the first reading on."""
        reader = LineReader("monitor", "--port", self.board.port, "--format", "json", "--upload", *self.written(PROGRAM))
        self.readers.append(reader)
        self.addCleanup(self.end, reader)
        self.await_event(reader, event="activated")
        return reader

    def end(self, reader):
        if reader in self.readers:
            self.readers.remove(reader)
            reader.stop()

    def readings(self, reader, pin):
        told = (json.loads(line) for line in reader.lines)
        return [event["value"] for event in told if event.get("event") == "input" and event.get("sensor") == f"a{pin}"]


    def compare_cost_of_samples(self, name, samples):
        """At most the value in costs.def, including the driver and the sampler."""
        listed = (rsc.ROOT / f"runtime-m4/boards/{NAME}/costs.def").read_text()
        said = next(int(line.split(",")[1].replace("'", "")) for line in listed.splitlines() if line.startswith(f"COST({name},"))
        place = next(at for known, at in symbols(FIRMWARE).items() if "DriverSampler::sample(" in known)
        most = 0
        with self.debugger() as debugger:
            for _ in range(samples):
                debugger.run_to(place, lambda: None)
                back, mode, steps = debugger.register(LINK_REGISTER) & ~1, debugger.mode(), 0
                while steps < MOST_COUNTED and debugger.register(PC) != back:
                    debugger.step()
                    steps += debugger.mode() == mode
                most = max(most, steps)
        print(f"\n  {name}: {most}, said {said}")
        self.assertGreaterEqual(said, most)
        self.assertLessEqual(said, LOOSEST * most)


@unittest.skipUnless(REFERENCE, "its analog inputs are words of the reference board's memory")
class OfMemory(Analog):
    def measure(self, pin, counts):
        self.wires.write(symbols(FIRMWARE)["robosync_virtual_analog"] + WORD * ANALOG.index(pin), counts.to_bytes(4, "little"))

    def test_each_is_its_own_pin_and_a_part_of_the_supply(self):
        reader = self.begin()
        for pin in ANALOG[1:]:
            for counts in (2200, FULL, 1000, 0):
                self.measure(pin, counts)
                value = round(counts * 24.42) / 1000
                self.assertTrue(reader.wait_for(lambda _, pin=pin, value=value: value in self.readings(reader, pin), PATIENCE),
                                (pin, value, reader.lines[-8:]))
        told = [json.loads(line) for line in reader.lines]
        said = [event["text"] for event in told if event.get("event") == "log"]
        self.assertEqual([text for text in said if "held" in text], [f"{pin} is held" for pin in ANALOG[1:]])

    def test_force_stops_the_claw_and_so_does_a_converter_that_does_not_answer(self):
        reader = self.begin()
        self.assertFalse(any('"alert"' in line for line in reader.lines))
        self.measure(FIRST, round(0.71 * FULL))
        self.await_event(reader, event="alert", text="lets go")
        self.measure(FIRST, 0)
        self.await_event(reader, event="release", actuator="claw")
        alerts = sum('"alert"' in line for line in reader.lines)
        self.measure(FIRST, FULL + 1)
        self.await_event(reader, event="silent", sensor=f"a{FIRST}", pin=FIRST)
        self.assertTrue(reader.wait_for(lambda lines: sum('"alert"' in line for line in lines) > alerts, PATIENCE))
        self.measure(FIRST, 0)
        self.await_event(reader, event="answers", sensor=f"a{FIRST}", pin=FIRST)


@unittest.skipIf(REFERENCE, "QEMU has no converter of the others")
class WithoutConverter(Analog):
    def test_one_that_does_not_answer_is_told_trips_safety_and_holds_nobody_up(self):
        reader = self.begin()
        for pin in ANALOG:
            self.await_event(reader, event="silent", sensor=f"a{pin}", pin=pin)
        self.await_event(reader, event="alert", text="lets go")
        self.end(reader)
        status = self.status()
        self.assertEqual((status["safety_late_us"], status["faults"]), (0, 0))
        self.assertEqual(self.readings(reader, FIRST), [])

    @unittest.skipUnless(NAME == "microbit-v2", "only there can a pin be both")
    def test_a_ring_is_let_go_for_the_program_that_measures_it(self):
        def rings():
            return {ring: self.wires.word(GPIO_CONFIGURATION + WORD * bit) for ring, bit in PINS_OF_RINGS.items()}
        self.status()  # waits until it has started
        self.assertEqual(rings(), dict.fromkeys(ANALOG, LOW_OUTPUT))
        self.upload(*self.written(PROGRAM))
        self.assertEqual(rings(), dict.fromkeys(ANALOG, NOT_DRIVEN))
        self.upload(*self.written(OTHER))
        self.assertEqual(rings(), {**dict.fromkeys(ANALOG, LOW_OUTPUT), LAST: NOT_DRIVEN})

    @unittest.skipUnless(NAME == "microbit-v2", "that of the other is not up, and looked at no more")
    def test_what_a_converter_that_does_not_answer_costs(self):
        self.upload(*self.written(OTHER))
        self.compare_cost_of_samples("analog", 1)


@unittest.skipUnless(NAME == "microbit-v2", "only there can an output be an input, and has the board such parts")
class OfMicrobit(Analog):
    def run_with(self, sensors, program):
        (self.folder / "robot.json").write_text(json.dumps({"board": NAME, "sensors": sensors}))
        self.upload(*self.written(program))

    def test_an_output_is_let_go_and_pulled_up_for_the_program_that_reads_its_level(self):
        def configured():
            return {pin: self.wires.word(GPIO_CONFIGURATION + WORD * bit) for pin, bit in PINS_OF_OUTPUTS.items()}
        self.status()
        self.assertEqual(configured(), dict.fromkeys(PINS_OF_OUTPUTS, LOW_OUTPUT))
        self.run_with([switch(pin) for pin in PINS_OF_OUTPUTS], "".join(f'WHEN s{pin} IS closed DO LOG "it" END\n' for pin in PINS_OF_OUTPUTS))
        self.assertEqual(configured(), dict.fromkeys(PINS_OF_OUTPUTS, PULLED_UP))
        self.run_with([switch(2)], 'WHEN s2 IS closed DO LOG "it" END\n')
        self.assertEqual(configured(), {**dict.fromkeys(PINS_OF_OUTPUTS, LOW_OUTPUT), 2: PULLED_UP})

    def test_what_an_input_costs(self):
        """The last of the outputs takes longest."""
        self.run_with([switch(14)], 'WHEN s14 IS closed DO LOG "it" END\n')
        self.compare_cost_of_samples("input", 2)

    def test_what_a_sample_of_a_part_costs(self):
        """The logo takes longer, and its two samples differ. QEMU's pin never rises; what a time adds is counted in the listing."""
        self.run_with([{"name": "logo", "device": "logo"}], 'WHEN logo IS pressed DO LOG "it" END\n')
        self.compare_cost_of_samples("part", 4)


if __name__ == "__main__":
    unittest.main()

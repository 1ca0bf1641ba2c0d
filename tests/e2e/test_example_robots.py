"""Two examples on their own board, with their real inputs and outputs: the arm with a limit of force, whose pins are words of the
reference board's memory, and the one with sixteen servos on a PCA9685. No emulator has that chip: a thermometer in its place
acknowledges every write, and its register 0 reads like that of a running PCA9685."""

import sys
import time
import unittest
from pathlib import Path

import pins
import rsc
from board import FIRMWARE, NAME, REFERENCE
from debugger import DebuggedTest
from outputs import Outputs
from support import ROOT

sys.path.append(str(Path(__file__).resolve().parents[2] / "bench"))
from counting import symbols  # noqa: E402

PATIENCE = 30
WORD = 4
FULL = 4095
# Of examples/gentle_gripper/robot.json.
GRIP, FIRMNESS, BUTTON, CLAW = 0, 1, 0, 3  # places among the analog inputs, and among the others; an output
STILL = 0.5  # seconds
# Of the PCA9685.
CHIP, RUNS = 0x40, 32_000  # its address, and thousandths of a degree: MODE1 would be 0x20
OFF_OF_FIRST, CHANNELS, REGISTERS = 0x08, 16, 4  # where a channel's pulse ends, and how many registers each channel has
PULSE = 3  # bytes: the register, and its new value
# Of examples/hexapod/robot.json.
SWITCH, ECHO, FAR_US = 2, 0, 5_800  # places among the inputs and the echoes; a metre
MOST_TRANSFERS = 12_000
SEND = "robosync::boards::AskedBus<robosync::boards::mps2::LineMaster>::send("
OUT, SHAPE = 1, 3  # its arguments' registers


@unittest.skipUnless(NAME == REFERENCE, "these examples are for the reference board")
class Gripper(DebuggedTest):
    def setUp(self):
        super().setUp()
        self.wires = pins.Pins(self.folder)
        self.addCleanup(self.wires.close)
        self.at = symbols(FIRMWARE)
        self.outputs = Outputs(self.board, self.folder)

    def qemu_arguments(self):
        return [*pins.arguments(self.folder), *super().qemu_arguments()]

    def press(self, place, percent):
        self.wires.write(self.at["robosync_virtual_analog"] + WORD * place, round(percent * FULL / 100).to_bytes(4, "little"))

    def hold_button(self, pressed):
        """It connects its input to GND."""
        self.wires.write(self.at["robosync_virtual_inputs"], (0b1111 ^ (pressed << BUTTON)).to_bytes(4, "little"))

    def pulse(self):
        return self.outputs.pulses().get(CLAW, 0)

    def wait_for(self, what, holds):
        give_up = time.monotonic() + PATIENCE
        while not holds(self.pulse()):
            self.assertLess(time.monotonic(), give_up, f"{what}: {self.pulse()} us")
            time.sleep(0.02)

    def stands(self):
        """The claw's pulse, which stays as it is."""
        pulse = self.pulse()
        until = time.monotonic() + STILL
        while time.monotonic() < until:
            self.assertEqual(self.pulse(), pulse)
        return pulse

    def test_it_closes_until_it_has_hold_of_something_and_lets_go_when_that_presses_too_hard(self):
        self.hold_button(False)
        self.press(FIRMNESS, 20)
        self.press(GRIP, 0)
        rsc.run("upload", ROOT / "examples/gentle_gripper/robot.rsl", "--port", self.board.port)
        self.wait_for("it opens", lambda pulse: pulse != 0)
        opened = self.stands()
        self.hold_button(True)
        self.wait_for("it closes", lambda pulse: pulse > opened + 50)
        self.press(GRIP, 35)
        time.sleep(STILL)
        held = self.stands()
        self.assertGreater(held, opened)
        self.press(FIRMNESS, 90)  # more is allowed, so it goes on
        self.wait_for("it presses harder", lambda pulse: pulse > held)
        self.press(GRIP, 85)
        self.wait_for("it lets go", lambda pulse: pulse == 0)
        self.press(GRIP, 50)
        self.assertEqual(self.stands(), 0)
        self.hold_button(False)
        self.press(GRIP, 5)
        self.wait_for("it opens again", lambda pulse: pulse != 0)
        self.assertEqual(self.status()["faults"], 0)


@unittest.skipUnless(NAME == REFERENCE, "these examples are for the reference board")
class Hexapod(DebuggedTest):
    def setUp(self):
        super().setUp()
        self.board.qmp.command("qom-set", path="/machine/peripheral/chip", property="temperature", value=RUNS)

    def qemu_arguments(self):
        return [*pins.arguments(self.folder), "-device", f"tmp105,id=chip,address={CHIP:#x}", *super().qemu_arguments()]

    def test_all_its_servos_get_pulses(self):
        wires, at = pins.Pins(self.folder), symbols(FIRMWARE)
        self.addCleanup(wires.close)
        wires.write(at["robosync_virtual_inputs"], (0b1111 ^ 1 << SWITCH).to_bytes(4, "little"))
        wires.write(at["robosync_virtual_echoes"] + WORD * ECHO, FAR_US.to_bytes(4, "little"))
        done = rsc.call("upload", ROOT / "examples/hexapod/robot.rsl", "--port", self.board.port)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertNotIn("does not answer", done.stderr)
        pulses = {}
        with self.debugger() as debugger:
            send = next(place for name, place in at.items() if name.startswith(SEND))
            for _ in range(MOST_TRANSFERS):
                debugger.run_to(send, lambda: None)
                shape, out = debugger.register(SHAPE), debugger.register(OUT)
                self.assertEqual(shape & 0xFF, CHIP)
                if shape >> 16 & 0xFF == PULSE:
                    words = debugger.read_words(out & ~3, 2)
                    register, low, high, *_ = b"".join(word.to_bytes(4, "little") for word in words)[out & 3:]
                    channel, rest = divmod(register - OFF_OF_FIRST, REGISTERS)
                    self.assertEqual(rest, 0)
                    if high < 0x10:  # else it is off
                        pulses[channel] = (high << 8 | low) * 4.88
                debugger.step()
                if len(pulses) == CHANNELS:
                    break
        self.assertEqual(set(pulses), set(range(CHANNELS)))
        for channel, pulse in pulses.items():
            self.assertTrue(490 < pulse < 2510, (channel, pulse))
        self.assertEqual(self.status()["faults"], 0)


if __name__ == "__main__":
    unittest.main()

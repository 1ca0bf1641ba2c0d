"""Tests how the shipped firmware of the Nucleo-L476RG uses the pins that only this board has: its button, its light, and the
debugger's serial line. QEMU's machine is another board with a chip of the same family (docs/boards.md). Run with
ROBOSYNC_BOARD=nucleo-l476rg."""

import json
import time
import unittest

import pins
import unimplemented
from board import NAME
from support import RobotTest

PATIENCE = 20
BUTTON, LIGHT, LIT_US, AT_ONCE = 32, 13, 14_000, 0
ROBOT = {"board": NAME, "sensors": [{"name": "b1", "device": "user_button"}],
         "actuators": [{"name": "light", "type": "PWM", "pin": LIGHT, "device": "pwm"}]}
LIGHTS = "WHEN b1 IS pressed\nDO RUN light TO 70%\nELSE STOP light\nEND\n"
# PA5: its mode and its function, which is the first channel of timer 2.
PORT_A, LINE, FUNCTION, OF_TIMER_2 = 0x4800_0000, 5, 0b10, 1
PULSE = ("TIM2", 0x34)
# PA2 and PA3, and PA9, where USART1 is.
SERIAL, OF_USART = (2, 3, 9), 7


class Pins(RobotTest):
    def qemu_arguments(self):
        return [*unimplemented.arguments(self.folder), *pins.arguments(self.folder), *super().qemu_arguments()]

    def setUp(self):
        super().setUp()
        self.wires = pins.Pins(self.folder)
        self.addCleanup(self.wires.close)

    def mode(self, bit):
        """Mode and function of a pin of port A."""
        functions = self.wires.word(PORT_A + 0x20 + 4 * (bit // 8))
        return self.wires.word(PORT_A) >> 2 * bit & 3, functions >> 4 * (bit % 8) & 0xF

    def await_pulse(self, wanted):
        give_up = time.monotonic() + PATIENCE
        while (told := unimplemented.told(self.folder, PULSE))[-1:] != [wanted]:
            self.assertLess(time.monotonic(), give_up, told)

    def test_its_button_lights_its_light(self):
        (self.folder / "robot.json").write_text(json.dumps(ROBOT))
        (self.folder / "robot.rsl").write_text(LIGHTS)
        self.wires.set(BUTTON, True)
        self.upload(self.folder / "robot.rsl", "--config", self.folder / "robot.json")
        self.assertEqual(self.mode(LINE), (FUNCTION, OF_TIMER_2))
        for pressed, pulse in ((True, LIT_US), (False, AT_ONCE), (True, LIT_US)):
            self.wires.set(BUTTON, not pressed)
            self.await_pulse(pulse)

    def test_the_link_and_the_player_have_their_pins(self):
        self.assertEqual(self.status()["faults"], 0)
        self.assertEqual([self.mode(bit) for bit in SERIAL], [(FUNCTION, OF_USART)] * len(SERIAL))


if __name__ == "__main__":
    unittest.main()

"""What the shipped firmware of the micro:bit V2 tells those parts of its chip that QEMU does not have: QEMU writes that
down. Run with ROBOSYNC_BOARD=microbit-v2."""

import re
import time
import unittest

import rsc
from support import RobotTest

PATIENCE = 20
WRITE = re.compile(r"device write \(size 4, offset 0x([0-9a-f]+), value 0x([0-9a-f]+)\)")
PERIPHERALS = 0x4000_0000
PIN_OF_PWM0 = [0x4001_C560, 0x4001_C564, 0x4001_C568, 0x4001_C56C]  # PSEL.OUT
NOBODY = 0x8000_0000
P0_02, P0_03 = 2, 3  # the rings 0 and 1
WATCHDOG_START, WATCHDOG_RELOAD, WATCHDOG_KICK = 0x4001_0000, 0x4001_0504, 0x4001_0600
KICKED = 0x6E52_4635
A_TENTH = 3275  # counts of 32,768 Hz, but one
ARMS = """{
  "sensors": [{"name": "near", "type": "VIRTUAL", "channels": {"X": {"range": [0, 100]}}}],
  "actuators": [
    {"name": "arm", "type": "PWM", "pin": 0, "device": "servo", "range": ["0deg", "100deg"]},
    {"name": "lamp", "type": "PWM", "pin": 1, "device": "pwm"}]
}"""
PROGRAM = """
WHEN near X > 10
DO
  RUN lamp TO 70%
  MOVE arm TO 50deg
END
"""


class OnMicrobit(RobotTest):
    def qemu_arguments(self):
        self.log = self.folder / "told"
        return ["-d", "unimp", "-D", str(self.log)]

    def told(self, address):
        """The values that were written there, so far."""
        writes = ((int(at, 16) + PERIPHERALS, int(value, 16)) for at, value in WRITE.findall(self.log.read_text()))
        return [value for at, value in writes if at == address]

    def await_told(self, address, value):
        give_up = time.monotonic() + PATIENCE
        while self.told(address)[-1:] != [value]:
            self.assertLess(time.monotonic(), give_up, f"{address:#x} was told {self.told(address)[-5:]}, not {value:#x}")

    def say(self, verb, *arguments):
        return rsc.run(verb, *arguments, "--port", self.board.port)

    def test_pins_get_their_module_with_the_first_pulse_and_lose_it_when_the_robot_is_stopped(self):
        config, program = self.folder / "arms.json", self.folder / "arms.rsl"
        config.write_text(ARMS)
        program.write_text(PROGRAM)
        self.upload(self.compile(program, config))
        self.assertEqual([self.told(pin) for pin in PIN_OF_PWM0], [[], [], [], []])
        self.say("feed", "near.X=5")
        self.say("feed", "near.X=20")
        self.await_told(PIN_OF_PWM0[0], P0_02)
        self.await_told(PIN_OF_PWM0[1], P0_03)
        self.say("stop")
        self.await_told(PIN_OF_PWM0[1], NOBODY)
        self.assertEqual(self.told(PIN_OF_PWM0[2]) + self.told(PIN_OF_PWM0[3]), [])

    def test_the_watchdog_is_started_once_and_kicked_with_each_check_of_safety(self):
        self.status()  # it has started
        self.assertEqual((self.told(WATCHDOG_START), self.told(WATCHDOG_RELOAD)), ([1], [A_TENTH]))
        before = len(self.told(WATCHDOG_KICK))
        checks = self.status()["safety_checks"]
        kicks = self.told(WATCHDOG_KICK)
        self.assertGreater(len(kicks), before)
        self.assertEqual(set(kicks), {KICKED})
        self.assertGreaterEqual(len(kicks), checks)


if __name__ == "__main__":
    unittest.main()

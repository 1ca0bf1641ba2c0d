"""rsc stop and rsc resume on the shipped firmware, and images that the board refuses for its pins."""

import json
import struct
import time
import unittest

import outputs
import rsc
import wire
from board import NAME
from support import AT_WILL, PROFILE, TURNS_ROUND, RobotTest, wheel_on

PATIENCE = 20
ARM, MOTOR, FORWARD, BACK = AT_WILL[:4]
SEVENTY_PERCENT = 14_000  # us
PWM_DRIVER, LIGHTS_DRIVER, WORD_DRIVER = 5, 9, 22  # in vm/drivers.def
HOLD, COAST = 0, 2  # vm::Release
CONFIG = {
    "board": NAME,
    "sensors": [{"name": "near", "type": "VIRTUAL", "channels": {"X": {"range": [0, 100]}}}],
    "actuators": [
        {"name": "arm", "type": "PWM", "pin": ARM, "device": "servo", "range": ["0deg", "100deg"]},
        {"name": "motor", "type": "PWM", "pin": MOTOR, "device": "pwm", "on_release": "hold"}]}
PROGRAM = """
WHEN near X > 10
DO
  RUN motor TO 70%
  MOVE arm TO 100deg AT 20deg/s
END
"""
WITHOUT_MOTOR = """
WHEN near X > 10
DO MOVE arm TO 50deg
END
"""
THERMOMETER = """
WHEN warmth TEMPERATURE > 30C
MARGIN 1C
DO LOG "warm"
END
"""


class Stop(RobotTest):
    def setUp(self):
        super().setUp()
        (self.folder / "robot.json").write_text(json.dumps(CONFIG))
        self.pulses = outputs.Outputs(self.board, self.folder).pulses

    def qemu_arguments(self):
        return outputs.arguments(self.folder)

    def compiled(self, program):
        source, image = self.folder / "robot.rsl", self.folder / "robot.rsb"
        source.write_text(program)
        rsc.run("compile", source, "-o", image)
        return image

    def say(self, verb, *arguments):
        return rsc.run(verb, *arguments, "--port", self.board.port)

    def feed(self, *values):
        for value in values:
            self.say("feed", f"near.X={value}")

    def await_motor(self, pulse, pin=MOTOR):
        give_up = time.monotonic() + PATIENCE
        while (pulses := self.pulses()).get(pin) != pulse:
            self.assertLess(time.monotonic(), give_up, f"the motor never came to {pulse} us")
        return pulses

    def test_stop_holds_until_resume_whatever_comes(self):
        image = self.compiled(PROGRAM)
        self.say("upload", image)
        self.feed(20)
        self.await_motor(SEVENTY_PERCENT)
        self.say("stop")
        self.assertEqual(self.pulses(), {})
        self.feed(5, 20)
        self.say("upload", image)
        self.feed(20)
        self.assertEqual(self.pulses(), {})
        self.assertTrue(rsc.info(self.board.port)["state"]["stopped"])
        self.say("resume")
        self.assertFalse(rsc.info(self.board.port)["state"]["stopped"])
        self.feed(5, 20)
        self.await_motor(SEVENTY_PERCENT)

    def test_the_trace_names_the_stop_and_no_behaviour(self):
        self.say("upload", self.compiled(PROGRAM))
        self.say("stop")
        self.feed(5)
        watched = self.say("feed", "near.X=20", "--watch", "2s", "--format", "json")
        lost = [event for event in map(json.loads, watched.splitlines()) if event["event"] == "lose"]
        self.assertEqual([event["by"] for event in lost], ["a person's stop"])

    def test_a_motor_that_the_next_program_does_not_have_stands_still(self):
        self.say("upload", self.compiled(PROGRAM))
        self.feed(20)
        self.await_motor(SEVENTY_PERCENT)
        self.say("upload", self.compiled(WITHOUT_MOTOR))
        self.assertLessEqual(self.pulses().keys(), {ARM})

    def test_a_motor_runs_both_ways_on_one_pin_at_a_time_and_a_stop_ends_both(self):
        (self.folder / "robot.json").write_text(wheel_on(FORWARD, BACK))
        image = self.compiled(TURNS_ROUND)
        self.say("upload", image)
        self.feed(20)
        self.assertEqual(self.await_motor(SEVENTY_PERCENT, FORWARD), {FORWARD: SEVENTY_PERCENT})
        self.feed(60)
        self.assertEqual(self.await_motor(5000, BACK), {BACK: 5000})
        self.say("stop")
        self.assertEqual(self.pulses(), {})
        self.say("resume")
        self.assertEqual(self.pulses(), {})
        self.feed(5, 20, 60)
        self.await_motor(5000, BACK)
        self.say("upload", self.compiled("WHEN near X > 10\nDO LOG \"nothing moves\"\nEND\n"))
        self.assertEqual(self.pulses(), {})

    def test_an_image_for_a_pin_that_is_no_output_is_refused(self):
        self.refuses("<BBH", (PWM_DRIVER, 0, 65535), "does not let programs drive this pin")

    def test_an_image_whose_motor_would_run_on_in_a_halt_is_refused(self):
        """What rsc refuses, too: `"safe": "hold"` for a motor (E0205). So the image is sent without rsc."""
        image = self.changed(PROGRAM, "<BBHBB", (PWM_DRIVER, 0, MOTOR, HOLD, COAST), (PWM_DRIVER, 0, MOTOR, HOLD, HOLD))
        with wire.Line(self.board.port) as line:
            line.hello()
            self.assertEqual(line.try_image(image.read_bytes()), ("drives_on", False))

    @unittest.skipIf(PROFILE.get("lights"), "this board has lights")
    def test_an_image_for_lights_is_refused_where_there_are_none(self):
        self.refuses("<BBH", (LIGHTS_DRIVER, 0, 0), "does not have the driver `lights`")

    def refuses(self, form, wiring, why):
        """Checks that the board refuses the program with the motor's wiring changed."""
        self.refuses_changed(PROGRAM, form, (PWM_DRIVER, 0, MOTOR), wiring, why)

    @unittest.skipUnless(PROFILE.get("reserved"), "this board reserves no address")
    def test_an_image_for_the_address_of_the_store_is_refused(self):
        place, allowed = PROFILE["reserved"][0], 0x48
        robot = {"board": NAME, "sensors": [{"name": "warmth", "type": "I2C", "bus": place["bus"], "address": hex(allowed), "device": "tmp105"}]}
        (self.folder / "robot.json").write_text(json.dumps(robot))
        self.refuses_changed(THERMOMETER, "<BBH", (WORD_DRIVER, place["bus"], allowed),
                             (WORD_DRIVER, place["bus"], int(place["address"], 0)), "a part of the board that programs may not reach")

    def changed(self, program, form, wired, wiring):
        """The program's image, with other wiring; the board accepts it as it was."""
        image = self.compiled(program)
        self.say("upload", image)
        damaged = bytearray(image.read_bytes())
        struct.pack_into(form, damaged, damaged.index(struct.pack(form, *wired)), *wiring)
        image.write_bytes(wire.sealed(bytes(damaged)))
        return image

    def refuses_changed(self, program, form, wired, wiring, why):
        image = self.changed(program, form, wired, wiring)
        done = rsc.call("upload", image, "--port", self.board.port)
        self.assertNotEqual(done.returncode, 0)
        self.assertIn(why, done.stderr)


if __name__ == "__main__":
    unittest.main()

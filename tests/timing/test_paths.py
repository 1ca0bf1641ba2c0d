"""The costs that `rsc check --timing` works out response times with (runtime-m4/policy/costs.def, the board's
costs.def, vm/drivers.def) against what the Cortex-M4 executes; the response times that it says of the examples against
what their readings take."""

import json
import os
import random
import re
import subprocess
import tempfile
import unittest
from collections import Counter
from pathlib import Path

import paths  # first: it says where the others are
import on_board
import rsc
import stimuli
from board import FAST, FIRMWARE, REAL_TIME, Board
from on_board import fed, turned, without_parts
from paths import counting, feed, run, wait
from timing import examples

PAGE = paths.ROOT / "docs/timing.md"
LOOSEST = 1.25  # a cost is at most this many times what was measured, and 60 more
SLACK = 60
HELD = 75  # FOR, at most (vm/opcodes.def)
# What is measured with virtual actuators has the calls of their driver in it.
DRIVER = paths.actuator_drivers()["virtual_actuator"]
VIRTUAL = {"kCommand": DRIVER["start"], "kCancel": DRIVER["release"], "kHalt": DRIVER["release"],
           "kService": DRIVER["advance"] + DRIVER["start"]}
# A reading that fires nothing, twice (the first costs more), and one that fires all. The second is the constant of the rules, so
# they are evaluated: a reading that no rule can tell from the one before costs less.
FIRE = [feed(10), wait(), feed(80), wait(), feed(90), wait(40)]


def behavior(body, when="s c0 > 80", head="WHEN", priority=90, name=None):
    lines = [f"BEHAVIOR {name or f'b{priority}'} PRIORITY {priority}", f"  {head} {when}", "  DO",
             *(f"    {line}" for line in body.splitlines()), "  END", "END"]
    return "\n".join(lines) + "\n"


def rules(body, count, when="s c0 > 80"):
    """A behaviour of so many rules."""
    one = behavior(body, when).split("\n", 1)
    return one[0] + "\n" + one[1].removesuffix("END\n") * count + "END\n"


def move(*actuators, ms=10):
    return "\n".join(f"MOVE a{actuator} TO 1% OVER {ms}ms" for actuator in actuators)


def fired(text, orders=None):
    """Instructions of the last reading."""
    return run(text, orders or FIRE).feeds[-1]


def taken_over(high, *low, actuators=4):
    """A response that starts while others have moved some of the actuators."""
    text = behavior(high) + "".join(behavior(body, "s c0 > 50", priority=50 - i)
                                    for i, body in enumerate(low))
    return fired(text, [feed(10), wait(), feed(60), wait(), feed(90), wait()])


class Table(unittest.TestCase):
    """Each cost by the difference of two programs."""

    @classmethod
    def setUpClass(cls):
        cls.costs = paths.costs()
        cls.log = run(behavior('LOG "x"'), FIRE)
        condition = 14 + 15  # gt_k, ret
        two, three = (run(rules('LOG "x"', count), FIRE).feeds for count in (2, 3))
        cls.quiet = three[1] - two[1] - condition  # a rule from which nothing follows
        # A rule that is the only one of its behaviour in a step takes a shorter way; what the longer one takes more is the behaviour's.
        longer = two[1] - cls.log.feeds[1] - cls.quiet - condition
        apart = run(behavior('LOG "x"') + behavior('LOG "x"', priority=80), FIRE).feeds[1]
        alone = apart - cls.log.feeds[1] - cls.quiet - condition
        cls.behavior = alone + longer
        cls.step = cls.log.feeds[1] - cls.quiet - condition - alone
        # One that waits for a time: the step looks at what follows from it.
        waiting = [run(rules('LOG "x"', count, "s c0 >= 10 FOR 60s"), FIRE).feeds[1] for count in (2, 3)]
        cls.rule = waiting[1] - waiting[0] - condition - HELD
        cls.text = fired(behavior('LOG "x"\nLOG "y"')) - cls.log.feeds[-1]
        cls.fire = cls.log.feeds[-1] - cls.log.feeds[1] - cls.text
        cls.one = fired(behavior(move(0)))
        cls.claim = fired(rules(move(0), 3)) - fired(rules(move(0), 2)) - cls.rule - condition
        # A response that is not the only one of its behaviour, and so is released for by itself.
        cls.another = three[-1] - two[-1] - cls.rule - condition - cls.text

    def assert_covers(self, name, measured):
        said = self.costs[name] + VIRTUAL.get(name, 0)
        self.assertGreaterEqual(said, measured, name)
        self.assertLessEqual(said, LOOSEST * measured + SLACK, name)

    def test_a_step(self):
        self.assert_covers("kRule", self.rule)
        self.assert_covers("kBehavior", self.behavior)
        self.assert_covers("kStep", self.step)

    def test_a_rule_that_fires(self):
        self.assert_covers("kText", self.text)
        self.assert_covers("kClaim", self.claim)
        self.assert_covers("kRun", max(self.fire, self.another) - self.claim)

    def test_commands(self):
        self.assert_covers("kCommand", fired(behavior(move(0, 1))) - self.one)
        self.assert_covers("kQueued", fired(behavior(move(0, 0))) - self.one)
        self.assert_covers("kArgument", (fired(behavior("MOVE a0 TO 1% OVER 10ms 1 TIMES")) - self.one))
        stop = fired(behavior("STOP a0\nSTOP a1")) - fired(behavior("STOP a0"))
        done = self.costs["kCommand"] + DRIVER["start"] + self.costs["kDone"]
        self.assertGreaterEqual(done, stop)
        # No time: it is done at once, and so is the next to the same actuator.
        no_time = [fired(behavior("\n".join(["MOVE a0 TO 1% OVER 0ms"] * count))) for count in (1, 2)]
        self.assertGreaterEqual(done + 2 * self.costs["kArgument"], no_time[1] - no_time[0])
        # Behind a STOP the next begins as well.
        begins = fired(behavior("STOP a0\n" + move(0))) - fired(behavior("STOP a0"))
        self.assertGreaterEqual(done - self.costs["kDone"] + 2 * self.costs["kArgument"], begins)

    def test_what_is_set(self):
        one, two = (run(f"REMEMBER v = 0\nREMEMBER w = 0\n{behavior(body)}", FIRE)
                    for body in ("SET v TO 1", "SET v TO 1\nSET w TO 1"))
        self.assert_covers("kSet", two.feeds[-1] - one.feeds[-1])
        # The step that follows is dear, but the program's first one may be dearer.
        self.assert_covers("kChanged", max(two.ticks[1:]) - max(one.ticks[1:]))
        # Nothing but the rule that sets the variable is in the first one.
        first = one.ticks[0] - one.idle_tick - self.quiet - self.behavior - 29
        self.assert_covers("kTimedStep", first)

    def test_interruptions(self):
        none, one, two = (taken_over(move(0), move(*low, ms=2000)) for low in ((1, 2), (0, 1), (0, 1, 2)))
        less = taken_over(move(0), move(0, ms=2000)) - taken_over(move(0), move(1, ms=2000))
        self.assert_covers("kCancel", two - one)
        self.assert_covers("kInterrupt", less - (two - one))
        self.assertGreaterEqual(self.costs["kInterrupt"] + 2 * self.costs["kCancel"], one - none)

    def test_what_a_step_pays_for_what_is_there(self):
        when = "s c0 > 80 AND s c0 <= 91"  # it is evaluated at each of these readings
        text = behavior(move(0, ms=2000), when) + behavior(move(1, ms=2000), when, "WHILE", 10)
        orders = [feed(10), wait(), feed(80), wait(), feed(90), wait(), feed(91), wait(5)]
        both = run(text, orders).feeds
        self.assert_covers("kRunning", (both[-1] - both[1]) / 2)
        loses = run(text.replace("MOVE a1", "MOVE a0"), orders).feeds
        self.assert_covers("kWanting", loses[-1] - loses[1] - (both[-1] - both[1]) / 2)
        fading = "FEELING {} FROM 0% TO 100% START 50%\n FADES TO 0% OVER 60s\n"
        feels = [run("".join(fading.format(name) for name in names) +
                     behavior("\n".join(f"RAISE {name} BY 10%" for name in names)), FIRE).feeds[1]
                 for names in ("f", "fg")]
        none = run(f"REMEMBER v = 0\n{behavior('SET v TO 1')}", FIRE).feeds[1]
        self.assertGreaterEqual(self.costs["kFading"], feels[0] - none)
        self.assertGreaterEqual(self.costs["kFading"], feels[1] - feels[0])

    def test_what_goes_on(self):
        waits = run(behavior('WAIT 25ms\nLOG "x"'), FIRE)
        after = max(waits.ticks) - waits.idle_tick - self.text
        self.assertGreaterEqual(self.costs["kGoOn"] + self.costs["kTimedStep"], after)
        self.assertLessEqual(self.costs["kGoOn"], LOOSEST * (after - self.costs["kTimedStep"]) + SLACK)
        polls = run(behavior('WAIT UNTIL s c1 > 50\nLOG "x"'), [feed(10, 1), *FIRE, feed(15, 1), wait()]).feeds
        self.assertGreaterEqual(self.costs["kPoll"] + self.costs["kRunning"], polls[-1] - polls[2])

    def test_division_by_zero(self):
        runs = [run(behavior('LOG "x"', "s c1 / s c0 > 80"), [feed(10, 1), feed(10), wait(), feed(number), wait()])
                for number in (20, 0)]
        self.assert_covers("kZeroDivide", runs[1].feeds[-1] - runs[0].feeds[-1] - (self.rule - self.quiet))

    def test_an_actuator_that_is_served(self):
        done = run(behavior(move(0, ms=13)), FIRE)
        queued = run(behavior(move(0, 0, ms=13)), FIRE)
        self.assertGreaterEqual(self.costs["kService"] + VIRTUAL["kService"], max(done.ticks) - done.idle_tick)
        self.assert_covers("kService", max(queued.ticks) - queued.idle_tick)  # and begins the next one

    def test_safety(self):
        config = paths.robot()
        config["sensors"][0]["channels"]["c1"]["unit"] = "N"
        rule = "SAFETY g\n  WHEN s c1 > 50N\n  DO\n    {}\n  RESUME WHEN s c1 < 20N\nEND\n"
        orders = [feed(10), feed(10, 1), wait(20), feed(20, 1), wait(20), feed(90, 1), wait(20)]
        log = behavior('LOG "x"', "s c0 > 80 AND s c1 > 80N")
        none, one, two = (run(text + log, orders, config)
                          for text in ("", rule.format("STOP a0"), rule.format("STOP a0\n    STOP a1")))
        check, look = (Counter(tick for tick in measured.ticks if tick > measured.idle_tick + 100)
                       .most_common(1)[0][0] - measured.idle_tick for measured in (none, one))
        self.assertGreaterEqual(self.costs["kMonitor"] + self.costs["wake_by_timer"], check)
        said = self.costs["kGuard"] + 2 * self.costs["kSafetyRule"]
        self.assertGreaterEqual(said, look - check)
        self.assertLessEqual(said, LOOSEST * (look - check) + SLACK)
        self.assertGreaterEqual(self.costs["kHalt"] + VIRTUAL["kHalt"], two.feeds[-1] - one.feeds[-1])
        self.assertGreaterEqual(self.costs["kTrip"] + self.costs["kHalt"] + VIRTUAL["kHalt"],
                                one.feeds[-1] - one.feeds[2] - (none.feeds[-1] - none.feeds[2]))

    def test_safety_when_a_reading_is_too_old(self):
        """Until all are looked through nobody knows which one: then the ages of all that SAFETY reads are looked at."""
        old = 'BEHAVIOR b PRIORITY 50\n  WHEN old age > 5\n  DO\n    LOG "x"\n  END\nEND\n'
        inputs = 4
        reads = " OR ".join(f"s c{c} > 50N" for c in range(inputs))
        rule = f"SAFETY g\n  WHEN {reads}\n  DO\n    STOP a0\nEND\n"

        def ticks(text, fed, stale_ms):
            config = paths.robot()
            for channel in config["sensors"][0]["channels"].values():
                channel["unit"] = "N"
            config["sensors"].append({"name": "old", "type": "VIRTUAL",
                                      "channels": {"age": {"range": [0, 10], "stale_after": f"{stale_ms}ms"}}})
            measured = run(text, [*(feed(10, c) for c in range(fed)), feed(1, fed), wait(70)], config)
            return [tick - measured.idle_tick for tick in measured.ticks[60:]]

        # It grows too old in a period of the safety thread, or one tick behind one.
        together, apart = (max(ticks(rule + old, inputs, stale_ms)) for stale_ms in (30, 31))
        check = Counter(tick for tick in ticks(old, 0, 31) if tick > 200).most_common(1)[0][0]
        look = together - apart - check
        condition = inputs * (14 + 15)
        said = self.costs["kGuard"] + inputs * self.costs["kInput"] + self.costs["kSafetyRule"] + condition
        self.assertGreater(look, self.costs["kGuard"])  # it is in that tick
        self.assertGreaterEqual(said, look)

    def test_priorities_that_adapt(self):
        config = paths.robot() | {"scheduler": {"alpha": 5, "window": "105ms", "cap": 95}}
        text = "".join(behavior('LOG "x"', priority=50 + i) for i in range(4))
        orders = [*FIRE, wait(300)]
        turn = max(run(text, orders, config).ticks) - run(text, orders).idle_tick
        self.assert_covers("kRank", turn / 4)


class Sampling(unittest.TestCase):
    """A tick in which a sensor on the bus is read, and nothing new is read."""

    def worst(self, sensor, *conditions):
        config = paths.robot(1, [{"name": "t", **sensor}])
        rules = "".join(f'WHEN t {condition}\nDO LOG "x"\nEND\n' for condition in conditions)
        ticks = run(rules, [wait(200)], config)
        return max(ticks.ticks[20:]) - ticks.idle_tick

    WIRED = {"max34451": ({"type": "I2C", "address": "0x70", "device": "max34451",
                           "channels": {"L": {"input": 0, "range": [0, 10], "rate": "50Hz"}}}, "L > 5"),
             "i2c_register": ({"type": "I2C", "address": "0x48"}, "> 5"),
             "i2c_word": ({"type": "I2C", "address": "0x48", "device": "tmp105"}, "> 5C"),
             # In its place one that acknowledges all, and never is as it should be: it is told so again with each sample.
             "lsm303agr": ({"type": "I2C", "address": "0x19", "device": "lsm303agr"}, "X > 1g"),
             "lsm6dsl": ({"type": "I2C", "address": "0x6a", "device": "lsm6dsl"}, "X > 1g"),
             "mpu6050": ({"type": "I2C", "address": "0x68", "device": "mpu6050"}, "X > 1g"),
             "lis3mdl": ({"type": "I2C", "address": "0x1e", "device": "lis3mdl"}, "X > 1uT"),
             "encoder": ({"type": "GPIO", "pin": 43, "device": "encoder", "pulses_per_turn": 20, "wheel": "65mm"}, "DISTANCE > 3cm"),
             "hts221": ({"type": "I2C", "address": "0x5f", "device": "hts221"}, "HUMIDITY > 50%"),
             "digital_input": ({"type": "GPIO", "pin": 43, "device": "switch"}, "IS closed"),
             "hc_sr04": ({"type": "GPIO", "trigger": 3, "echo": 43, "device": "hc-sr04"}, "< 30cm"),
             "analog_input": ({"type": "ADC", "pin": 47}, "> 50%"),
             "spi_register": ({"type": "SPI", "pin": 37, "format": "int16le"}, "> 5"),
             "mcp3008": ({"device": "mcp3008", "pin": 37}, "> 50%")}

    def test_every_driver_that_samples(self):
        costs = paths.costs()
        for driver, said in paths.samples().items():
            if driver in ("pca9685", "ssd1306", "vl53l0x"):
                continue  # test_a_servo_chip(), test_a_display(), test_a_distance_sensor()
            with self.subTest(driver):
                self.assertIn(driver, self.WIRED, "nobody measures it")
                measured = self.worst(*self.WIRED[driver])
                # The safety monitor's periods are those of the program, and so are the sensor's.
                self.assertGreaterEqual(said + 2 * costs["wake_by_timer"] + costs["kMonitor"], measured)
                polled = self.POLLS if driver in ("spi_register", "mcp3008") else 0
                self.assertLessEqual(said, LOOSEST * (measured + polled))

    # Until a transfer on SPI is given up (boards/mps2-an386/spi.cpp), each six instructions. QEMU's transfers need none of them.
    POLLS = 3 * 48 * 6

    def test_a_part_on_spi(self):
        """Another channel of it, and all polls of a transfer that does not end."""
        for driver, level in (("spi_register", "5"), ("mcp3008", "50%")):
            wired = self.WIRED[driver][0] | {"channels": {"A": {}, "B": {}}}
            measured = self.worst(wired, f"A > {level}", f"B > {level}") - self.worst(wired, f"A > {level}") + self.POLLS
            said = paths.samples()[driver]
            print(f"\n  {driver}: {measured}, said {said}")
            self.assertGreaterEqual(said, measured)
            self.assertLessEqual(said, LOOSEST * measured + SLACK)

    def test_a_distance_sensor(self):
        """The one here has another name, so it is not told to measure: two transfers of seven bytes more are said."""
        costs = paths.costs()
        measured = self.worst({"type": "I2C", "address": "0x29", "device": "vl53l0x"}, "< 30cm")
        said = 2 * costs["i2c_transfer"] + 20 * costs["i2c_byte"]
        print(f"\n  a distance sensor: {measured}, said {said}")
        self.assertGreaterEqual(said + 2 * costs["wake_by_timer"] + costs["kMonitor"], measured)
        self.assertLessEqual(said, LOOSEST * measured)
        self.assertEqual(paths.samples()["vl53l0x"], said + 2 * costs["i2c_transfer"] + 7 * costs["i2c_byte"])

    def test_a_servo_chip(self):
        """It is asked how it stands. The one here is never as it was set up, so it is set up again in each frame: six transfers more, each
        of which is taken in the tick in which the next is asked for. What a pulse takes is one of them."""
        costs = paths.costs()
        config = paths.robot()
        config["actuators"] = [{"name": "a0", "type": "I2C", "address": "0x4a", "channel": 3, "enable": 36, "device": "pca9685_servo"}]
        ticks = run(behavior("MOVE a0 TO 180deg OVER 1s"), [feed(10), wait(200)], config)
        measured = max(ticks.ticks[20:]) - ticks.idle_tick
        said = costs["i2c_ask"] + costs["i2c_transfer"] + 6 * costs["i2c_byte"]
        print(f"\n  a servo chip that is set up: {measured}, said {said}")
        self.assertGreaterEqual(said + 2 * costs["wake_by_timer"] + costs["kMonitor"], measured)
        self.assertLessEqual(said, LOOSEST * measured)
        self.assertEqual(paths.samples()["pca9685"], costs["i2c_transfer"] + 4 * costs["i2c_byte"])

    def test_a_display(self):
        """Until all has been drawn once it gets as many portions in a frame as it ever does: each is taken in the tick in which the next
        is asked for."""
        costs = paths.costs()
        config = paths.robot() | {"actuators": [{"name": "a0", **ActuatorDrivers.DISPLAY}]}
        ticks = run(behavior("SHOW a0 happy"), [feed(10), wait(300)], config)
        measured = max(ticks.ticks[20:]) - ticks.idle_tick
        said = costs["i2c_ask"] + paths.samples()["ssd1306"]
        print(f"\n  a display that is drawn: {measured}, said {said}")
        self.assertGreaterEqual(said + 2 * costs["wake_by_timer"] + costs["kMonitor"], measured)
        self.assertLessEqual(said, LOOSEST * measured)

    def test_an_echo(self):
        """It is asked for 40 ms before its sample. The edges that follow, this board has not: tests/e2e/test_sonar.py counts them."""
        sonar, _ = self.WIRED["hc_sr04"]
        ticks = run('WHEN t < 30cm\nDO LOG "x"\nEND\n', [wait(200)], paths.robot(1, [{"name": "t", **sonar}]))
        period, before = 67, 40
        asking = {ticks.ticks[at - before] - ticks.idle_tick for at in (period, 3 * period)}
        print(f"\n  asking for an echo: {asking}")
        costs = paths.costs()
        self.assertGreaterEqual(costs["ping"] + costs["wake_by_timer"], max(asking))
        self.assertLessEqual(costs["ping"], LOOSEST * min(asking))

    def test_an_input_pin(self):
        """Another channel of it. The last pin is the one that takes longest."""
        switch = {"type": "GPIO", "pin": 43, "device": "switch", "channels": {"A": {"input": 0}, "B": {"input": 0}}}
        measured = self.worst(switch, "A IS closed", "B IS closed") - self.worst(switch, "A IS closed")
        said = paths.samples()["digital_input"]
        print(f"\n  an input pin: {measured}, said {said}")
        self.assertGreaterEqual(said, measured)
        self.assertLessEqual(said, LOOSEST * measured + SLACK)

    def test_an_analog_input(self):
        """Another channel of it, on the pin that takes longest. What a converter takes that does not answer, tests/e2e/test_analog.py counts."""
        wired = {"type": "ADC", "pin": 47, "channels": {"A": {}, "B": {}}}
        measured = self.worst(wired, "A > 50%", "B > 50%") - self.worst(wired, "A > 50%")
        said = paths.samples()["analog_input"]
        print(f"\n  an analog input: {measured}, said {said}")
        self.assertGreaterEqual(said, measured)
        self.assertLessEqual(said, LOOSEST * measured + SLACK)


class ActuatorDrivers(unittest.TestCase):
    """Each call of each driver, by itself: from its first instruction to where the control layer goes on."""

    SERVO = {"type": "PWM", "pin": "3", "device": "servo", "range": ["0deg", "180deg"]}
    PWM = {"type": "PWM", "pin": "3", "device": "pwm", "on_release": "hold"}
    MOTOR = {"type": "PWM", "pins": [3, 4], "device": "motor", "on_release": "hold", "limits": {"SPEED": "98%"}}
    DRIVE = {"type": "PWM", "left": [3, 4], "right": [5, 6], "speed": "41cm/s", "track": "12.3cm", "trim": {"right": "97%"},
             "device": "differential_drive"}
    ELSEWHERE = {"lights", "tones", "ws2812_face", "ws2812_strip"}  # the reference board has none: tests/e2e/on_microbit.py
    CHIP = {"type": "I2C", "address": "0x4a", "channel": 3, "enable": 36, "device": "pca9685_servo"}
    DISPLAY = {"type": "I2C", "address": "0x3c", "device": "ssd1306"}
    # Orders that take long ways through the arithmetic: long times, divisors that need more than 16 bits.
    WIRED = {
        "virtual_actuator": ({"type": "VIRTUAL"}, ["MOVE a0 TO 1% OVER 13ms", "MOVE a0 TO 1% FOR 60s"]),
        "virtual_motion": ({"type": "VIRTUAL", "device": "servo", "range": ["0deg", "180deg"]},
                           ["MOVE a0 TO 33deg OVER 50ms", "MOVE a0 2 TIMES OVER 70ms", "MOVE a0 2 TIMES OVER 5273ms",
                            "MOVE a0 TO 178deg AT 66deg/s\nWAIT 200ms\nMOVE a0 TO 1deg AT 66deg/s",
                            "MOVE a0 TO 77.7deg OVER 36000s\nWAIT 77ms\nMOVE a0 TO 1.3deg OVER 36000s"]),
        "virtual_output": ({"type": "VIRTUAL", "device": "matrix"},
                           ["SHOW a0 happy FOR 50ms", "BLINK a0", "BLINK a0 3 TIMES OVER 133ms", "BLINK a0 700 TIMES OVER 36000s"]),
        "player": ({"type": "UART", "device": "dfplayer"}, ["PLAY a0 FOR 50ms", "PLAY a0 FOR 60s"]),
        "pwm": (PWM, ["RUN a0 TO 33%", "RUN a0 TO 33% FOR 50ms", "RUN a0 TO 99% OVER 150ms FOR 50ms",
                      "RUN a0 TO 99% OVER 250ms\nWAIT 70ms\nRUN a0 TO 3% OVER 250ms",
                      "RUN a0 TO 99% OVER 36000s\nWAIT 70ms\nRUN a0 TO 3% OVER 36000s"]),
        "motor": (MOTOR, ["RUN a0 TO 33%", "RUN a0 BACKWARD AT 33% FOR 50ms", "RUN a0 TO -97% OVER 150ms FOR 50ms",
                          "RUN a0 TO 97% OVER 250ms\nWAIT 70ms\nRUN a0 TO -97% OVER 250ms", "RUN a0 TO 97%\nWAIT 1ms\nRUN a0 TO -97%",
                          "RUN a0 TO 97% OVER 36000s\nWAIT 70ms\nRUN a0 TO -97% OVER 36000s"]),
        "differential_drive": (DRIVE, ["DRIVE a0 FORWARD 1.3cm AT 17cm/s", "DRIVE a0 BACKWARD 150m OVER 36000s", "TURN a0 LEFT 7deg",
                                       "TURN a0 RIGHT 1999deg OVER 777s", "SPIN a0 LEFT AT 7cm/s FOR 50ms", "SPIN a0 3 TIMES",
                                       "DRIVE a0 FORWARD 150m\nWAIT 70ms\nTURN a0 LEFT 9deg OVER 50ms"]),
        "servo": (SERVO, ["MOVE a0 TO 33deg OVER 50ms", "MOVE a0 2 TIMES OVER 70ms", "MOVE a0 2 TIMES OVER 5273ms",
                          "MOVE a0 TO 178deg AT 66deg/s\nWAIT 200ms\nMOVE a0 TO 1deg AT 66deg/s",
                          "MOVE a0 TO 77.7deg OVER 36000s\nWAIT 77ms\nMOVE a0 TO 1.3deg OVER 36000s"]),
    }
    WIRED["pca9685_servo"] = (CHIP, WIRED["servo"][1])
    WIRED["ssd1306_face"] = (DISPLAY, ["SHOW a0 happy", "SHOW a0 sad FOR 50ms", "BLINK a0 3 TIMES OVER 133ms", "BLINK a0 700 TIMES OVER 36000s"])

    def calls(self, wiring, order, *more, sensors=()):
        """{call: [instructions]}; what a call calls of its own driver counts with it."""
        known = [(name.split("(")[0].split("::"), at) for name, at in counting.symbols(paths.FIRMWARE).items()]
        drivers = {at: words[-1] for words, at in known
                   if "drivers" in words and words[-1] in ("start", "advance", "release")}
        others = [at for words, at in known if {"ControlLayer", "Trace", "Kernel"} & set(words)]
        marks = {f"{at:#x}": at for at in {*drivers, *others}}
        config = paths.robot() | {"actuators": [{"name": "a0", **wiring}]}
        config["sensors"] = [*config["sensors"], *sensors]
        text = behavior(order) + "".join(more) + behavior("STOP a0", "s c0 < 8", priority=95)
        orders = [feed(10), wait()] + [step for value in (90, 10, 95, 20, 99, 5, 90) for step in (feed(value), wait(130))]
        measured = run(text, orders, config, marks.items())
        found, outer = {}, None
        for name, count in measured.marks.all:
            at = marks.get(name)
            if outer and at not in drivers:
                found.setdefault(outer[0], []).append(count - outer[1])
                outer = None
            elif at in drivers and not outer:
                outer = (drivers[at], count)
        return found

    # One movement, or one that replaces another: ahead, behind, too close, slower, with long times; or a STOP.
    TAKES_OVER = "MOVE a0 TO 120deg AT 30deg/s", "MOVE a0 TO 0deg", "MOVE a0 TO 177deg OVER 36000s", "MOVE a0 2 TIMES OVER 5273ms", "STOP a0"
    RAMPED = [*((order,) for order in ("MOVE a0 TO 33deg OVER 50ms", "MOVE a0 TO 178deg OVER 5273ms", "MOVE a0 2 TIMES OVER 5273ms",
                                       "MOVE a0 2 TIMES AT 70deg/s", "MOVE a0 TO 77.7deg OVER 36000s",
                                       "MOVE a0 TO 1.3deg OVER 77ms\nMOVE a0 TO 2.9deg OVER 977ms")),
              *(("MOVE a0 TO 178deg AT 66deg/s", behavior(order, "s c0 > 93", priority=92)) for order in TAKES_OVER),
              *(("WAIT 1ms", behavior(f"FOLLOW a0 TO ({target}) AT 66deg/s", "s c0 > 8", "WHILE", 85))
                for target in ("s c0 * 2deg", "100deg + s c0 * 1deg", "180deg - s c0 * 1.7deg"))]

    def test_ramps(self):
        """What a limit of acceleration adds to each call of the drivers that have one."""
        print()
        costs, most = paths.costs(), Counter()
        for driver in ("servo", "pca9685_servo", "virtual_motion"):
            wiring = self.WIRED[driver][0] | {"limits": {"ACCELERATION": "123deg/s2"}}
            said = paths.actuator_drivers()[driver]
            with self.subTest(driver):
                measured = {}
                for orders in self.RAMPED:
                    for call, counts in self.calls(wiring, *orders).items():
                        measured[call] = max([measured.get(call, 0), *counts])
                print(f"  {driver} with ramps: {measured}")
                for call, count in measured.items():
                    more = costs["kOnRamp" if call == "release" else "kRampBegins"]
                    self.assertGreaterEqual(said[call] + more, count, call)
                    most[call] = max(most[call], count - said[call])
        self.assertLessEqual(costs["kRampBegins"], LOOSEST * max(most["start"], most["advance"]) + SLACK)
        self.assertLessEqual(costs["kOnRamp"], LOOSEST * most["release"] + SLACK)

    ENCODERS = [{"name": name, "type": "GPIO", "device": "encoder", "pin": pin, "pulses_per_turn": 499, "wheel": "65mm",
                 "channels": {"DISTANCE": {}}} for name, pin in (("l", 42), ("r", 43))]

    def test_a_drive_with_encoders(self):
        """What they add to the calls of a drive; a release takes no longer with them."""
        print()
        costs, said = paths.costs(), paths.actuator_drivers()["differential_drive"]
        wiring = self.DRIVE | {"encoders": ["l", "r"], "simulated_difference": "7%"}
        measured = {}
        for order in self.WIRED["differential_drive"][1]:
            for call, counts in self.calls(wiring, order, sensors=self.ENCODERS).items():
                measured[call] = max([measured.get(call, 0), *counts])
        print(f"  differential_drive with encoders: {measured}")
        self.assertGreaterEqual(said["release"], measured["release"])
        for call, name in (("start", "kWheelsBegin"), ("advance", "kWheelsSeen")):
            with self.subTest(call):
                self.assertGreaterEqual(said[call] + costs[name], measured[call])
                self.assertLessEqual(said[call] + costs[name], LOOSEST * measured[call] + SLACK)

    def test_every_driver(self):
        print()
        for driver, said in paths.actuator_drivers().items():
            if driver in self.ELSEWHERE:
                continue
            with self.subTest(driver):
                self.assertIn(driver, self.WIRED, "nobody measures it")
                wiring, orders = self.WIRED[driver]
                measured = {}
                for order in orders:
                    for call, counts in self.calls(wiring, order).items():
                        measured[call] = max([measured.get(call, 0), *counts])
                print(f"  {driver}: {measured}, said {said}")
                for call, count in measured.items():
                    self.assertGreaterEqual(said[call], count, call)
                    self.assertLessEqual(said[call], LOOSEST * count + SLACK, call)

    def test_a_halt_of_what_moves(self):
        """The guard switches off more for a motor than for a virtual actuator, and most for a drive: a driver's release has room for that."""
        config = paths.robot()
        config["sensors"][0]["channels"]["c1"]["unit"] = "N"
        rule = "SAFETY g\n  WHEN s c1 > 50N\n  DO\n    STOP a0\n  RESUME WHEN s c1 < 20N\nEND\n"
        orders = [feed(10), feed(10, 1), wait(20), feed(20, 1), wait(20), feed(90), wait(20), feed(90, 1), wait(20)]

        def halted(wiring, order):
            return run(rule + behavior(order), orders, config | {"actuators": [{"name": "a0", **wiring}]}).feeds[-1]

        least = halted({"type": "VIRTUAL"}, "MOVE a0 FOR 60s")
        for driver, wiring, order in (("motor", self.MOTOR, "RUN a0 TO 50% FOR 60s"),
                                      ("differential_drive", self.DRIVE, "DRIVE a0 FORWARD 99m AT 17cm/s"),
                                      ("differential_drive", self.DRIVE, "TURN a0 LEFT 9999deg")):
            more, said = halted(wiring, order) - least, paths.actuator_drivers()[driver]["release"] - DRIVER["release"]
            print(f"\n  a halt of {order}: {more} more, said {said}")
            self.assertGreaterEqual(said, more)


class Kernel(unittest.TestCase):
    """What bench/ measures is not measured again."""

    def test_costs_of_the_kernel(self):
        costs = paths.costs()
        recorded = json.loads((paths.ROOT / "bench/recorded.json").read_text())
        for name, *figures in (("switch_threads", "switch_isolated"), ("wake", "post_to_run_isolated"),
                               ("tick", "tick"), ("wake_by_timer", "tick_to_sleeper", "timed_block")):
            measured = sum(recorded[f"kernel/{figure}"] for figure in figures)
            self.assertGreaterEqual(costs[name], measured, name)
            self.assertLessEqual(costs[name], LOOSEST * measured + SLACK, name)


class Algorithms(unittest.TestCase):
    """What the modules of the firmware declare, and what it takes to give one a sample, behind its MPU."""

    INTERRUPTS = ("SysTick_Handler", "Uart0Receive_Handler", "Uart0Transmit_Handler")
    # The program that uses it, and its recording.
    MODULES = {"touch_levels": ("feeling", stimuli.touches, stimuli.FEELING_UNITS),
               "imu_gestures": ("moving", stimuli.motions, stimuli.MOVING_UNITS),
               "sound_events": ("hearing", stimuli.sounds, stimuli.HEARING_UNITS),
               "pitch": ("singing", stimuli.songs, stimuli.HEARING_UNITS)}
    # Interrupts come into its blocks, which are long, so they are counted in bench/firmware/words_bench.cpp.
    LONG = "own_words"
    LAYER = "robosync::layers::AlgorithmLayer::"

    def test_every_module(self):
        costs, listed = paths.costs(), (paths.ROOT / "runtime-m4/algorithms/modules.def").read_text()
        self.assertEqual(set(re.findall(r"^MODULE\((\w+)", listed, re.M)), {*self.MODULES, self.LONG})
        for module in self.MODULES:
            with self.subTest(module):
                process = f"{module}_process"
                marks = self.run_with(module, process)
                alone = self.spans(marks, process)
                whole = self.spans(marks, "latch", within=process)
                declared = self.declared(module)
                print(f"  {module}: {max(alone)}, said {declared}; with what is around it {max(whole)}")
                for said, measured in ((declared, max(alone)), (costs["kAlgorithm"], max(whole) - max(alone))):
                    self.assertGreaterEqual(said, measured)
                    self.assertLessEqual(said, LOOSEST * measured + SLACK)

    @staticmethod
    def declared(module):
        source = (paths.ROOT / f"runtime-m4/algorithms/{module}.c").read_text()
        return int(re.search(r"uint32_t cost\(.*?return (\d+);", source, re.S)[1])

    def test_words(self):
        said = self.declared(self.LONG)
        measured = max(counting.run(counting.BUILT / "bench_words").spans("mark_words_begin", "mark_words_end"))
        print(f"  {self.LONG}: {measured}, said {said}")
        self.assertGreaterEqual(said, measured)
        self.assertLessEqual(said, LOOSEST * measured + SLACK)

    def run_with(self, module, process):
        """The shipped firmware with the module's recording; where it comes by."""
        latch, collect = self.LAYER + "latch_inputs(", self.LAYER + "collect("
        marks = {process: counting.symbols(FIRMWARE)[process], "latch": counting.functions(latch)[latch],
                 **{handler: counting.begin_of(handler) for handler in self.INTERRUPTS}}
        marks |= {f"end of {name} {i}": at for name, function in ((process, process), ("latch", collect))
                  for i, at in enumerate(counting.ends_of(function))}
        with tempfile.TemporaryDirectory() as folder:
            scenario, out = Path(folder) / "scenario.json", Path(folder) / "marks"
            # A board that skips its idle time may be ahead of a busy machine all the way; one that keeps to the clock
            # of the wall is not.
            for icount, lead_ms in ((FAST, 6_000), (REAL_TIME, 6_000), (REAL_TIME, 20_000)):
                with Board(icount=icount, extra=counting.plugin_arguments(marks, out)) as board:
                    until_ms, refused = self.feed(module, scenario, board, lead_ms)
                    if not refused:
                        counting.wait_for_readings(out, until_ms // 20, process)
                        break
            else:
                self.fail(refused)
            return counting.Marks(marks, out).all

    def feed(self, module, scenario, board, lead_ms):
        """The time of the last reading, and what rsc says when it could not feed them all in time."""
        name, recording, units = self.MODULES[module]
        program, readings = paths.ROOT / f"tests/e2e/programs/{name}.rsl", recording(0)
        scenario.write_text(json.dumps({"stimuli": [
            {"at": f"{lead_ms + r.at_ms}ms", "sensor": r.channel.split(".")[0], "channel": r.channel.split(".")[1],
             "value": f"{r.value}{units[r.channel]}"} for r in readings]}))
        done = rsc.call("feed", "--upload", program, "--config", program.with_suffix(".json"), "--fresh",
                        "--scenario", scenario, "--port", board.port)
        return lead_ms + readings[-1].at_ms, done.stderr if done.returncode else ""

    @staticmethod
    def spans(marks, name, within=None):
        """Instructions from `name` to its end, of those that no interrupt came into."""
        found, start = [], None
        for mark, count in marks:
            if mark == name:
                start = count
            elif start is not None and mark.startswith(f"end of {name}"):
                found.append(count - start)
                start = None
            elif within is None or within not in mark:
                start = None
        return found


def drawn_orders(channels, draw):
    """Readings at random times, many of them at the ends of the ranges; and long pauses."""
    orders = [feed(low, number) for number, low, _ in channels]
    for _ in range(150):
        number, low, high = draw.choice(channels)
        value = draw.choice((low, high, draw.uniform(low, high)))
        orders += [feed(value, number), wait(draw.choice((1, 3, 20, 100, 600)))]
    return orders


def measured_apart(rows):
    """A table's rows without what was measured, and that."""
    cells = r"(?m)^(\| \S+ \| )([\d,]+)( \| [\d,]+ \|)$"
    measured = [int(number.replace(",", "")) for _, number, _ in re.findall(cells, rows)]
    return re.sub(cells, r"\1\3", rows), measured


class Paths(unittest.TestCase):
    """Of every example, with all its sensors fed: no reading takes longer than is said until all that it causes in
    its step is done."""

    def test_examples(self):
        rows = []
        for program, _ in examples():
            with self.subTest(program.parent.name), tempfile.TemporaryDirectory() as folder:
                if worst := self.check(program, Path(folder)):
                    measured, said = worst
                    rows.append((said, f"| `{program.parent.name}` | {measured:,} | {said:,} |\n"))
        self.assert_shown("".join(row for _, row in sorted(rows)))

    def assert_shown(self, table):
        """ROBOSYNC_UPDATE_GOLDEN=1 rewrites what the page shows. What is measured may differ by a twentieth, as the page says: which
        readings come together at random times changes with every few instructions of the firmware."""
        page = PAGE.read_text()
        before, head, rest = page.partition("| example | measured | said |\n|---|---|---|\n")
        shown, _, after = rest.partition("\n\n")
        if "ROBOSYNC_UPDATE_GOLDEN" in os.environ:
            PAGE.write_text(before + head + table + "\n" + after)
        else:
            self.assertEqual(*(measured_apart(rows)[0] for rows in (shown + "\n", table)))
            for before, now in zip(*(measured_apart(rows)[1] for rows in (shown, table))):
                self.assertAlmostEqual(before, now, delta=now / 20)

    def test_with_sampling(self):
        """From the tick at which the sensor on the bus is due."""
        for name in ("touch_companion", "tickle_companion", "housemate"):
            program = paths.ROOT / "examples" / name / "robot.rsl"
            config = program.with_suffix(".json")
            with self.subTest(name), tempfile.TemporaryDirectory() as folder:
                image = Path(folder) / "p.rsb"
                paths.compiled(program, config, image)
                worst = max(paths.Run(image, [wait(400)]).ticks)
                said = self.said(program, config)["touch"]
                print(f"\n  {name}: from the tick on, {worst} instructions, said {said}")
                self.assertGreater(worst, paths.samples()["max34451"] / 2)
                self.assertLessEqual(worst, said)

    def test_with_an_algorithm(self):
        """From the tick at which it is released, on what was fed last."""
        program = paths.ROOT / "tests/e2e/programs/feeling.rsl"
        config = program.with_suffix(".json")
        with tempfile.TemporaryDirectory() as folder:
            image = Path(folder) / "p.rsb"
            paths.compiled(program, config, image)
            worst = max(paths.Run(image, [feed(8, 0), wait(200), feed(0, 0), wait(200)]).ticks)
            said = self.said(program, config)["skin"]
            print(f"\n  from the tick on, {worst} instructions, said {said}")
            self.assertGreater(worst, paths.costs()["kAlgorithm"])
            self.assertLessEqual(worst, said)

    def check(self, program, folder):
        wiring = without_parts(on_board.read(program.with_suffix(".json")))
        wiring["sensors"] = [sensor if sensor["type"] == "VIRTUAL" or sensor["name"] in turned(wiring) else fed(sensor)
                             for sensor in wiring["sensors"]]
        config, image = folder / "robot.json", folder / "p.rsb"
        config.write_text(json.dumps(wiring))
        paths.compiled(program, config, image)
        said = self.said(program, config)
        sensor, waits, channels, names = None, False, [], {}
        for line in subprocess.run([paths.RSC, "dump", image], check=True, capture_output=True, text=True,
                                   ).stdout.partition("\nactuators")[0].splitlines():
            if found := re.match(r"  (\w+): ", line):
                sensor, waits = found[1], line.endswith("when fed")  # others are made by algorithms
            found = re.match(r"    channel (\d+) .*range (-?[\d.]+)\S* … (-?[\d.]+)", line)
            if found and waits:
                channels.append((int(found[1]), float(found[2]), float(found[3])))
                names[int(found[1])] = sensor
        orders = drawn_orders(channels, random.Random(1))
        measured = paths.Run(image, orders)
        readings = [channel for channel, value in orders if value != paths.PAUSE]
        ways = [(count, said[names[channel]]) for count, channel in zip(measured.feeds, readings) if names[channel] in said]
        for count, bound in ways:
            self.assertLessEqual(count, bound, program)
        return max(ways, default=None)

    def said(self, program, config):
        checked = subprocess.run([paths.RSC, "check", "--timing", program, "--config", config, "--format", "json"],
                                 check=False, capture_output=True, text=True)
        self.assertEqual(checked.returncode, 0, checked.stderr)
        responses = json.loads(checked.stdout)["timing"][0]["responses"]
        return {path["sensor"]: path["base"]["instructions"] for path in responses["paths"]}


if __name__ == "__main__":
    unittest.main()

"""What every board must do: it boots, names itself, runs an example as the host does, and stops."""

import json
import unittest

import examples
import rsc
import stimuli
from board import NAME
from support import PROFILE, PROGRAMS
from traces import TraceTest

COMPANION = rsc.ROOT / "examples/touch_companion"
SAFETY_PERIOD_US = 30_000  # without a program
READINGS_SEED = 475
BY_I2C = """{"board": "%s", "actuators": [],
 "sensors": [{"name": "touch", "type": "I2C", "bus": %d, "address": "0x70", "device": "max34451",
              "channels": {"LEVEL": {"input": 0}}}]}"""


class EveryBoard(TraceTest):
    def test_it_says_what_it_is(self):
        said = rsc.info(self.board.port)
        board, status = said["board"], said["status"]
        self.assertEqual(board["name"], NAME)
        self.assertEqual(board["memory"]["bytes"], PROFILE["arena"]["bytes"])
        self.assertEqual(board["memory"]["arena_begin"], int(PROFILE["arena"]["begin"], 16))
        self.assertEqual(board["step_budget"], PROFILE["step_budget"])
        self.assertIsNone(board["program"])
        self.assertEqual((status["reset_reason"], status["faults"]), ("power", 0))
        self.assertIn(f"board     {NAME},", rsc.run("info", "--port", self.board.port))

    def test_its_time_goes_on_evenly(self):
        """The safety monitor never comes late, however the core sleeps and is woken by the line."""
        statuses = [self.status() for _ in range(20)]
        passed = statuses[-1]["uptime_us"] - statuses[0]["uptime_us"]
        checks = statuses[-1]["safety_checks"] - statuses[0]["safety_checks"]
        self.assertGreater(passed, 0)
        self.assertEqual(sorted(s["uptime_us"] for s in statuses), [s["uptime_us"] for s in statuses])
        self.assertAlmostEqual(checks, passed / SAFETY_PERIOD_US, delta=2)
        self.assertEqual(statuses[-1]["safety_late_us"], 0)

    def test_the_companion_does_what_it_does_on_the_host(self):
        config = self.folder / "companion.json"
        config.write_text(json.dumps(examples.config(COMPANION)))
        self.units = examples.units(COMPANION)
        lines = self.check(COMPANION / "robot.rsl", examples.drawn(COMPANION, READINGS_SEED), config)
        self.assertTrue(any('"verb":"MOVE"' in line for line in lines))

    def test_the_papers_program_does_what_it_does_on_the_host(self):
        lines = self.check(PROGRAMS / "paper.rsl", stimuli.touch(0, 1, 2, 3, 4, 5, 2, 2, 10, 0))
        self.assertTrue(any("greeting.wav" in line for line in lines))

    def test_stop_holds_until_resume(self):
        config = self.folder / "companion.json"
        config.write_text(json.dumps(examples.config(COMPANION)))
        self.upload(self.compile(COMPANION / "robot.rsl", config))
        for verb, stopped in (("stop", True), ("resume", False)):
            rsc.run(verb, "--port", self.board.port)
            self.assertEqual(rsc.info(self.board.port)["board"]["stopped"], stopped)

    def test_what_it_has_not_is_refused_before(self):
        config, program = self.folder / "robot.json", self.folder / "robot.rsl"
        config.write_text(BY_I2C % (NAME, PROFILE["i2c_buses"]))
        program.write_text("BEHAVIOR none PRIORITY 1\nEND\n")
        done = rsc.call("check", program, "--config", config)
        self.assertEqual(done.returncode, 1)
        self.assertIn(f"the board {NAME} has no I2C bus {PROFILE['i2c_buses']}", done.stderr)


if __name__ == "__main__":
    unittest.main()

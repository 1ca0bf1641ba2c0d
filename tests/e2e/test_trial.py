"""A program on trial on the shipped firmware: it is kept when it passes, and the kept one comes back when it fails or the power goes.
ROBOSYNC_BOARD selects the board."""

import json
import sys
import unittest
from pathlib import Path

import player
import rsc
import touched
from board import FIRMWARE, NAME, REAL_TIME
from debugger import INTERPRETER, Debugger
from support import PROGRAMS, LineReader
from test_isolation import CONFIG, PROGRAM
from test_store import PATIENCE, Switched
from touched import LINE, WILD

sys.path.append(str(Path(__file__).resolve().parents[2] / "bench"))
from counting import symbols  # noqa: E402

# From power-up to the first step. A board of 80 MHz reads a store of 512 KB at less than half its pace here: REAL_TIME counts 32 ns for
# an instruction. `scripts/bench --only board` counts 16 ns.
SOON_US = 200_000 if player.is_needed() else 100_000
STARTS = 3  # idle time of the robot is real time here, in which this machine may stall
LARGEST_SOON = 4_096  # bytes of the largest image that starts so soon
FED_CONFIG = {
    "board": NAME, "sensors": [{"name": "touch", "type": "VIRTUAL", "channels": {"LEVEL": {"range": [0, 10]}}}],
    "actuators": [{"name": "arm", "type": "VIRTUAL", "device": "joint", "range": ["0deg", "120deg"]}]}
FED_PROGRAM = """SAFETY pressed
  WHEN touch LEVEL > 5
  DO STOP ALL
END
WHEN touch LEVEL < 3 DO
  MOVE arm TO 90deg
END
"""


class Trial(Switched):
    icount = REAL_TIME

    def test_it_starts_with_the_program_that_stood_its_trial(self):
        first, second = self.images()
        self.assertIsNone(self.running())
        kept = self.keep(first)
        self.assertLess(first.stat().st_size, LARGEST_SOON)
        for switched in (self.power_cycle, lambda: self.board.reset()):
            self.assertLessEqual(min(self.started_after(switched, kept) for _ in range(STARTS)), SOON_US)
        said = self.upload(second)
        self.assertRegex(said, r"kept in [0-5]\.\d s if it passes its trial: if a SAFETY rule trips .* the robot returns to the program kept before")
        self.assertNotEqual(self.running(), kept)
        self.power_cycle()  # in its trial
        self.await_kept("kept")
        self.assertEqual(self.running(), kept)

    def started_after(self, switched, kept):
        """Microseconds from power-up to the start of the kept program."""
        switched()
        self.await_kept("kept")
        self.assertEqual(self.running(), kept)
        status = self.status()
        return status["uptime_us"] - status["program_us"]

    def test_one_that_is_only_tried_is_not_called_kept(self):
        first, second = self.images()
        kept = self.keep(first)
        said = self.upload(second, "--no-confirm", "--trial", "300ms")
        self.assertIn("not kept: its trial is over; the program kept before runs again", said)
        self.assertEqual(self.running(), kept)
        self.assertIn("only on trial: the kept program comes back in ", self.upload(second, "--no-confirm"))
        self.assertIn("only on trial: the kept program comes back in ", rsc.run("info", "--port", self.board.port))

    def test_feed_says_that_its_program_failed_its_trial(self):
        kept = self.keep(self.images()[0])
        config, program = self.folder / "fed.json", self.folder / "fed.rsl"
        config.write_text(json.dumps(FED_CONFIG))
        program.write_text(FED_PROGRAM)
        fed = ("feed", "--upload", program, "--config", config, "--watch", "500ms", "--port", self.board.port)
        done = rsc.call(*fed, "touch.LEVEL=9")
        self.assertEqual(done.returncode, 1, done.stderr)
        self.assertIn(f"{program} failed its trial", done.stderr)
        self.assertEqual(self.running(), kept)
        rsc.run(*fed, "touch.LEVEL=1")
        self.assertNotEqual(self.running(), kept)

    def test_an_upload_says_that_a_rule_over_what_nobody_has_fed_tripped_at_once(self):
        kept = self.keep(self.images()[0])
        config, program = self.folder / "fed.json", self.folder / "fed.rsl"
        config.write_text(json.dumps(FED_CONFIG))
        program.write_text(FED_PROGRAM.replace("touch", "pad"))
        config.write_text(config.read_text().replace('"touch"', '"pad"'))
        done = rsc.call("upload", program, "--config", config, "--port", self.board.port)
        self.assertEqual(done.returncode, 1, done.stdout)
        self.assertIn("failed its trial", done.stderr)
        self.assertEqual(self.running(), kept)
        done = rsc.call("feed", "pad.LEVEL=1", "--port", self.board.port)
        self.assertEqual(done.returncode, 1)
        self.assertRegex(done.stderr, "no sensor `pad`(.|\\n)*which was uploaded before, failed its trial")

    @unittest.skipIf(player.is_needed(), "QEMU has no flash controller of this board: the debugger plays it and is not free for a fault")
    def test_a_behaviour_that_faults_in_its_trial_brings_the_kept_program_back(self):
        kept = self.keep(self.compile(PROGRAMS / "priorities.rsl"))
        gdb = self.folder / "gdb"
        self.power_cycle("-gdb", f"unix:{gdb},server=on,wait=off", *touched.arguments(self.folder))
        hand = touched.Hand(self.board, self.folder)
        self.addCleanup(hand.close)
        config, program = self.folder / "robot.json", self.folder / "program.rsl"
        config.write_text(json.dumps(CONFIG))
        program.write_text(PROGRAM)
        rsc.run("upload", program, "--config", config, "--port", self.board.port)
        reader = LineReader("monitor", "--port", self.board.port, "--format", "json")
        interpreter = next(at for name, at in symbols(FIRMWARE).items() if name.startswith(INTERPRETER))
        with Debugger(gdb) as debugger:
            debugger.run_to(interpreter, lambda: hand.touch(WILD))
            debugger.set_register(0, LINE)
        self.assertTrue(reader.wait_for(lambda lines: any('"fault"' in line for line in lines[1:]), PATIENCE), reader.lines)
        reader.stop()
        given_up = self.await_kept("kept")["given_up"]
        self.assertIsNotNone(given_up)
        self.assertEqual(self.running(), kept)
        self.assertIn(f"given up  program {given_up}: ", rsc.run("info", "--port", self.board.port))


if __name__ == "__main__":
    unittest.main()

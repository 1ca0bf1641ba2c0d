"""Uploading while the robot runs: nothing stops, nothing restarts, safety never pauses."""

import json
import time
import unittest
from pathlib import Path

import periods
import rsc
from board import FAST, NAME, REFERENCE, Board
from support import CONFIG, PROGRAMS, LineReader, RobotTest

SAFETY_PERIOD_US = 1000 * periods.safety_ms()


class Upload(RobotTest):
    def test_uptime_and_safety_go_on(self):
        self.upload(self.compile(PROGRAMS / "paper.rsl"))
        before = self.status()
        images = [self.compile(PROGRAMS / f"{name}.rsl")
                  for name in ("priorities", "conditions", "arithmetic", "paper")]
        for image in images * 3:
            self.upload(image)
        after = self.status()
        passed = after["uptime_us"] - before["uptime_us"]
        self.assertGreater(passed, 0)
        self.assertEqual(after["activations"] - before["activations"], 12)
        self.assertEqual(after["reset_reason"], "power")
        self.assertEqual(after["faults"], 0)
        # No period is skipped, and each program begins a new one; the two requests of `rsc info` may be in different periods.
        checks = after["safety_checks"] - before["safety_checks"]
        self.assertGreaterEqual(checks, passed // SAFETY_PERIOD_US - 2)
        self.assertLessEqual(checks, passed // SAFETY_PERIOD_US + 2 + 12)

    def test_the_new_program_is_the_one_that_runs(self):
        for name in ("paper", "priorities"):
            image = self.compile(PROGRAMS / f"{name}.rsl")
            self.upload(image)
            info = rsc.info(self.board.port)
            report = rsc.run("dump", image)
            self.assertIn(info["board"]["program"]["hash"], report)

    def test_commands_of_the_old_program_do_not_outlive_it(self):
        self.upload(PROGRAMS / "paper.rsl", "--config", self.for_board(CONFIG))
        rsc.run("feed", "touch.LEVEL=1", "--port", self.board.port)  # sweeps for seconds
        self.upload(PROGRAMS / "priorities.rsl", "--config", self.for_board(CONFIG))
        reader = LineReader("monitor", "--port", self.board.port, "--format", "json")
        reader.wait_for(lambda lines: len(lines) > 1, 2)
        reader.stop()
        self.assertEqual([json.loads(line)["event"] for line in reader.lines], ["board"])

    def test_source_is_compiled_and_uploaded(self):
        said = self.upload(PROGRAMS / "paper.rsl", "--config", self.for_board(CONFIG))
        self.assertRegex(said, r"bytes in [\d.]+ ms")

    def test_what_was_uploaded_from_its_source_is_shown_in_its_units(self):
        program, config = self.folder / "near.rsl", self.for_board(CONFIG)
        program.write_text("WHEN proximity DISTANCE < 30cm\nDO MOVE left_arm TO 40deg\nEND\n")
        said = rsc.run("feed", "proximity.DISTANCE=25cm", "--upload", program, "--config", config, "--watch", "1s", "--port",
                       self.board.port)
        self.assertIn("proximity DISTANCE = 25cm", said)
        self.assertIn("left_arm MOVE TO 40deg", said)

    def test_two_robots_at_once_and_one_that_is_not_there(self):
        image = self.compile(PROGRAMS / "priorities.rsl")
        absent = f"unix:{self.folder}/nobody"
        with Board(self.elf, icount=FAST) as other:
            done = rsc.call("upload", image, "--port", self.board.port, "--port", absent, "--port", other.port,
                            "--format", "json")
            self.assertEqual(done.returncode, 3, done.stderr)
            said = json.loads(done.stdout)
            self.assertEqual([one["port"] for one in said], [self.board.port, absent, other.port])
            self.assertIn("is the robot running?", said[1]["error"])
            for one in (said[0], said[2]):
                self.assertEqual(rsc.info(one["port"])["board"]["program"]["hash"], one["program"])
            table = rsc.run("upload", image, "--port", self.board.port, "--port", other.port).splitlines()
            self.assertEqual(len(table), 3, table)
            self.assertTrue(all("  running; " in row for row in table[1:]), table)

    def test_an_image_for_another_board_is_refused(self):
        other = "microbit-v2" if NAME == REFERENCE else REFERENCE  # both have the pins of this robot
        config = self.folder / "other.json"
        config.write_text(json.dumps({**json.loads(CONFIG.read_text()), "board": other}))
        done = rsc.call("upload", PROGRAMS / "paper.rsl", "--config", config, "--port", self.board.port)
        self.assertEqual(done.returncode, 3)
        self.assertIn(f"it is for {other}, and this is {NAME}", done.stderr)
        self.assertEqual(self.status()["activations"], 0)

    def test_an_image_for_another_robot_is_refused(self):
        config = json.loads(Path(self.for_board(CONFIG)).read_text())
        for name in ("ada", "bob"):
            (self.folder / f"{name}.json").write_text(json.dumps(config | {"name": name}))
        self.upload(PROGRAMS / "paper.rsl", "--config", self.folder / "ada.json")
        bobs = ("upload", PROGRAMS / "paper.rsl", "--config", self.folder / "bob.json", "--port", self.board.port)
        done = rsc.call(*bobs)
        self.assertEqual(done.returncode, 3, done.stderr)
        self.assertIn('this robot is "ada", and the program is for "bob"', done.stderr)
        self.assertEqual(rsc.info(self.board.port)["board"]["robot"], "ada")
        rsc.run(*bobs, "--anyway")
        self.assertEqual(rsc.info(self.board.port)["board"]["robot"], "bob")

    def test_a_suspended_board_ends_rsc_soon_and_goes_on_later(self):
        image = self.compile(PROGRAMS / "paper.rsl")
        self.upload(image)
        before = rsc.info(self.board.port)["board"]["program"]["hash"]
        self.board.qmp.command("stop")
        for arguments in (["upload", self.compile(PROGRAMS / "priorities.rsl")], ["feed", "touch.LEVEL=1"], ["resume"]):
            with self.subTest(verb=arguments[0]):
                start = time.monotonic()
                done = rsc.call(*arguments, "--port", self.board.port)
                self.assertLess(time.monotonic() - start, 3)
                self.assertEqual(done.returncode, 3)
                self.assertIn("the board does not answer", done.stderr)
                if arguments[0] == "upload":
                    self.assertIn("The new program was not started: the old program keeps running", done.stderr)
        self.board.qmp.command("cont")
        self.assertEqual(rsc.info(self.board.port)["board"]["program"]["hash"], before)

    def test_every_thread_keeps_within_its_stack(self):
        self.upload(self.compile(PROGRAMS / "arithmetic.rsl"))
        rsc.run("feed", "touch.LEVEL=5", "proximity.DISTANCE=20cm", "room.NOISE=100%",
                "--port", self.board.port)
        threads = rsc.info(self.board.port)["threads"]
        self.assertGreater(len(threads), 5)
        for thread in threads:
            self.assertLess(thread["stack_used"], thread["stack_bytes"], thread)
            self.assertNotEqual(thread["state"], "stopped", thread)


if __name__ == "__main__":
    unittest.main()

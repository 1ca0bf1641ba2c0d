"""What the shipped firmware keeps without power, in the board's store: the program that passed its trial, and numbers. A new
QEMU with the same file plays a board that was switched off and on. ROBOSYNC_BOARD selects the board."""

import contextlib
import json
import sys
import time
import unittest
from pathlib import Path

import player
import power_cuts
import rsc
from board import EEPROMS, FAST, FIRMWARE, HAVE_WATCHDOG, KEEPS_BY_ITSELF, NAME, REAL_TIME
from debugger import IN_SAFETY, PC, Debugger, endless_loop
from player import StoredBoard
from support import PROGRAMS, LineReader, RobotTest

sys.path.append(str(Path(__file__).resolve().parents[2] / "bench"))
from counting import symbols  # noqa: E402

PATIENCE = 20
UPLOADS = 3
KEEP_ATTEMPTS = 5  # for a machine that stalls now and then
SHORT_TRIAL = "500ms"
STEADY, OTHER = 5, 3000  # the values at the sensor's inputs
STEADY_CONFIG = """{
  "sensors": [{"name": "touch", "type": "I2C", "bus": 0, "address": "0x70", "device": "max34451",
               "channels": {"LEVEL": {"input": 0, "range": [0, 65535], "rate": "50Hz"},
                            "OTHER": {"input": 1, "range": [0, 65535], "rate": "50Hz"}}}],
  "actuators": [{"name": "arm", "type": "PWM", "pin": 0, "device": "servo", "range": ["0deg", "120deg"]}]
}"""
COUNTING_CONFIG = """{
  "sensors": [{"name": "touch", "type": "VIRTUAL", "channels": {"LEVEL": {"range": [0, 10]}}}],
  "actuators": []
}"""
COUNTING = """
REMEMBER visits = 0 KEPT

BEHAVIOR count PRIORITY 50
  WHEN touch LEVEL > 5
  DO
    RAISE visits BY 1
    LOG "visit", visits
  END
END
"""


class Switched(RobotTest):
    """A board that can be switched off and on. `icount`: REAL_TIME if a trial must not run ahead of real time."""

    icount = FAST

    def switch_on(self, *extra):
        self.board = StoredBoard(self.elf, icount=self.icount, extra=extra, store=self.folder / "store")
        self.addCleanup(self.board.stop)

    def power_cycle(self, *extra):
        self.board.stop()
        self.switch_on(*extra)

    def upload(self, program, *arguments):
        """Tries several times if the flash is played: that delays the board, on a busy machine for longer than rsc waits."""
        for _ in range(UPLOADS - 1 if player.is_needed() else 0):
            with contextlib.suppress(rsc.RscError):
                return super().upload(program, *arguments)
        return super().upload(program, *arguments)

    def kept(self):
        return rsc.info(self.board.port)["kept"]

    def running(self):
        program = rsc.info(self.board.port)["board"]["program"]
        return program and program["hash"]

    def await_kept(self, state):
        give_up = time.monotonic() + PATIENCE
        while (kept := self.kept())["state"] != state:
            self.assertLess(time.monotonic(), give_up, kept)
        return kept

    def keep(self, image):
        """In real time after a short trial: nobody waits for the default's five seconds."""
        if self.icount != REAL_TIME:
            self.upload(image)
            return self.await_kept("kept")["program"]["hash"]
        for _ in range(KEEP_ATTEMPTS):
            done = rsc.call("upload", image, "--port", self.board.port, "--trial", SHORT_TRIAL)
            if done.returncode == 0 and not self.lost():
                break
        return self.await_kept("kept")["program"]["hash"]

    def lost(self):
        """Whether the board was reset before the program was kept: when the host stalls for 100 ms, the emulated watchdog, which
        runs in real time, assumes that the firmware hangs."""
        while (state := self.kept()["state"]) not in ("kept", "no_program"):
            pass
        return state == "no_program"

    def images(self):
        """The images of two programs."""
        first = self.compile(PROGRAMS / "priorities.rsl")
        second = self.folder / "second.rsb"
        rsc.run("compile", PROGRAMS / "priorities.rsl", "--config", self.folder / "robot.json", "--seed", 1, "-o", second,
                "--anyway")
        return first, second


class Store(Switched):
    def test_several_robots_each_keep_the_program_after_its_trial(self):
        image, _ = self.images()
        with StoredBoard(self.elf, icount=self.icount, store=self.folder / "another") as other:
            ports = [self.board.port, other.port]
            said = json.loads(rsc.run("upload", image, "--trial", "200ms", "--replace", "--fresh", "--format", "json",
                                      *(word for port in ports for word in ("--port", port))))
            self.assertEqual([one["port"] for one in said], ports)
            for one in said:
                self.assertEqual((one["kept"]["state"], one["kept"]["program"]["hash"]), ("kept", one["program"]))
            self.assertEqual(rsc.info(other.port)["board"]["program"]["hash"], said[1]["program"])

    def test_power_that_goes_and_resets_at_any_time_leave_a_kept_program(self):
        """A few runs; `scripts/soak power` does more."""
        ends = []
        self.assertEqual(power_cuts.campaign(6, seed=1, show=lambda _, what: ends.append(what)), [])
        self.assertEqual({what.split()[0] for what in ends}, {"cut", "reset"})

    def test_back_and_forth(self):
        first, second = map(self.keep, self.images())
        for wanted in (first, second):
            self.assertRegex(rsc.run("rollback", "--port", self.board.port), r"^program [0-9a-f]{16} runs again \(\d+ bytes\)$")
            self.assertEqual(self.running(), wanted)
        self.power_cycle()
        self.await_kept("kept")
        self.assertEqual(self.running(), second)

    @unittest.skipUnless(NAME in EEPROMS, "its store is on no bus, and QEMU has no I2C of this board")
    def test_sensors_on_its_bus_never_wait_for_it(self):
        """While programs that measure a hundred times a second are written to the store, no transfer fails, none is late, and
        none reads a wrong value."""
        (self.folder / "robot.json").write_text(STEADY_CONFIG)
        program, pulse = self.folder / "program.rsl", symbols(FIRMWARE)["robosync_virtual_pwm"]
        self.board.set_touch(STEADY)
        self.board.set_touch(OTHER, channel=1)
        for round_ in range(4):
            rules = "".join(f"WHEN touch LEVEL > {STEADY + 1 + i} DO MOVE arm TO {i + round_}deg END\n" for i in range(30))
            program.write_text(f"WHEN touch LEVEL < {STEADY} OR touch OTHER < {OTHER} DO MOVE arm TO 100deg END\n" + rules)
            rsc.run("upload", program, "--port", self.board.port)
            self.await_kept("kept")
            info = rsc.info(self.board.port)
            self.assertEqual(info["buses"]["clears"], 0)
            self.assertEqual([(device["answers"], device["failed"]) for device in info["buses"]["devices"]], [(True, 0)])
            self.assertEqual([thread["missed_deadlines"] for thread in info["threads"]], [0] * len(info["threads"]))
            self.assertEqual(self.board.word(pulse), 0, "it has moved")


@unittest.skipUnless(NAME in HAVE_WATCHDOG, "QEMU has no watchdog of this board")
class Failed(Switched):
    def test_after_its_watchdog_has_reset_it_the_robot_stands_still(self):
        self.keep(self.compile(PROGRAMS / "priorities.rsl"))
        gdb = self.folder / "gdb"
        self.power_cycle("-gdb", f"unix:{gdb},server=on,wait=off")
        self.await_kept("kept")
        self.assertFalse(rsc.info(self.board.port)["state"]["stopped"])
        with Debugger(gdb) as debugger:
            debugger.run_to(symbols(FIRMWARE)[IN_SAFETY], lambda: None)
            debugger.set_register(PC, endless_loop())
        give_up = time.monotonic() + PATIENCE
        while self.status()["reset_reason"] != "watchdog":
            self.assertLess(time.monotonic(), give_up)
        self.await_kept("kept")
        self.assertTrue(rsc.info(self.board.port)["state"]["stopped"])
        rsc.run("resume", "--port", self.board.port)
        self.assertFalse(rsc.info(self.board.port)["state"]["stopped"])


class Numbers(Switched):
    def visits(self):
        """The texts that the program logs at the next touch."""
        reader = LineReader("feed", "touch.LEVEL=9", "touch.LEVEL=1", "--port", self.board.port, "--watch", "10s", "--format", "json")
        try:
            self.assertTrue(reader.wait_for(lambda lines: any('"log"' in line for line in lines), PATIENCE), reader.lines)
        finally:
            reader.stop()
        return [json.loads(line)["text"] for line in reader.lines if '"log"' in line]

    def test_kept_numbers_outlast_the_power(self):
        config = self.folder / "robot.json"
        config.write_text(COUNTING_CONFIG)
        self.for_board(config)
        program = self.folder / "count.rsl"
        program.write_text(COUNTING)
        self.assertEqual(rsc.call("check", program).stderr, "")
        self.upload(program)
        self.assertEqual(self.visits(), ["visit 1"])
        self.await_kept("kept")
        self.assertEqual(self.visits(), ["visit 2"])
        time.sleep(1)  # some seconds of the board's time
        self.board.cut_power()
        self.switch_on()
        self.await_kept("kept")
        self.assertEqual(self.visits(), ["visit 3"])
        self.upload(program)
        self.assertEqual(self.visits(), ["visit 4"])
        self.upload(program, "--fresh")
        self.assertEqual(self.visits(), ["visit 1"])


@unittest.skipIf(NAME in KEEPS_BY_ITSELF, "QEMU has the flash of this board, which always keeps")
class NoStore(RobotTest):
    def test_it_says_so(self):
        said = self.upload(self.compile(PROGRAMS / "priorities.rsl"))
        self.assertIn("not kept: this board has no working store", said)
        done = rsc.call("rollback", "--port", self.board.port)
        self.assertEqual(done.returncode, 1)
        self.assertIn("this board keeps no programs", done.stderr)


if __name__ == "__main__":
    unittest.main()

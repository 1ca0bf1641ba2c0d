"""What the shipped firmware reports after the safety thread itself has failed: why the board restarted, and
which fault it had, in `rsc info` and in the first line of `rsc monitor`."""

import json
import sys
import time
import unittest
from pathlib import Path

import rsc
import unimplemented
from board import FIRMWARE, HAVE_WATCHDOG, NAME, Board
from debugger import IN_SAFETY, PC, DebuggedTest, endless_loop
from support import LineReader

sys.path.append(str(Path(__file__).resolve().parents[2] / "bench"))
from counting import symbols  # noqa: E402

PATIENCE = 20
NOWHERE = 0xA000_0000  # nothing may run there
# Where the firmware kicks the watchdogs that QEMU does not have, and with what; and the processor time of QEMU in which it runs
# so many instructions that more than the watchdog's 100 ms of the board's time pass.
KICKS = {"b-l475e-iot01a": (("IWDG", 0x00), 0xAAAA), "nucleo-l476rg": (("IWDG", 0x00), 0xAAAA), "microbit-v2": (("io", 0x1_0600), 0x6E52_4635)}
LONG_ENOUGH_S = 0.2


class LastWords(DebuggedTest):
    def qemu_arguments(self):
        return [*(unimplemented.arguments(self.folder) if NAME in KICKS else []), *super().qemu_arguments()]

    def send_safety_to(self, address):
        """Makes the safety thread's next check of the rules jump to the address."""
        with self.debugger() as debugger:
            debugger.run_to(symbols(FIRMWARE)[IN_SAFETY], lambda: None)
            debugger.set_register(PC, address)

    def await_reset(self, reason):
        give_up = time.monotonic() + PATIENCE
        while (status := rsc.info(self.board.port)["status"])["reset_reason"] != reason:
            self.assertLess(time.monotonic(), give_up, f"the board never started again because of {reason}: {status}")
        return status

    def first_line(self, *arguments):
        said = rsc.run("monitor", "--port", self.board.port, "--duration", "100ms", *arguments)
        return said.splitlines()[0]

    def test_a_board_that_was_switched_on_has_nothing_to_tell(self):
        status = rsc.info(self.board.port)["status"]
        self.assertEqual((status["reset_reason"], status["last_fault"]), ("power", None))
        line = json.loads(self.first_line("--format", "json"))
        self.assertEqual((line["event"], line["reset_reason"], line["last_fault"]), ("board", "power", None))
        self.assertRegex(self.first_line(), rf"^ +board  {NAME}, up [\d.]+ s \(reset: power\), .* 0 faults$")

    def test_a_monitor_goes_on_after_a_reset(self):
        # Real time: with time running ahead, the board might soon be up for longer than before the reset.
        board = self.enterContext(Board(self.elf))
        reader = LineReader("monitor", "--port", board.port, "--format", "json")
        self.assertTrue(reader.wait_for(lambda lines: lines, PATIENCE))
        time.sleep(3)  # the monitor has asked for the board's uptime
        board.qmp.command("system_reset")
        self.assertTrue(reader.wait_for(lambda lines: len(lines) > 1, PATIENCE), reader.lines)
        errors = reader.stop()
        # One line for each start: on a busy machine QEMU's clock jumps, and the watchdog resets the board, too.
        self.assertEqual({json.loads(line)["event"] for line in reader.lines}, {"board"})
        self.assertEqual(errors.count("the board has restarted"), len(reader.lines) - 1, errors)

    def test_a_fault_of_the_safety_thread_is_told_after_the_reset(self):
        self.send_safety_to(NOWHERE)
        fault = self.await_reset("software")["last_fault"]
        self.assertEqual((fault["thread"], fault["pc"]), ("safety", NOWHERE))
        for _ in range(2):  # every host gets the answer
            line = json.loads(self.first_line("--format", "json"))
            self.assertEqual((line["reset_reason"], line["last_fault"]), ("software", fault))
            self.assertRegex(self.first_line(), r"\(reset: software\).* last fault: thread safety stopped: .* pc a0000000")
        self.assertIn("fault     thread safety stopped", rsc.run("info", "--port", self.board.port))

    @unittest.skipUnless(NAME in HAVE_WATCHDOG, "this board has no watchdog in QEMU")
    def test_a_safety_thread_that_hangs_is_told_after_the_reset(self):
        self.send_safety_to(endless_loop())
        self.assertIsNone(self.await_reset("watchdog")["last_fault"])
        self.assertIn("(reset: watchdog)", self.first_line())

    def kicks(self):
        place, value = KICKS[NAME]
        return unimplemented.told(self.folder, place).count(value)

    def run_for(self, seconds):
        end, give_up = self.board.processor_seconds() + seconds, time.monotonic() + PATIENCE
        while self.board.processor_seconds() < end:
            self.assertLess(time.monotonic(), give_up, "the board stands still")
            time.sleep(0.02)

    @unittest.skipUnless(NAME in KICKS, "QEMU has the watchdog of this board, and it resets the board")
    def test_a_safety_thread_that_hangs_kicks_the_watchdog_no_more(self):
        before = self.kicks()
        self.run_for(LONG_ENOUGH_S)
        self.assertGreater(self.kicks(), before)
        self.send_safety_to(endless_loop())
        before = self.kicks()
        self.run_for(LONG_ENOUGH_S)
        self.assertEqual(self.kicks(), before)


if __name__ == "__main__":
    unittest.main()

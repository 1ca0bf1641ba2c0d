"""What the shipped firmware of the B-L475E-IOT01A does with those parts of its chip that QEMU does not have: where they stay silent,
and where the test plays them. Run with ROBOSYNC_BOARD=b-l475e-iot01a."""

import contextlib
import sys
import threading
import unittest
from pathlib import Path

import rsc
import test_owner
import test_store
from debugger import PC, Debugger
from support import PROGRAMS, RobotTest

sys.path.append(str(Path(__file__).resolve().parents[2] / "bench"))
from board import FIRMWARE, REAL_TIME  # noqa: E402
from counting import symbols  # noqa: E402

FLASH = "robosync::boards::l475::Flash::"
LINK_REGISTER, AT_BREAKPOINT = 14, "T05"
PAGE, PAIR, AT_ONCE = 2048, 8, 512  # bytes of the flash; … that the debugger writes at once
GOES_ON, DONE = 0, 1  # boards::Erasing


class FlashPlayer(Debugger):
    """Is the flash, in the place of the two functions that work its registers, until the board is switched off. QEMU lets a debugger
    write what it keeps from the firmware."""

    def __init__(self, path):
        super().__init__(path)
        self.erased = 0
        self.at = {next(at for name, at in symbols(FIRMWARE).items() if name.startswith(FLASH + what)): play
                   for what, play in (("erase(", self.erase), ("program(", self.program))}
        for place in self.at:
            self._expect_ok(f"Z0,{place:x},2")
        self._thread = threading.Thread(target=self.play, daemon=True)
        self._thread.start()

    def play(self):
        with contextlib.suppress(AssertionError, OSError):  # it was switched off
            while True:
                self._send("c")
                if not self._receive().startswith(AT_BREAKPOINT):
                    return
                self.at[self.register(PC)]()
                self.set_register(PC, self.register(LINK_REGISTER) & ~1)

    def erase(self):
        """In two calls."""
        page, call = self.register(0), self.register(1)
        if call > 0:
            self.erased += 1
            for at in range(page, page + PAGE, AT_ONCE):
                self.write(at, b"\xff" * AT_ONCE)
        self.set_register(0, DONE if call > 0 else GOES_ON)

    def program(self):
        words = self.read_words(self.register(1), 2)
        self.write(self.register(0), b"".join(word.to_bytes(4, "little") for word in words))

    def write(self, at, data):
        self._expect_ok(f"M{at:x},{len(data):x}:{data.hex()}")

    def end(self):
        self._thread.join()
        self._socket.close()


class WithFlash:
    """A board that can be switched off and on, and its flash."""

    def switch_on(self, *extra):
        self.end_flash()
        self.starts = getattr(self, "starts", 0) + 1
        gdb = self.folder / f"gdb{self.starts}"
        super().switch_on("-gdb", f"unix:{gdb},server=on,wait=off", "-S", *extra)
        self.flash = FlashPlayer(gdb)
        self.addCleanup(self.end_flash)

    def end_flash(self):
        if getattr(self, "flash", None):
            self.board.stop()
            self.flash.end()
            self.flash = None


class KeptInFlash(WithFlash, test_store.Numbers):
    """Numbers and programs, as on the reference board."""

    test_back_and_forth = test_store.Store.test_back_and_forth
    test_power_that_goes_at_any_time_leaves_a_kept_program = test_store.Store.test_power_that_goes_at_any_time_leaves_a_kept_program

    def test_it_starts_with_the_program_that_stood_its_trial(self):
        first, second = self.images()
        kept = self.keep(first)
        self.assertGreaterEqual(self.flash.erased, 2)  # one for it, one for the record
        self.power_cycle()
        self.await_kept("kept")
        self.assertEqual(self.running(), kept)
        self.assertEqual(self.flash.erased, 0)
        self.upload(second)
        self.assertNotEqual(self.running(), kept)
        self.assertEqual(self.keep(second), self.running())


class OwnerInFlash(WithFlash, test_owner.Owner):
    pass


class WithoutFlash(RobotTest):
    icount = REAL_TIME  # the minute in which it may be paired

    def test_a_flash_that_does_nothing_is_a_store_that_does_not_answer(self):
        said = self.upload(PROGRAMS / "priorities.rsl", "--config", self.for_board(PROGRAMS / "robot.json"), "--trial", "1s")
        self.assertIn("not kept: this board has no store that answers; after a reset the robot has no program", said)
        told = rsc.info(self.board.port)
        self.assertEqual((told["kept"]["state"], told["status"]["faults"], told["status"]["safety_late_us"]), ("no_store", 0, 0))
        self.assertIsNotNone(told["board"]["program"])
        self.assertEqual([thread["missed_deadlines"] for thread in told["threads"]], [0] * len(told["threads"]))
        self.board.qmp.command("system_reset")
        self.assertIsNone(rsc.info(self.board.port)["board"]["program"])

    def test_who_would_be_its_owner_is_told(self):
        key = self.folder / "key"
        rsc.run("keygen", "--key", key)
        done = rsc.call("pair", "--key", key, "--port", self.board.port)
        self.assertEqual(done.returncode, 3)
        self.assertIn("does its store work?", done.stderr)
        self.assertEqual(rsc.info(self.board.port)["owner"]["pairing"], "unpaired")


if __name__ == "__main__":
    unittest.main()

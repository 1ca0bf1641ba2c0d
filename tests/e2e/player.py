"""Replaces functions of the shipped firmware through the debugger's port: those for hardware that QEMU does not have, such as
the flash of the B-L475E-IOT01A."""

import contextlib
import sys
import tempfile
import threading
import time
from pathlib import Path

from debugger import LINK_REGISTER, PC, Debugger

sys.path.append(str(Path(__file__).resolve().parents[2] / "bench"))
from board import FIRMWARE, Board, Qmp  # noqa: E402
from counting import symbols  # noqa: E402

FLASH = "robosync::boards::stm32l4::Flash::"
PAGE, AT_ONCE = 2048, 1024  # bytes of a page of the flash; bytes that the debugger writes in one request
DONE = 1  # boards::Erasing
RESET_SECONDS = 0.2


def is_needed():
    """Whether the firmware has that flash."""
    return any(name.startswith(FLASH) for name in symbols(FIRMWARE))


class Player(Debugger):
    """Plays functions, whose own code no longer runs. QEMU lets a debugger write memory that the firmware cannot write."""

    def __init__(self, path):
        super().__init__(path)
        self._plays = {}
        self.playing = threading.Lock()

    def play(self, place, function):
        """From now on, calls `function` instead of the one at that address; its argument is the core's registers."""
        self.stop_at(place)
        self._plays[place] = function

    def play_next(self):
        """Returns the address of the function that was played, None if the board was switched off."""
        if not self.go_on():
            return None
        with self.playing:
            core = self.core()
            if core[PC] in self._plays:  # otherwise the board was reset
                self._plays[core[PC]](core)
                self.set_register(PC, core[LINK_REGISTER] & ~1)
        return core[PC]


class FlashPlayer(Player):
    """Plays the flash until the board is switched off."""

    def __init__(self, path):
        super().__init__(path)
        self.erased = 0
        for what, play in (("erase(", self._erase), ("program(", self._program)):
            self.play(next(at for name, at in symbols(FIRMWARE).items() if name.startswith(FLASH + what)), play)
        self._thread = threading.Thread(target=self._play_on, daemon=True)
        self._thread.start()

    def _play_on(self):
        with contextlib.suppress(AssertionError, OSError):  # it was switched off
            while self.play_next() is not None:
                pass

    def _erase(self, core):
        self.erased += 1
        for at in range(core[0], core[0] + PAGE, AT_ONCE):
            self.write(at, b"\xff" * AT_ONCE)
        self.set_register(0, DONE)

    def _program(self, core):
        words = self.read_words(core[1], 2)
        self.write(core[0], b"".join(word.to_bytes(4, "little") for word in words))

    def end(self):
        self._thread.join()
        self._socket.close()


class QmpOnDemand:
    """QEMU's control socket, connected for one command at a time. Each stop of the debugger is an event, and QEMU loses parts of
    events that nobody reads."""

    def __init__(self, path):
        self._path = path

    def command(self, name, **arguments):
        qmp = Qmp(self._path)
        try:
            return qmp.command(name, **arguments)
        finally:
            qmp.close()

    def close(self):
        pass


class StoredBoard(Board):
    """A board with a store. If QEMU does not have the part that works the store, `flash` plays it, and the debugger's port is taken."""

    flash = None

    def __init__(self, elf=FIRMWARE, extra=(), **others):
        if not is_needed():
            super().__init__(elf, extra=extra, **others)
            return
        with tempfile.TemporaryDirectory(prefix="robosync-gdb-") as folder:
            gdb = Path(folder) / "gdb"
            super().__init__(elf, extra=["-gdb", f"unix:{gdb},server=on,wait=off", "-S", *extra], **others)
            self.qmp.close()
            self.qmp = QmpOnDemand(self.qmp_path)
            self.flash = FlashPlayer(gdb)

    def reset(self):
        """Not while a function is played: the board would go on after it, instead of starting."""
        if not self.flash:
            self.qmp.command("system_reset")
            return
        with self.flash.playing:
            self.qmp.command("system_reset")
            time.sleep(RESET_SECONDS)  # QEMU does it after its answer

    def stop(self):
        super().stop()
        if self.flash:
            self.flash.end()
            self.flash = None

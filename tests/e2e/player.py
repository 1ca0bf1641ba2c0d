"""Plays functions of the shipped firmware through the debugger's port: those of what QEMU has not. So the flash of the
B-L475E-IOT01A is there."""

import contextlib
import sys
import threading
from pathlib import Path

from debugger import LINK_REGISTER, PC, Debugger

sys.path.append(str(Path(__file__).resolve().parents[2] / "bench"))
from board import FIRMWARE  # noqa: E402
from counting import symbols  # noqa: E402

FLASH = "robosync::boards::stm32l4::Flash::"
PAGE, AT_ONCE = 2048, 1024  # bytes of the flash; … that the debugger writes at once
DONE = 1  # boards::Erasing


def is_needed():
    """The firmware has that flash."""
    return any(name.startswith(FLASH) for name in symbols(FIRMWARE))


class Player(Debugger):
    """Of functions that do nothing else any more. QEMU lets a debugger write what it keeps from the firmware."""

    def __init__(self, path):
        super().__init__(path)
        self._plays = {}

    def play(self, place, function):
        """In the place of the one at that address, from now on; it is given what the core's registers hold."""
        self.stop_at(place)
        self._plays[place] = function

    def play_next(self):
        """Gives the address of the function that was played, None when the board was switched off."""
        if not self.go_on():
            return None
        core = self.core()
        self._plays[core[PC]](core)
        self.set_register(PC, core[LINK_REGISTER] & ~1)
        return core[PC]


class FlashPlayer(Player):
    """Until the board is switched off."""

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

"""A board whose touch sensor and host are played by this process. Each reading and each byte arrives when the firmware
has reached a certain place, never by this machine's clock. So the shipped firmware executes exactly the same
instructions in each run, even on boards with an I2C bus that QEMU does not emulate.

The sensor is a debugger: it answers in place of the driver's function, and halts the board meanwhile. The host's bytes
go through a FIFO, one at a time, while the board is halted.
"""

import contextlib
import fcntl
import os
import re
import sys
import termios
import time
from pathlib import Path

from board import FAST, FIRMWARE, Board
from counting import PATIENCE, BenchError, functions, symbols
from idle import code_of

sys.path.append(str(Path(__file__).resolve().parents[1] / "tests/e2e"))
import player  # noqa: E402
import wire  # noqa: E402
from debugger import LINK_REGISTER, PC  # noqa: E402

READ = "robosync::drivers::max34451::read("  # (board, sensor, channel, pointer to the result)
SAMPLE = "robosync::layers::DriverSampler::sample("  # calls READ for a reading, not for the request before it
KERNEL, NOW = "robosync_kernel", "robosync::kernel::Kernel::now("
THUMB, CHANGED_BY_A_CALL = 1, (0, 1, 2, 3, 12, LINK_REGISTER)
INSTRUCTION_NS = 1 << int(re.match(r"shift=(\d+)", FAST)[1])
SESSION = 1
PIECE = 200  # bytes of an image
ATTEMPTS, SOON = 60, 1  # attempts; seconds between them


class BoardOnAFile:
    """A board from power-up to the end of the `with` block. It writes its line to a file, and reads it from a FIFO."""

    def __init__(self, folder, store, extra=()):
        """`folder`: for this board only."""
        folder.mkdir()
        self._said, heard = folder / "said", folder / "heard"
        os.mkfifo(heard)
        self._to_board = os.open(heard, os.O_RDWR)
        self._stack = contextlib.ExitStack()
        self._stack.callback(os.close, self._to_board)
        self._stack.enter_context(Board(icount=FAST, store=store, line=f"file,path={self._said},input-path={heard}",
                                        extra=extra))

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self._stack.close()

    def say(self, data):
        """Sends the bytes; returns when the board has taken them."""
        os.write(self._to_board, data)
        wait_until(lambda: not any(fcntl.ioctl(self._to_board, termios.FIONREAD, bytes(4))), "takes what it is sent")

    def messages(self, wanted):
        """The payloads of the messages of this kind that the board has sent."""
        *whole, _ = self._said.read_bytes().split(b"\0")
        contents = filter(None, map(wire.uncobs, whole))
        return [content[2:-2] for content in contents if wire.NAMES[content[0]] == wanted]


class FedBoard(BoardOnAFile):
    """Takes a program, at any pace: what it keeps is the same. Does not use rsc, which gives up on a board that a
    debugger halts."""

    def __init__(self, folder, store):
        gdb = folder / "gdb"
        super().__init__(folder, store, debugged(gdb) if player.is_needed() else ())
        if player.is_needed():
            self._flash = player.FlashPlayer(gdb)

    def ask(self, name, payload, reply):
        """Repeats the request until it is answered, because a board that has not started yet receives nothing."""
        before = len(self.messages(reply))
        for _ in range(ATTEMPTS):
            self.say(wire.frame(name, payload))
            with contextlib.suppress(BenchError):
                wait_until(lambda: len(self.messages(reply)) > before, f"answers {name}", SOON)
                return self.messages(reply)[-1]
        raise BenchError(f"the board does not answer {name}")

    def take(self, image):
        name = wire.name_of(image)
        self.say(b"\0")
        self.ask("hello", hello(), "hello_reply")
        self.ask("begin", wire.pack("Begin", session=SESSION, size=len(image), hash=name, base=bytes(8)), "transfer_status")
        for at in range(0, len(image), PIECE):
            self.ask("data", wire.piece_head(SESSION, at) + image[at:at + PIECE], "transfer_status")
        self.ask("activate", wire.activation(SESSION, name), "activate_result")

    def keeps(self):
        return wire.unpack("Kept", self.ask("get_kept", b"", "kept")).kept_bytes != 0


class TouchedBoard(BoardOnAFile):
    """Its sensor is played from the first touch on."""

    def __init__(self, folder, store, extra=()):
        gdb = folder / "gdb"
        super().__init__(folder, store, [*debugged(gdb), *extra])
        self._player = player.Player(gdb)
        self._stack.callback(self._player.leave)
        self._read, self._raw, self._caller = functions(READ)[READ], None, 0
        [self._sample] = code_of([SAMPLE])

    def run_to(self, place):
        self._player.run_to(place, lambda: None)

    def uptime_us(self):
        """The time on the kernel's clock. Call it at the start of a thread's function; the thread is not affected."""
        core = self._player.core()
        for register, value in ((0, symbols(FIRMWARE)[KERNEL]), (LINK_REGISTER, core[PC] | THUMB), (PC, functions(NOW)[NOW])):
            self._player.set_register(register, value)
        self.run_to(core[PC])
        now = self._player.register(1) << 32 | self._player.register(0)
        for register in CHANGED_BY_A_CALL:
            self._player.set_register(register, core[register])
        return now

    def set_touch(self, raw):
        if self._raw is None:
            self._player.play(self._read, self._answer)
        self._raw = raw

    def give(self):
        """Runs until the sensor has delivered the touch as a reading."""
        self._caller = 0
        while not self._sample[0] <= self._caller < self._sample[1]:
            if self._player.play_next() is None:
                raise BenchError("the board has stopped")

    def _answer(self, core):
        self._player.write(core[3], self._raw.to_bytes(4, "little"))
        self._player.set_register(0, True)
        self._caller = core[LINK_REGISTER]


def debugged(place):
    """QEMU's arguments to wait for a debugger before the first instruction."""
    return ["-gdb", f"unix:{place},server=on,wait=off", "-S"]


def hello():
    return wire.pack("Hello", session=SESSION, take=0, reserved=bytes(3), host=b"bench")


def wait_until(condition, what, patience=PATIENCE):
    give_up = time.monotonic() + patience
    while not condition():
        if time.monotonic() > give_up:
            raise BenchError(f"the board never {what}")
        time.sleep(0.0005)


def store_with(image, folder):
    """The store file of a board that has kept that program, in its own folder."""
    with FedBoard(folder, folder / "store") as board:
        board.take(image.read_bytes())
        wait_until(board.keeps, "keeps its program")
    return folder / "store"

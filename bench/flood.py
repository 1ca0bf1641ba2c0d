"""A host that floods the line of the board with an upload that never comes to its end: what the load of bench/safety.py has
of the link.

The emulated line would take bytes twenty times as fast as a real one has them, so they go by the robot's time: a handful
when the board has executed what it executes while a line of 115,200 baud has as many. The board answers each frame. Among
them stand the stop frames of a person.
"""

import random
import select
import sys
import threading
import time
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parents[1] / "tests/e2e"))
import wire  # noqa: E402

IMAGE = random.Random(1).randbytes(4000)  # nobody asks to activate it
BYTE_TAKES = 25_000_000 // 11_520  # instructions: the board has 25 MHz, and is busy most of the time
HANDFUL = 8
STOP_SEQUENCE = 255  # link::kStopSequence
STOP = wire.frame("stop", sequence=STOP_SEQUENCE)


def endless_upload(line):
    """The frames of one transfer after the other; the board takes each `begin` with another name for a new one."""
    most = wire.MOST_PAYLOAD - wire.layout("Data").size
    yield wire.frame("hello", line.introduction())
    for number in range(1, 1 << 32):
        yield wire.frame("begin", line.beginning(len(IMAGE), number.to_bytes(8, "little")), number % STOP_SEQUENCE)
        for at in range(0, len(IMAGE), most):
            yield wire.frame("data", wire.piece_head(line.session, at) + IMAGE[at:at + most], at % STOP_SEQUENCE)


class Flood(wire.Line):
    """Floods from start() to quiet(), and again; between them it can be asked as any other line. `marks`: the file of the
    plugin, which says how much the board has executed."""

    def __init__(self, path, marks):
        super().__init__(path)
        self._marks = open(marks, encoding="ascii")
        self._executed = 0
        self._cut = ""  # the beginning of a line
        self._frames = endless_upload(self)
        self._said = []
        self._quiet = threading.Event()
        self._threads = []

    def start(self):
        self._quiet.clear()
        self._marks.seek(0, 2)
        while not self._marks.readline().endswith("\n"):  # the line it stands in
            time.sleep(0.0002)
        self._cut = ""
        self._threads = [threading.Thread(target=job, daemon=True) for job in (self._write, self._read)]
        for thread in self._threads:
            thread.start()

    def quiet(self):
        """Returns when the board has read all that was sent."""
        self._quiet.set()
        for thread in self._threads:
            thread.join()
        self.send_raw(b"\0" + wire.frame("hello"))  # its reply ends what was cut off
        while b"\0" not in self._received:
            self._received += self._socket.recv(4096)
        self._received = self._received.split(b"\0", 1)[1]
        self.ask("get_status", reply="status")

    def say(self, frame):
        """In the midst of the flood."""
        self._said.append(frame)

    def close(self):
        self.quiet()
        self._marks.close()
        super().close()

    def _write(self):
        waiting, due = b"", 0
        while True:
            while len(waiting) < HANDFUL:
                waiting += self._said.pop(0) if self._said else next(self._frames)
            while self._now() < due:
                if self._quiet.is_set():
                    return
            due = self._executed + HANDFUL * BYTE_TAKES
            self.send_raw(waiting[:HANDFUL])
            waiting = waiting[HANDFUL:]

    def _now(self):
        """What the board has executed, at its last mark."""
        written = self._marks.read()
        if not written:
            time.sleep(0.0002)
        *whole, self._cut = (self._cut + written).split("\n")
        if whole:
            self._executed = int(whole[-1].split()[1])
        return self._executed

    def _read(self):
        while not self._quiet.is_set():
            if select.select([self._socket], [], [], 0.1)[0]:
                self._socket.recv(4096)

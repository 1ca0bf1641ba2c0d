"""A host that floods the board's line with an upload that never ends: the link's part of the load in bench/safety.py.

The emulated line would accept bytes twenty times as fast as a real one, so the bytes are paced by the robot's time: a
handful whenever the board has executed the instructions that it executes while a line of 115,200 baud carries as many.
The board answers each frame. A person's stop frames are sent among them.
"""

import random
import select
import sys
import threading
import time
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parents[1] / "tests/e2e"))
import wire  # noqa: E402

IMAGE = random.Random(1).randbytes(4000)  # never activated
BYTE_TAKES = 25_000_000 // 11_520  # instructions: the board runs at 25 MHz, and is busy most of the time
HANDFUL = 8
STOP_SEQUENCE = 255  # link::kStopSequence
STOP = wire.frame("stop", sequence=STOP_SEQUENCE)


def endless_upload(line):
    """The frames of one transfer after another. Each `begin` has another name, so the board takes it for a new
    transfer."""
    most = wire.MOST_PAYLOAD - wire.layout("Data").size
    yield wire.frame("hello", line.introduction())
    for number in range(1, 1 << 32):
        yield wire.frame("begin", line.beginning(len(IMAGE), number.to_bytes(8, "little")), number % STOP_SEQUENCE)
        for at in range(0, len(IMAGE), most):
            yield wire.frame("data", wire.piece_head(line.session, at) + IMAGE[at:at + most], at % STOP_SEQUENCE)


class Flood(wire.Line):
    """Floods from start() to quiet(), and again. In between it can be asked like any other line. `marks`: the plugin's
    file, which shows how much the board has executed."""

    def __init__(self, path, marks):
        super().__init__(path)
        self._marks = open(marks, encoding="ascii")
        self._executed = 0
        self._cut = ""  # an incomplete line at the end
        self._frames = endless_upload(self)
        self._said = []
        self._quiet = threading.Event()
        self._threads = []

    def start(self):
        self._quiet.clear()
        self._marks.seek(0, 2)
        while not self._marks.readline().endswith("\n"):  # the rest of the current line
            time.sleep(0.0002)
        self._cut = ""
        self._threads = [threading.Thread(target=job, daemon=True) for job in (self._write, self._read)]
        for thread in self._threads:
            thread.start()

    def quiet(self):
        """Stops, and returns when the board has read everything that was sent."""
        self._quiet.set()
        for thread in self._threads:
            thread.join()
        self.send_raw(b"\0" + wire.frame("hello"))  # its reply ends the frame that was cut off
        while b"\0" not in self._received:
            self._received += self._socket.recv(4096)
        self._received = self._received.split(b"\0", 1)[1]
        self.ask("get_status", reply="status")

    def say(self, frame):
        """Sends the frame in the middle of the flood."""
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
        """The instructions that the board has executed, as of its last mark."""
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

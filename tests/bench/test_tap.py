"""The serial line of the benchmarks and tests: no byte gets through it sooner than on a wire."""

import socket
import sys
import tempfile
import threading
import time
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "bench"), str(ROOT / "scripts/python")]

from tap import BITS_PER_BYTE, Tap

BAUD = 115200
BYTES = 2000


class ALine(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        listener = socket.socket(socket.AF_UNIX)
        self.addCleanup(listener.close)
        listener.bind(f"{folder.name}/board")
        listener.listen(1)
        tap = Tap(folder.name, f"unix:{folder.name}/board", BAUD)
        self.addCleanup(tap.close)
        self.host = socket.socket(socket.AF_UNIX)
        self.addCleanup(self.host.close)
        self.host.connect(tap.port.removeprefix("unix:"))
        self.board, _ = listener.accept()
        self.addCleanup(self.board.close)

    def seconds_of(self, count):
        """From when the last of them came into the line until it came out."""
        received = 0
        while received < count:
            received += len(self.board.recv(count - received))
        return time.monotonic()

    def test_all_at_once_take_their_time_on_the_wire(self):
        begun = time.monotonic()
        self.host.sendall(bytes(BYTES))
        self.assertGreaterEqual(self.seconds_of(BYTES) - begun, BYTES * BITS_PER_BYTE / BAUD)

    def test_a_line_that_was_idle_owes_nobody_time(self):
        self.host.sendall(b"1")
        self.seconds_of(1)
        time.sleep(0.2)
        begun = time.monotonic()
        self.host.sendall(bytes(BYTES))
        self.assertGreaterEqual(self.seconds_of(BYTES) - begun, BYTES * BITS_PER_BYTE / BAUD)

    def test_what_comes_in_pieces_is_the_same(self):
        pieces = threading.Thread(target=lambda: [self.host.sendall(bytes(7)) for _ in range(100)])
        begun = time.monotonic()
        pieces.start()
        self.assertGreaterEqual(self.seconds_of(700) - begun, 700 * BITS_PER_BYTE / BAUD)
        pieces.join()


if __name__ == "__main__":
    unittest.main()

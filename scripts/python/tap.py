"""A serial line of a given speed between rsc and the board in QEMU, which does not simulate the speed itself.

Listens on a Unix socket, passes each byte on after its time on the wire (10 bits a byte), and
counts the bytes in both directions.
"""

import select
import socket
import threading
import time
from pathlib import Path

from board import socket_of

BITS_PER_BYTE = 10  # start, 8 data, stop
CHUNK = 16  # a UART's FIFO; timing is no finer than that


class Tap:
    def __init__(self, folder, board_port, baud=115200):
        self.to_board = self.to_host = 0
        self._seconds_per_byte = BITS_PER_BYTE / baud
        self._board_port = board_port
        path = Path(folder) / "tap"
        self.port = f"unix:{path}"
        self._listener = socket.socket(socket.AF_UNIX)
        self._listener.bind(str(path))
        self._listener.listen(1)
        threading.Thread(target=self._serve, daemon=True).start()

    def _serve(self):
        while True:
            try:
                host, _ = self._listener.accept()
            except OSError:
                return  # closed
            board = socket_of(self._board_port)
            back = threading.Thread(target=self._pass_on, args=(board, host, "to_host"), daemon=True)
            back.start()
            self._pass_on(host, board, "to_board")
            back.join()
            host.close()
            board.close()

    def _pass_on(self, source, sink, counter):
        line_free = time.monotonic()
        try:
            while True:
                # Bytes that were already waiting follow the last byte without a gap, as from a UART: the line was not idle
                # just because this thread woke late.
                waits = bool(select.select([source], [], [], 0)[0])
                data = source.recv(CHUNK)
                if not data:
                    break
                begins = line_free if waits else max(line_free, time.monotonic())
                line_free = begins + len(data) * self._seconds_per_byte
                time.sleep(max(0.0, line_free - time.monotonic()))
                sink.sendall(data)
                self.note(counter, data)
                setattr(self, counter, getattr(self, counter) + len(data))
        except OSError:
            pass  # the other end is gone
        for end in (source, sink):
            try:
                end.shutdown(socket.SHUT_RDWR)
            except OSError:
                pass

    def note(self, counter, data):
        """Called with the bytes that have passed, for subclasses that need more than the count."""

    def wire_seconds(self, length):
        return length * self._seconds_per_byte

    def close(self):
        self._listener.close()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

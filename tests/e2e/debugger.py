"""QEMU's debugger port: stops the board at an instruction, and changes registers.

This injects faults into the shipped firmware, which has no hooks for that.
"""

import re
import socket
import subprocess
import time
from pathlib import Path

from board import FIRMWARE
from support import RobotTest

PATIENCE = 20
CONNECTED, AT_BREAKPOINT = "T02", "T05"
LINK_REGISTER, PC, XPSR = 14, 15, 25
END_OF_INTERRUPT = 0xFFFF_FFE0  # and up: EXC_RETURN values, not addresses
MOST_STEPS = 4000
INTERPRETER = "robosync::vm::run("  # (machine, code, progress)
IN_SAFETY = "robosync::Runtime::look_at_rules()"


class Debugger:
    """Connecting stops the board; the end of the `with` block lets it continue."""

    def __init__(self, path):
        deadline = time.monotonic() + PATIENCE
        while not Path(path).exists() and time.monotonic() < deadline:
            time.sleep(0.02)
        self._socket = socket.socket(socket.AF_UNIX)
        self._socket.settimeout(PATIENCE)
        self._socket.connect(str(path))
        self._received = b""
        self._ask("qXfer:features:read:target.xml:0,100")  # without this QEMU cannot set a single register

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self._ask("D")
        self._socket.close()

    def leave(self):
        """Call it when the board has ended."""
        self._socket.close()

    def run_to(self, address, meanwhile):
        """Lets the board run until it reaches `address`; meanwhile() makes it do so."""
        self.stop_at(address)
        self._send("c")
        meanwhile()
        stopped = self._receive()
        if not stopped.startswith((AT_BREAKPOINT, "S05")):
            raise AssertionError(f"the board stopped for another reason: {stopped}")
        self._expect_ok(f"z0,{address:x},2")

    def stop_at(self, address):
        """From now on, stops each time the board reaches the address."""
        self._expect_ok(f"Z0,{address:x},2")

    def go_on(self):
        """Runs to the next stop_at() address; False if the board stopped for another reason."""
        self._send("c")
        return self._receive().startswith(AT_BREAKPOINT)

    def register_at(self, address, number, times):
        """The register's value each time the board reaches `address`."""
        found = []
        for _ in range(times):
            self.run_to(address, lambda: None)
            found.append(self.register(number))
            self._ask("s")  # steps off the address, or the board would never leave it
        return found

    def written(self, address, times, look):
        """What look() gives each time the board has written the word at `address`. QEMU stops before the write."""
        found = []
        for _ in range(times):
            self._expect_ok(f"Z2,{address:x},4")
            if not self.go_on():
                raise AssertionError("the board stopped for another reason")
            self._expect_ok(f"z2,{address:x},4")
            self.step()
            found.append(look())
        return found

    def step(self):
        self._ask("s")

    def steps_to_return(self, reads=None, most=MOST_STEPS):
        """The number of instructions until the function or interrupt that has just begun returns. `reads` gives the results of
        instructions that read a chip's registers, which QEMU does not have: {address: (register, value)}."""
        back, mode, steps = self.register(LINK_REGISTER), self.mode(), 0
        end = back & ~1
        # At the end of an interrupt the core returns to the stacked address, or another interrupt begins.
        while (at := self.register(PC)) != end and (back < END_OF_INTERRUPT or self.mode() == mode):
            self.step()
            if reads and at in reads:
                self.set_register(*reads[at])
            steps += 1
            if steps == most:
                raise AssertionError("it does not return")
        return steps

    def mode(self):
        """The active exception; 0: none."""
        return self.register(XPSR) & 0x1FF

    def register(self, number):
        return int.from_bytes(bytes.fromhex(self._ask(f"p{number:x}")), "little")

    def core(self):
        """r0 to r15, in one request."""
        raw = bytes.fromhex(self._ask("g")[:8 * 16])
        return [int.from_bytes(raw[i:i + 4], "little") for i in range(0, len(raw), 4)]

    def set_register(self, number, value):
        self._expect_ok(f"P{number:x}={value.to_bytes(4, 'little').hex()}")

    def write(self, at, data):
        self._expect_ok(f"M{at:x},{len(data):x}:{data.hex()}")

    def read_words(self, address, count):
        """None while a thread runs that may not read them: QEMU checks with the MPU."""
        answer = self._ask(f"m{address:x},{4 * count:x}")
        if answer.startswith("E"):
            return None
        raw = bytes.fromhex(answer)
        return [int.from_bytes(raw[i:i + 4], "little") for i in range(0, len(raw), 4)]

    def _expect_ok(self, request):
        answer = self._ask(request)
        if answer != "OK":
            raise AssertionError(f"QEMU answers {request} with {answer!r}")

    def _ask(self, request):
        self._send(request)
        return self._receive()

    def _send(self, text):
        body = text.encode()
        self._socket.sendall(b"$" + body + b"#" + f"{sum(body) % 256:02x}".encode())

    def _receive(self):
        """The next packet, acknowledged. Skips the report that connecting has stopped the board."""
        while (packet := self._next()).startswith(CONNECTED):
            pass
        return packet

    def _next(self):
        while True:
            start = self._received.find(b"$")
            end = self._received.find(b"#", start)
            if start >= 0 and 0 <= end <= len(self._received) - 3:
                packet = self._received[start + 1:end].decode()
                self._received = self._received[end + 3:]
                self._socket.sendall(b"+")
                return packet
            data = self._socket.recv(4096)
            if not data:
                raise AssertionError("QEMU closed the debugger port")
            self._received += data


def endless_loop():
    """The address of an instruction of the firmware that jumps to itself."""
    listing = subprocess.run(["arm-none-eabi-objdump", "-d", str(FIRMWARE)], check=True, text=True,
                             stdout=subprocess.PIPE).stdout
    return int(re.search(r"^\s*([0-9a-f]+):\s+e7fe\s", listing, re.M)[1], 16)


class DebuggedTest(RobotTest):
    """A test whose board has a debugger port."""

    def qemu_arguments(self):
        return ["-gdb", f"unix:{self.folder / 'gdb'},server=on,wait=off"]

    def debugger(self):
        return Debugger(self.folder / "gdb")

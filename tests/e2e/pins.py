"""The board's input pins: a test sets their levels through QEMU's test protocol, while the board runs."""

import socket
import sys
import time
from pathlib import Path

from board import BOOT_SECONDS, FIRMWARE, NAME

sys.path.append(str(Path(__file__).resolve().parents[2] / "bench"))
from counting import symbols  # noqa: E402

# The line of a QEMU device for each pin, according to the boards' documents.
LINES = {
    "b-l475e-iot01a": {7: ("/machine/soc/gpioa", 4), 8: ("/machine/soc/gpiob", 2), 9: ("/machine/soc/gpioa", 15),
                       12: ("/machine/soc/gpioa", 6), 32: ("/machine/soc/gpioc", 13)},
    "nucleo-l476rg": {2: ("/machine/soc/gpioa", 10), 4: ("/machine/soc/gpiob", 5), 7: ("/machine/soc/gpioa", 8),
                      9: ("/machine/soc/gpioc", 7), 12: ("/machine/soc/gpioa", 6), 32: ("/machine/soc/gpioc", 13)},
    "microbit-v2": {pin: ("/machine/nrf51", line) for pin, line in
                    {0: 2, 1: 3, 2: 4, 5: 14, 8: 10, 9: 9, 11: 23, 12: 12, 13: 17, 14: 1}.items()},
}
VIRTUAL = range(40, 44)  # the mps2-an386's inputs: bits of a word of its memory
SYST_CSR = 0xE000_E010  # ARMv7-M ARM, B3.3.3; the kernel enables the timer when all memory has its first values


class Pins:
    """The pins of a board that was started with arguments(folder)."""

    def __init__(self, folder):
        self._socket = socket.socket(socket.AF_UNIX)
        give_up = time.monotonic() + BOOT_SECONDS
        while True:
            try:
                self._socket.connect(str(path_in(folder)))
                break
            except (FileNotFoundError, ConnectionRefusedError):
                if time.monotonic() > give_up:
                    raise
                time.sleep(0.02)
        self._socket.settimeout(BOOT_SECONDS)
        self._lines = self._socket.makefile("rw", encoding="ascii")
        self._word = (1 << len(VIRTUAL)) - 1
        while NAME not in LINES and not self.word(SYST_CSR) & 1:  # before, what is written to its memory would be lost
            if time.monotonic() > give_up:
                raise RuntimeError("the board does not start")
            time.sleep(0.02)

    def set(self, pin, high):
        if NAME in LINES:
            self.set_line(*LINES[NAME][pin], int(high))
        else:
            mask = 1 << VIRTUAL.index(pin)
            self._word = self._word | mask if high else self._word & ~mask
            self._say(f"writel {symbols(FIRMWARE)['robosync_virtual_inputs']:#x} {self._word:#x}")

    def set_line(self, device, line, level):
        self._say(f"set_irq_in {device} unnamed-gpio-in {line} {level}")

    def word(self, address):
        return int(self._say(f"readl {address:#x}").split()[1], 16)

    def set_word(self, address, value):
        self._say(f"writel {address:#x} {value:#x}")

    def write(self, address, data):
        self._say(f"write {address:#x} {len(data):#x} 0x{data.hex()}")

    def read(self, address, count):
        return bytes.fromhex(self._say(f"read {address:#x} {count:#x}").split()[1][2:])

    def interrupt(self, controller, line, name="unnamed-gpio-in"):
        """Requests the interrupt once."""
        for level in (1, 0):
            self._say(f"set_irq_in {controller} {name} {line} {level}")

    def _say(self, command):
        self._lines.write(command + "\n")
        self._lines.flush()
        answer = self._lines.readline().strip()
        if not answer.startswith("OK"):
            raise RuntimeError(f"{command}: {answer}")
        return answer

    def close(self):
        self._lines.close()
        self._socket.close()


def path_in(folder):
    return folder / "pins"


def arguments(folder):
    """QEMU's options for the test protocol."""
    return ["-qtest", f"unix:{path_in(folder)},server=on,wait=off", "-qtest-log", "none"]

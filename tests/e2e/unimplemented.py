"""The firmware's writes to peripherals that QEMU does not implement: QEMU logs them."""

import re

WRITE = re.compile(r"(\w+): unimplemented device write \(size 4, offset 0x([0-9a-f]+), value 0x([0-9a-f]+)\)")


def log_in(folder):
    return folder / "told"


def arguments(folder):
    """QEMU's options for the log."""
    return ["-d", "unimp", "-D", str(log_in(folder))]


def told(folder, place):
    """The values that have been written to `place`: (peripheral, offset of a register)."""
    return [int(value, 16) for name, at, value in WRITE.findall(log_in(folder).read_text()) if (name, int(at, 16)) == place]

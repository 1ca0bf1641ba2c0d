"""The pulses at the outputs of the emulated board. The reference board keeps them in its memory. QEMU has no timers and no PWM
modules of the other boards' chips, and logs what the firmware writes to them."""

import re
import sys
from pathlib import Path

import unimplemented
from board import FIRMWARE, NAME, REFERENCE

sys.path.append(str(Path(__file__).resolve().parents[2] / "bench"))
from counting import symbols  # noqa: E402

PINS = 36  # words of the reference board
FULL_US = 20_000
# For each pin: a timer of the chip and the offset of the register with the pulse, according to the boards' documents.
CHANNELS = {channel: 0x30 + 4 * channel for channel in range(1, 5)}
TIMERS = {
    "b-l475e-iot01a": {0: ("TIM5", CHANNELS[2]), 2: ("TIM4", CHANNELS[3]), 3: ("TIM3", CHANNELS[3]), 4: ("TIM5", CHANNELS[4]),
                       5: ("TIM3", CHANNELS[1]), 6: ("TIM3", CHANNELS[4]), 10: ("TIM5", CHANNELS[3]), 11: ("TIM3", CHANNELS[2]),
                       13: ("TIM2", CHANNELS[1])},
    "nucleo-l476rg": {3: ("TIM2", CHANNELS[2]), 5: ("TIM3", CHANNELS[1]), 6: ("TIM2", CHANNELS[3]), 10: ("TIM4", CHANNELS[1]),
                      11: ("TIM3", CHANNELS[2]), 13: ("TIM2", CHANNELS[1])},
}
# The micro:bit: module, channel and the chip's pin. A module fetches its pulses from the memory, and is told which pins it drives.
RINGS = {0: (0, 0, 2), 1: (0, 1, 3), 2: (0, 2, 4), 12: (0, 3, 12), 13: (1, 0, 17), 14: (1, 1, 1)}
MODULES, ON, PIN_OF_CHANNEL = (0x1_C000, 0x2_1000), 0x500, 0x560
SPACE, NEVER, SETTLED = "robosync::boards::microbit::pins::(anonymous namespace)::", 0x7FFF, 3


def arguments(folder):
    """QEMU's options for a board whose outputs are examined."""
    return [] if NAME == REFERENCE else unimplemented.arguments(folder)


class Outputs:
    """The outputs of a board that was started with arguments(folder)."""

    def __init__(self, board, folder):
        self._board = board
        self._log = unimplemented.log_in(folder)
        self._read_to = 0
        self._written = {}  # the last value in each register
        self._symbols = symbols(FIRMWARE)

    def pulses(self):
        """{pin: its pulse in us}, without the pins that are off."""
        if NAME == REFERENCE:
            found = dict(enumerate(self.words(self._symbols["robosync_virtual_pwm"], PINS)))
        else:
            self._read_log()
            found = {pin: self._written.get(place, 0) for pin, place in TIMERS[NAME].items()} if NAME in TIMERS else self._of_modules()
        return {pin: pulse for pin, pulse in found.items() if pulse}

    def words(self, address, count):
        """Words of the memory, even while the firmware runs."""
        said = self._board.qmp.command("human-monitor-command", **{"command-line": f"xp /{count}xw {address:#x}"})
        return [int(word, 16) for word in re.findall(r"0x([0-9a-f]{8})\b", said)]

    def _read_log(self):
        with open(self._log, "rb") as log:
            log.seek(self._read_to)
            whole = log.read().rpartition(b"\n")[0] + b"\n"
        self._read_to += len(whole) if len(whole) > 1 else 0
        for name, at, value in unimplemented.WRITE.findall(whole.decode()):
            at, value = int(at, 16), int(value, 16)
            self._written[name, at] = value
            if at - ON in MODULES and value:  # the firmware has started: after a reset a module drives no pin
                for channel in range(4):
                    self._written.pop((name, at - ON + PIN_OF_CHANNEL + 4 * channel), None)

    def _of_modules(self):
        """A pin that was off gets its module again when periods of it have ended. QEMU's never do: the pulse for which it waits
        counts."""
        values = self.words(self._symbols[SPACE + "values"], 4)
        states = self.words(self._symbols[SPACE + "states"], len(RINGS))
        found = {}
        for (pin, (module, channel, chip)), state in zip(RINGS.items(), states):
            joined = self._written.get(("io", MODULES[module] + PIN_OF_CHANNEL + 4 * channel)) == chip
            value = values[2 * module + channel // 2] >> 16 * (channel % 2) & 0xFFFF
            wanted, ended = state & 0xFFFF, state >> 16 & 0xFF
            if joined and value != NEVER:
                found[pin] = min(value & NEVER, FULL_US)
            elif ended < SETTLED:
                found[pin] = wanted
        return found

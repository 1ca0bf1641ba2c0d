"""Two inputs that a test changes while the board runs: those of the touch sensor on the emulated I2C bus, or two switches on boards
whose I2C QEMU does not have. And addresses that no program may access."""

import pins
from board import DEVICES, NAME
from support import INPUTS

WILD, TAME = 0, 1
ON_A_BUS = NAME in DEVICES
RESTING, TOUCHED, STRONGER = 3, 5, 9  # readings of the sensor
LINE, WATCHDOG = {"mps2-an386": (0x4000_4000, 0x4000_8000), "b-l475e-iot01a": (0x4001_3800, 0x4000_3000),
                  "nucleo-l476rg": (0x4000_4400, 0x4000_3000), "microbit-v2": (0x4000_2000, 0x4001_0000)}[NAME]
if ON_A_BUS:
    SENSORS = [{"name": "touch", "type": "I2C", "bus": 0, "address": "0x70", "device": "max34451", "channels": {
        "WILD": {"input": WILD, "range": [0, 10], "rate": "50Hz"}, "TAME": {"input": TAME, "range": [0, 10], "rate": "50Hz"}}}]
    # The second constant is between a touch and a stronger one, which without it would concern no rule.
    WILD_IS_TOUCHED, TAME_IS_TOUCHED = "touch WILD > 2 OR touch WILD > 6", "touch TAME > 2"
    TAME_IS_PRESSED, TAME_IS_FREE = "touch TAME > 7", "touch TAME < 2"
else:
    SENSORS = [{"name": name, "type": "GPIO", "pin": pin, "device": "switch"} for name, pin in zip(("left", "right"), INPUTS)]
    WILD_IS_TOUCHED, TAME_IS_TOUCHED = "left IS closed", "right IS closed"
    TAME_IS_PRESSED, TAME_IS_FREE = "right IS closed", "right IS open"


def arguments(folder):
    """QEMU's options for a board that a Hand touches."""
    return [] if ON_A_BUS else pins.arguments(folder)


class Hand:
    """Touches the inputs of a board that was started with arguments(folder)."""

    def __init__(self, board, folder):
        self._board = board
        self._wires = None if ON_A_BUS else pins.Pins(folder)

    def rest(self, which):
        """So that neither the touch is felt nor SAFETY trips."""
        self._set(which, RESTING, True)

    def touch(self, which):
        self._set(which, TOUCHED, False)

    def change(self, which):
        """Another reading of an input that is touched."""
        self._set(which, STRONGER, True)

    def _set(self, which, reading, high):
        if self._wires:
            self._wires.set(INPUTS[which], high)
        else:
            self._board.set_touch(reading, which)

    def close(self):
        if self._wires:
            self._wires.close()

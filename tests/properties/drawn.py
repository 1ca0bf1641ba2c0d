"""What rsc run and the reference interpreter are compared on: drawn programs and readings, and the robot."""

import sys
from pathlib import Path

GENERATORS = Path(__file__).resolve().parents[1] / "generators/programs"
sys.path.insert(0, str(GENERATORS))

import stimuli  # noqa: E402
from generator import WideGenerator  # noqa: E402

CONFIG = GENERATORS / "robot.json"
UNITS = stimuli.WIDE_UNITS
Reading = stimuli.Reading
readings = stimuli.drawn_wide


def program(seed):
    return WideGenerator(seed).program()

"""SAFETY rules over sensors that fall silent: they trip on the board at the same millisecond as on the host,
whenever the program was started. ROBOSYNC_BOARD selects the board."""

import json
import unittest
from collections import namedtuple

from board import NAME, REFERENCE
from traces import TraceTest

Reading = namedtuple("Reading", "at_ms channel value")
# In QEMU the boards whose time comes from SysTick alone are too slow to take more readings (traces.py).
STARTS, EVERY_MS = (6, 97) if NAME == REFERENCE else (1, 389)
PROGRAM = """\
SAFETY bump
  WHEN range_left DISTANCE < 8cm OR range_right DISTANCE < 8cm
  DO
    STOP ALL
    ALERT "something is near, or a sensor is silent"
  RESUME WHEN range_left DISTANCE > 15cm AND range_right DISTANCE > 15cm FOR 300ms
END

WHILE range_left DISTANCE > 20cm
DO MOVE left_wheel FOR 2s
END
"""


def sensor(name):
    return {"name": name, "type": "VIRTUAL", "channels": {
        "DISTANCE": {"unit": "cm", "range": [2, 400], "stale_after": "500ms"}}}


ROBOT = {"sensors": [sensor("range_left"), sensor("range_right")],
         "actuators": [{"name": "left_wheel", "type": "VIRTUAL"}]}


def readings():
    """Both sensors measure at odd times; each falls silent once, and comes back."""
    for at in range(0, 6000, EVERY_MS):
        if not 1800 < at < 3100:
            yield Reading(at, "range_left.DISTANCE", 40 + at % 13)
        if not 4000 < at < 5200:
            yield Reading(at + 41, "range_right.DISTANCE", 60 - at % 11)


class Safety(TraceTest):
    units = {"range_left.DISTANCE": "cm", "range_right.DISTANCE": "cm"}

    def test_a_silent_sensor_trips_at_the_same_time(self):
        program = self.folder / "mobile.rsl"
        program.write_text(PROGRAM)
        config = self.folder / "mobile.json"
        config.write_text(json.dumps(ROBOT))
        for start in range(STARTS):
            with self.subTest(start=start):
                lines = self.check(program, sorted(readings()), config)
                self.assertGreaterEqual(sum('"trip"' in line for line in lines), 2)


if __name__ == "__main__":
    unittest.main()

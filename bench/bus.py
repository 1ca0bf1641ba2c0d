"""What a sample of a sensor on I2C costs the processor: i2c/….

lsm6dsl_sample     on the B-L475E-IOT01A: two reads, of 3 and of 12 bytes
lsm303agr_sample   on the micro:bit V2: one read, of 14 bytes
max34451_sample    on the reference board, whose interrupts drive the bus bit by bit: a page is selected, and a word is read
longest_hold_mps2  … and the longest of these interrupts

A sample is the driver's call that asks for the reads, the bus interrupts, and the driver's call that takes the bytes. The
instructions of these are counted in the shipped firmware. The sensor's thread wakes twice for a sample: `wake_by_timer` of the
board's costs.def, the most that one takes, is added for each.

QEMU has neither the masters nor the sensors of the other boards. So the tests of tests/e2e/on_….py play both, through the debugger
and the registers' log, and count while they do. This runs one of these tests, and fails if it does.
"""

import json
import os
import re
import subprocess
import sys
import unittest

from board import NAME, ROOT
from counting import BenchError

# The board, its test, and the figure.
TESTS = {"b-l475e-iot01a": ("on_l475", "Bus", "test_the_motion_sensor_on_the_board_is_told_and_read_and_what_that_costs",
                            "lsm6dsl_sample"),
         "mps2-an386": ("test_bus_costs", "BusCosts", "test_what_a_sample_costs", "max34451_sample"),
         "microbit-v2": ("on_microbit", "OnMicrobit", "test_what_the_bus_costs", "lsm303agr_sample")}
WAKES = 2


def sample_of_this_board():
    sys.path.append(str(ROOT / "tests/e2e"))
    module, case, method, name = TESTS[NAME]
    test = getattr(__import__(module), case)(method)
    result = unittest.TestResult()
    test.run(result)
    if not result.wasSuccessful() or result.skipped:
        raise BenchError(f"{module}.{case}.{method}: {result.failures or result.errors or result.skipped}")
    hold = {"i2c/longest_hold_mps2": test.longest_hold} if hasattr(test, "longest_hold") else {}
    return {f"i2c/{name}": test.most_of_a_sample + WAKES * most_of_a_wake(), **hold}


def most_of_a_wake():
    costs = (ROOT / f"runtime-m4/boards/{NAME}/costs.def").read_text()
    return int(re.search(r"^COST\(wake_by_timer,\s*(\d+),", costs, re.M)[1])


def i2c_figures():
    asked = {board: subprocess.Popen([sys.executable, __file__], env={**os.environ, "ROBOSYNC_BOARD": board}, text=True,
                                     stdin=subprocess.DEVNULL, stdout=subprocess.PIPE) for board in TESTS}
    said = {board: process.communicate()[0].splitlines() for board, process in asked.items()}
    failed = [board for board, process in asked.items() if process.returncode != 0]
    if failed:
        raise BenchError(f"no sample on {', '.join(failed)}")
    return {name: (count, "insn") for lines in said.values() for name, count in json.loads(lines[-1]).items()}


if __name__ == "__main__":
    print(json.dumps(sample_of_this_board()))

"""What the shipped firmware executes in a second in which nothing happens: without a program, and with the paper's,
whose touch sensor is sampled 50 times a second over I2C. No host talks to it.

Seconds are counted by the watchdog kicks, which the safety monitor sends at a fixed period. The processor of this board drives
the I2C bus bit by bit, in interrupts. So everything that the bus code executes is counted apart, by its addresses: also what asks
for transfers and takes what has come, and what the idle thread does instead of sleeping meanwhile.
"""

import math
import re
import subprocess
import tempfile
import time
from pathlib import Path

import periods
import rsc
from board import FAST, FIRMWARE, Board
from counting import BenchError, Marks, functions, of_the_board, plugin_arguments
from workloads import PAPER

KICK = "Board::watchdog_kick("
BUS = ("Timer0_Handler", "robosync_work_instead", "robosync::boards::mps2::LineMaster::", "robosync::boards::AskedBus<",
       "robosync::boards::BusRequests::", "robosync::boards::AskingBoard<")
SECONDS = 10  # measured, at the end of the run
BYTES_OF_MARK = 24  # per kick, at most
BYTES_OF_THOUSANDS = 100_000
STARTED = 2  # kicks after which the firmware has started
PATIENCE = 30  # seconds to wait for that many: the core's sleep takes no time


def code_of(prefixes):
    """[(begin, end)] of the firmware's functions whose names begin with one of these."""
    listing = subprocess.run(["arm-none-eabi-nm", "-S", "-C", str(FIRMWARE)], check=True, text=True,
                             stdout=subprocess.PIPE).stdout
    code = []
    for prefix in prefixes:
        found = re.findall(rf"^(\w+) (\w+) \w {re.escape(prefix)}", listing, re.M)
        if not found:
            raise BenchError(f"the firmware has no {prefix}…")
        code += [(int(at, 16) & ~1, (int(at, 16) & ~1) + int(size, 16)) for at, size in found]
    return code


def kicks(bytes_of_marks, program=None):
    """The marks of the watchdog kicks. They fill this many bytes from power-up, or from the upload of the program, which
    may end late in the robot's time: that time does not wait for a busy host."""
    known = functions(of_the_board(KICK))
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder) / "marks"
        apart = code_of(BUS) if program else ()
        with Board(icount=FAST, extra=plugin_arguments(known, out, apart)) as board:
            if program:
                rsc.run("upload", program, "--port", board.port)
                bytes_of_marks += out.stat().st_size
            deadline = time.monotonic() + PATIENCE
            while out.stat().st_size < bytes_of_marks:
                if time.monotonic() > deadline:
                    raise BenchError("the firmware does not kick its watchdog")
                time.sleep(0.1)
        return Marks(known, out)


def idle_second(period, program):
    """The most expensive of several seconds with a kick every `period` milliseconds: (instructions, apart)."""
    marks = kicks(BYTES_OF_THOUSANDS, program)
    second = 1000 // period
    last = range(len(marks.all) - SECONDS * second, len(marks.all), second)
    return max((marks.all[i - 1][1] - marks.all[i - 1 - second][1],
                marks.apart[i - 1] - marks.apart[i - 1 - second]) for i in last)


def idle_alone():
    """The most expensive second in the first minute of a board without a program, which includes the kernel's one look
    at distant timers; so every run gives the same. Counted over whole kick periods, and scaled down to a second."""
    period = periods.idle_ms()
    second, minute = math.ceil(1000 / period), math.ceil(60_000 / period)
    counts = [count for _, count in kicks(BYTES_OF_MARK * minute).all][STARTED:minute]
    if len(counts) != minute - STARTED:
        raise BenchError("the watchdog was not kicked for a minute")
    most = max(end - begin for begin, end in zip(counts, counts[second:]))
    return math.ceil(most * 1000 / (second * period))


def idle_figures():
    paper, transfers = idle_second(periods.safety_ms(), PAPER)
    return {"firmware/idle_second": (idle_alone(), "insn"),
            "firmware/idle_second_paper": (paper, "insn"),
            "firmware/idle_second_paper_i2c": (transfers, "insn")}

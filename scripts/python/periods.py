"""Periods of the firmware, read from its sources. ROBOSYNC_BOARD selects the board (board.py)."""

import re

from board import NAME, ROOT


def period_ms(source, constant):
    """A period of the runtime that its source states in milliseconds."""
    found = re.search(rf"{constant} = (\d+);", (ROOT / source).read_text())
    if not found:
        raise LookupError(f"{source} has no {constant}")
    return int(found[1])


def safety_ms():
    """The safety monitor's period while a program runs."""
    return period_ms("runtime-m4/policy/rules.hpp", "kSafetyPeriodMs")


def board_header():
    """The board's header, or that of its chip if its board.cmake includes one."""
    folder = ROOT / "runtime-m4/boards" / NAME
    chip = re.search(r"include\(boards/(\w+)/", (folder / "board.cmake").read_text())
    return f"runtime-m4/boards/{chip[1] if chip else NAME}/board.hpp"


def idle_ms():
    """The same while no program runs: safety::idle_period() for the board's watchdog time."""
    source = "runtime-m4/safety/period.hpp"
    share = re.search(r"watchdog_ms \* (\d+) / (\d+)\)", (ROOT / source).read_text())
    if not share:
        raise LookupError(f"{source} does not say what the idle period is of the watchdog's time")
    return period_ms(board_header(), "kWatchdogMs") * int(share[1]) // int(share[2])

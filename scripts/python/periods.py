"""Periods of the firmware, as its sources say them. Which board it is says ROBOSYNC_BOARD (board.py)."""

import re

from board import NAME, ROOT


def period_ms(source, constant):
    """A period of the runtime that is written down in milliseconds."""
    found = re.search(rf"{constant} = (\d+);", (ROOT / source).read_text())
    if not found:
        raise LookupError(f"{source} has no {constant}")
    return int(found[1])


def safety_ms():
    """From one check of the safety monitor to the next while a program runs."""
    return period_ms("runtime-m4/policy/rules.hpp", "kSafetyPeriodMs")


def board_header():
    """That of the board, or of the chip which it has in common with others, as its board.cmake says."""
    folder = ROOT / "runtime-m4/boards" / NAME
    chip = re.search(r"include\(boards/(\w+)/", (folder / "board.cmake").read_text())
    return f"runtime-m4/boards/{chip[1] if chip else NAME}/board.hpp"


def idle_ms():
    """… and while none does: what safety::idle_period() makes of the time of the board's watchdog."""
    source = "runtime-m4/safety/period.hpp"
    share = re.search(r"watchdog_ms \* (\d+) / (\d+)\)", (ROOT / source).read_text())
    if not share:
        raise LookupError(f"{source} does not say what the idle period is of the watchdog's time")
    return period_ms(board_header(), "kWatchdogMs") * int(share[1]) // int(share[2])

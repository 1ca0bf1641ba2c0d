"""The last recorded counts (recorded.json), so that no figure grows unnoticed below its bar.

Only counted figures are recorded: instructions and bytes are the same on every machine. Times are not, and are never
compared.
"""

import json
from pathlib import Path

FILE = Path(__file__).parent / "recorded.json"
TOLERANCE = 0.02
# Counted on a board that talks with this machine: the time of a touch, and what is due at the same moment, differ in
# each run. On a path without bytes from the line in between, they differ little.
IN_REAL_TIME = {"safety/reading_to_safe": 0.5, "safety/stop_frame_to_safe": 0.5,
                "path/reading_to_command": 0.05, "path/follow_update": 0.05, "vm/W1_queue": 0.05, "vm/W3_staged": 0.05,
                "firmware/power_up_to_program": 1, "link/answer": 1}
TIMES = {"ms", "lines/s"}  # units that depend on the speed of the machine
NOT_EXACT = TIMES | {"x"}  # … and of figures that differ in each run


def is_counted(figure):
    return figure["unit"] not in NOT_EXACT


def tolerance_of(name):
    return max([TOLERANCE, *(most for begin, most in IN_REAL_TIME.items() if name.startswith(begin))])


def load(path=FILE):
    return json.loads(Path(path).read_text()) if Path(path).exists() else {}


def save(figures, path=FILE, before=()):
    """`before`: older values, kept for names that no figure has."""
    counted = {**dict(before), **{figure["name"]: figure["value"] for figure in figures if is_counted(figure)}}
    Path(path).write_text(json.dumps(counted, indent=2, sort_keys=True) + "\n")


class Comparison:
    """Compares figures with recorded ones. While recording there are none: pass None. `grown` and `shrunk` are messages
    for people."""

    def __init__(self, recorded):
        self._recorded = recorded
        self._seen = set()
        self.grown = []
        self.shrunk = []

    def add(self, figure):
        """Returns False if this figure grew, or was never recorded."""
        if self._recorded is None or not is_counted(figure):
            return True
        name, now, unit = figure["name"], figure["value"], figure["unit"]
        self._seen.add(name)
        if name not in self._recorded:
            self.grown.append(f"{name} ({now} {unit}) was never recorded: scripts/bench --record")
            return False
        before, tolerance = self._recorded[name], tolerance_of(name)
        change = f"{name}: {before} {unit} recorded, {now} {unit} now"
        if now > before * (1 + tolerance):
            self.grown.append(f"{change}, more than {tolerance:.0%} above. Find out why; if it is "
                              "worth it: scripts/bench --record, and say so in the commit")
            return False
        if now < before * (1 - tolerance):
            self.shrunk.append(f"{change}. So that it stays there: scripts/bench --record")
        return True

    def before(self, figure):
        """The recorded value; while recording, the current one."""
        return figure["value"] if self._recorded is None else self._recorded.get(figure["name"])

    def missing(self):
        """Recorded figures that are no longer measured."""
        return sorted((self._recorded or {}).keys() - self._seen)

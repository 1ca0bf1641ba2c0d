"""A robot on whose pins a test plays a part that QEMU does not have. It counts what the firmware does for it."""

import json
import re
import sys
from pathlib import Path

import pins
import rsc
from board import FIRMWARE, NAME
from debugger import DebuggedTest

sys.path.append(str(Path(__file__).resolve().parents[2] / "bench"))
from counting import symbols  # noqa: E402


def place_of(part):
    """The address of the first symbol with this in its name."""
    return next(at for name, at in symbols(FIRMWARE).items() if part in name)


def said(name):
    """A cost of the board."""
    listed = (rsc.ROOT / f"runtime-m4/boards/{NAME}/costs.def").read_text()
    return int(re.search(rf"^COST\({name},\s*([\d']+)", listed, re.M)[1].replace("'", ""))


def counted(debugger, place):
    """The instructions of the next call of the function, or interrupt, at that place."""
    debugger.run_to(place, lambda: None)
    return debugger.steps_to_return()


class WiredTest(DebuggedTest):
    """Its program is PROGRAM, its robot.json ROBOT."""

    def setUp(self):
        super().setUp()
        self.program, self.config = self.folder / "wired.rsl", self.folder / "wired.json"
        self.program.write_text(self.PROGRAM)
        self.config.write_text(json.dumps(self.ROBOT))
        self.wires = pins.Pins(self.folder)
        self.addCleanup(self.wires.close)

    def qemu_arguments(self):
        return [*pins.arguments(self.folder), *super().qemu_arguments()]

    def begin(self):
        self.upload(self.program, "--config", self.config)
        return self.listen()

"""No thread of any firmware can leave its stack: the deepest way through its code, with what an interrupt puts on it, fits.

How deep a thread stands when it is interrupted is chance, so a board that runs well for minutes shows nothing: this one was
wrong for days, and stopped an actuator's thread once in some hundred programs.
"""

import re
import unittest
from pathlib import Path

from stack_depth import Firmware, StackError

ROOT = Path(__file__).resolve().parents[2]
BUILDS = {"mps2-an386": "m4", "b-l475e-iot01a": "b-l475e-iot01a", "microbit-v2": "microbit-v2"}
GUARD = 32  # port::kGuard; stacks are aligned to it
FRAME, SAVED = 32, 36  # what the core stacks, and PendSV_Handler: no thread uses the FPU
TO_EIGHT = 4  # the core aligns its frame
# Of each thread: its guard, its entry, and where the size of its stack is told.
MEMORY, LAMBDA = "runtime-m4/policy/memory.hpp", r"\(.*::\{lambda\(void\*\)#1\}::_FUN"
THREADS = {
    "safety": (GUARD, "safety::Monitor::start" + LAMBDA, "runtime-m4/safety/monitor.hpp", "kStack"),
    "link": (GUARD, "update::Server::start" + LAMBDA, "runtime-m4/update/server.hpp", "kStack"),
    "step": (GUARD, "layers::ProcessingLayer::start" + LAMBDA, MEMORY, "kStepStack"),
    "actuator": (GUARD, "layers::ControlLayer::start_unit" + LAMBDA, MEMORY, "kControlStack"),
    "sensor": (GUARD, "layers::SensorLayer::start_sensor" + LAMBDA, MEMORY, "kSensorStack"),
    "feeds": (GUARD, "layers::SensorLayer::start_feeds" + LAMBDA, MEMORY, "kSensorStack"),
    "algorithms": (GUARD, "layers::AlgorithmLayer::start_server" + LAMBDA, MEMORY, "kSensorStack"),
    "behavior": (0, "layers::BehaviorLayer::start_unit" + LAMBDA, MEMORY, "kBehaviorStack"),  # without privileges
}


def size_of(path, name, board):
    """As the header says it; where it says two, the second is of a board without authentication."""
    told = re.search(rf"\b{name} =\s+([^;]*);", (ROOT / path).read_text("utf-8"))[1]
    sizes = [int(number) for number in re.findall(r"\d+", told)]
    return sizes[-1] if board == "microbit-v2" else sizes[0]


def needs(firmware, entry, guard):
    """(bytes of stack that the thread needs, whether it uses the FPU, the way on which it is deepest)."""
    deepest, uses_fpu, way = firmware.deepest(firmware.entry(entry))
    return deepest + TO_EIGHT + FRAME + SAVED + guard, uses_fpu, way


class StackDepth(unittest.TestCase):
    def test_every_thread_of_every_board(self):
        wrong = []
        for board, build in BUILDS.items():
            firmware = Firmware(ROOT / "build" / build / "robosync.elf")
            for thread, (guard, entry, path, name) in THREADS.items():
                needed, uses_fpu, way = needs(firmware, entry, guard)
                there = size_of(path, name, board)
                print(f"  {board}, {thread}: {needed} of {there} bytes", flush=True)
                if uses_fpu or needed > there:
                    wrong.append((board, thread, needed, there, "FPU" if uses_fpu else "", *way))
        self.assertEqual(wrong, [])

    def test_recursion_and_calls_that_lead_nobody_knows_where_are_noticed(self):
        firmware = Firmware(ROOT / "build/m4/robosync.elf")
        with self.assertRaisesRegex(StackError, "CALLED_BY_POINTER does not say whom"):
            firmware.deepest(firmware.entry("^Reset_Handler$"))


if __name__ == "__main__":
    unittest.main()

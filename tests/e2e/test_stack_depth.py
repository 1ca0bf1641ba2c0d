"""No thread of any firmware can overflow its stack: its deepest call path, plus the frames of an interrupt, fits.

How deep a thread is when it is interrupted is random, so a board that runs well for minutes proves nothing: an actuator's
thread with 108 bytes too few was stopped once in several hundred programs.
"""

import re
import subprocess
import tempfile
import unittest
from pathlib import Path

from stack_depth import FPU_FRAMES, FRAMES, GUARD, Firmware, StackError

ROOT = Path(__file__).resolve().parents[2]
BUILDS = {"mps2-an386": "m4", "b-l475e-iot01a": "b-l475e-iot01a", "nucleo-l476rg": "b-l475e-iot01a/nucleo-l476rg",
          "microbit-v2": "microbit-v2"}
# For each thread: the bytes of frames on its stack besides its own, its entry, and where the size of its stack is defined.
MEMORY, LAMBDA = "runtime-m4/policy/memory.hpp", r"\(.*::\{lambda\(void\*\)#1\}::_FUN"
THREADS = {
    "safety": (FRAMES + GUARD, "safety::Monitor::start" + LAMBDA, "runtime-m4/safety/monitor.hpp", "kStack"),
    "link": (FRAMES + GUARD, "update::Server::start" + LAMBDA, "runtime-m4/update/server.hpp", "kStack"),
    "step": (FRAMES + GUARD, "layers::ProcessingLayer::start" + LAMBDA, MEMORY, "kStepStack"),
    "actuator": (FRAMES + GUARD, "layers::ControlLayer::start_unit" + LAMBDA, MEMORY, "kControlStack"),
    "sensor": (FRAMES + GUARD, "layers::SensorLayer::start_sensor" + LAMBDA, MEMORY, "kSensorStack"),
    "feeds": (FRAMES + GUARD, "layers::SensorLayer::start_feeds" + LAMBDA, MEMORY, "kSensorStack"),
    "algorithms' server": (FRAMES + GUARD, "layers::AlgorithmLayer::start_server" + LAMBDA, MEMORY, "kSensorStack"),
    "behavior": (FRAMES, "layers::BehaviorLayer::start_unit" + LAMBDA, MEMORY, "kBehaviorStack"),  # unprivileged
    "SAFETY's bytecode": (FRAMES, r"safety::\(anonymous namespace\)::run_bytecode\(", MEMORY, "kSafetyStack"),  # the same
    # Unprivileged, too; it counts as having used the FPU (switch.S).
    "algorithm": (FPU_FRAMES, "layers::AlgorithmLayer::start_unit" + LAMBDA, MEMORY, "kModuleStack"),
}


def size_of(path, name, board):
    """The size from the header; if there are two, the second is for a board without authentication."""
    told = re.search(rf"\b{name} =\s+([^;]*);", (ROOT / path).read_text("utf-8"))[1]
    sizes = [int(number) for number in re.findall(r"\d+", told)]
    return sizes[-1] if board == "microbit-v2" else sizes[0]


class StackDepth(unittest.TestCase):
    def test_every_thread_of_every_board(self):
        wrong = []
        for board, build in BUILDS.items():
            firmware = Firmware(ROOT / "build" / build / "robosync.elf")
            for thread, (besides, entry, path, name) in THREADS.items():
                deepest, uses_fpu, way = firmware.deepest(firmware.entry(entry))
                needed = deepest + besides
                there = size_of(path, name, board)
                print(f"  {board}, {thread}: {needed} of {there} bytes", flush=True)
                if uses_fpu or needed > there:
                    wrong.append((board, thread, needed, there, "FPU" if uses_fpu else "", *way))
        self.assertEqual(wrong, [])

    def test_what_the_idle_thread_does_instead_of_sleeping(self):
        """Its stack has room for an interrupt and a switch only (port/cortex-m4/hooks.hpp)."""
        firmware = Firmware(ROOT / "build/m4/robosync.elf")
        self.assertEqual(firmware.deepest(firmware.entry("robosync_work_instead"))[:2], (0, False))


# Code for which the bytes of each function and each call path are known.
CODE = """
    .syntax unified
    .cpu cortex-m4
    .fpu fpv4-sp-d16
    .thumb
.macro function name
    .thumb_func
    .global \\name
    .type \\name, %function
    \\name:
.endm
function leaf
    push {r4, lr}
    sub sp, #24
    add sp, #24
    pop {r4, pc}
function deep
    sub.w sp, sp, #100
    str r0, [sp, #-4]!
    b.n deep
function caller
    stmdb sp!, {r4-r7, lr}
    bl leaf
    ldmia.w sp!, {r4-r7, lr}
    b.w deep
function both
    push {lr}
    bl caller
    pop {pc}
function computes
    push {lr}
    vmov s0, r0
    bl leaf
    pop {pc}
function itself
    push {lr}
    bl itself
    pop {pc}
function there
    push {lr}
    bl back
    pop {pc}
function back
    push {lr}
    bl there
    pop {pc}
function by_pointer
    push {lr}
    blx r3
    pop {pc}
function robosync_call_in_sandbox
    push {r4, lr}
    blx r9
    pop {r4, pc}
function unknown
    sub sp, sp, r0
    bx lr
"""


class Analysis(unittest.TestCase):
    def linked(self, code):
        folder = Path(self.enterContext(tempfile.TemporaryDirectory()))
        source, elf = folder / "code.s", folder / "code.elf"
        source.write_text(code)
        subprocess.run(["arm-none-eabi-gcc", "-mcpu=cortex-m4", "-nostdlib", "-Wl,-e,leaf,--no-warn-rwx-segments",
                        source, "-o", elf], check=True)
        return Firmware(elf)

    def test_what_is_known(self):
        firmware = self.linked(CODE.split("function unknown")[0])

        def deepest(name):
            return firmware.deepest(firmware.entry(f"^{name}$"))

        self.assertEqual(deepest("leaf"), (32, False, ("leaf",)))
        self.assertEqual(deepest("deep"), (104, False, ("deep",)))  # its loop is not a recursion
        self.assertEqual(deepest("caller"), (104, False, ("caller", "deep")))  # a tail call: the caller's own 20 bytes are released
        self.assertEqual(deepest("both"), (108, False, ("both", "caller", "deep")))
        self.assertEqual(deepest("computes"), (36, True, ("computes", "leaf")))
        self.assertEqual(deepest("robosync_call_in_sandbox"), (8, False, ("robosync_call_in_sandbox",)))
        for recursive in ("itself", "there"):
            with self.assertRaisesRegex(StackError, "recursion: "):
                deepest(recursive)
        with self.assertRaisesRegex(StackError, "CALLED_BY_POINTER does not say whom"):
            deepest("by_pointer")

    def test_a_frame_whose_size_nobody_knows(self):
        with self.assertRaisesRegex(StackError, "nobody knows by how much"):
            self.linked(CODE)


if __name__ == "__main__":
    unittest.main()

"""A behaviour's thread that goes wild in the shipped firmware: it is stopped and reported, its actuator
comes to rest, the others continue, and safety is never late. Also: the memory that SAFETY's bytecode may access, and what happens
if it accesses anything else."""

import json
import sys
import time
import unittest
from pathlib import Path

import outputs
import rsc
import touched
from board import FIRMWARE, NAME, ROOT
from debugger import INTERPRETER, PC, DebuggedTest, endless_loop
from support import AT_WILL, PROGRAMS, LineReader
from touched import LINE, TAME, WATCHDOG, WILD

sys.path.append(str(Path(__file__).resolve().parents[2] / "bench"))
from counting import symbols  # noqa: E402

PATIENCE = 20
NMI_NEEDS = 192  # bytes: a frame with FPU registers, and the functions that it calls
NO_ACCESS = 0x82  # CFSR: a data access that the MPU refused, with its address
CODE_RAM = 0x0080_0000  # nRF52833 Product Specification, memory map. QEMU has nothing there: a read that the MPU lets through is another fault
OVERRUN = 1 << 22  # port/cortex-m4/fault.hpp
AT_REST, AT_60_DEGREES = 500, 1500  # us
LEFT, RIGHT = AT_WILL[:2]
ACTUATORS = [
    {"name": "left_arm", "type": "PWM", "pin": LEFT, "device": "servo", "range": ["0deg", "120deg"], "on_release": "rest"},
    {"name": "right_arm", "type": "PWM", "pin": RIGHT, "device": "servo", "range": ["0deg", "120deg"]}]
CONFIG = {"board": NAME, "sensors": touched.SENSORS, "actuators": ACTUATORS}
PROGRAM = f"""
BEHAVIOR wild PRIORITY 20
  WHEN {touched.WILD_IS_TOUCHED}
  DO MOVE left_arm TO 100deg AT 20deg/s
  END
END
BEHAVIOR tame PRIORITY 10
  WHEN {touched.TAME_IS_TOUCHED}
  DO MOVE right_arm TO 60deg
  END
END
"""


class FirmwareTest(DebuggedTest):
    def setUp(self):
        super().setUp()
        self.symbols = symbols(FIRMWARE)
        self.pulses = outputs.Outputs(self.board, self.folder).pulses
        self.hand = touched.Hand(self.board, self.folder)
        self.addCleanup(self.hand.close)

    def qemu_arguments(self):
        return [*outputs.arguments(self.folder), *touched.arguments(self.folder), *super().qemu_arguments()]

    def upload(self, text, robot):
        program, config = self.folder / "program.rsl", self.folder / "robot.json"
        program.write_text(text)
        config.write_text(json.dumps(robot))
        rsc.run("upload", program, "--config", config, "--port", self.board.port)


class Isolation(FirmwareTest):
    def expect(self, reader, **wanted):
        def came(lines):
            found = [json.loads(line) for line in lines]
            return any(all(e.get(key) == value for key, value in wanted.items()) for e in found)

        self.assertTrue(reader.wait_for(came, PATIENCE), f"no {wanted} in {reader.lines}")

    def main_stack_left(self):
        """Bytes of the handlers' stack that were never used: the board's RAM is zero at start."""
        size = self.symbols["main_stack_size"]
        with self.debugger() as debugger:
            words = debugger.read_words(self.symbols["main_stack_top"] - size, size // 4)
        return 4 * next(i for i, word in enumerate(words) if word)

    def make_wild(self, address=LINE):
        """The next time the interpreter runs for the behaviour, its machine is at this address: by default that of a serial line."""
        interpreter = next(at for name, at in self.symbols.items() if name.startswith(INTERPRETER))
        with self.debugger() as debugger:
            debugger.run_to(interpreter, lambda: self.hand.change(WILD))
            debugger.set_register(0, address)

    def make_endless(self):
        """The next time the interpreter runs for the behaviour, it jumps into an endless loop."""
        interpreter = next(at for name, at in self.symbols.items() if name.startswith(INTERPRETER))
        with self.debugger() as debugger:
            debugger.run_to(interpreter, lambda: self.hand.change(WILD))
            debugger.set_register(PC, endless_loop())

    def test_a_wild_behaviour_is_stopped(self):
        self.stops(self.make_wild, cause=NO_ACCESS, address=LINE)

    @unittest.skipUnless(NAME == "microbit-v2", "no other board shows its RAM a second time")
    def test_the_second_place_of_the_ram_is_closed_as_well(self):
        self.stops(lambda: self.make_wild(CODE_RAM), cause=NO_ACCESS, address=CODE_RAM)

    def test_a_behaviour_that_never_ends_is_stopped(self):
        self.stops(self.make_endless, cause=OVERRUN, pc=endless_loop())

    def stops(self, make_wild, **report):
        self.upload(PROGRAM, CONFIG)
        reader = LineReader("monitor", "--port", self.board.port, "--format", "json")
        try:
            self.assertTrue(reader.wait_for(lambda lines: lines, PATIENCE))  # it listens
            self.hand.touch(WILD)
            self.expect(reader, event="command", actuator="left_arm")
            make_wild()
            self.expect(reader, event="fault", thread="wild", **report)
            self.expect(reader, event="interrupt", behavior="wild")
            self.expect(reader, event="cancel", actuator="left_arm")
            self.hand.touch(TAME)
            self.expect(reader, event="command", actuator="right_arm")
            self.expect(reader, event="done", actuator="right_arm")
        finally:
            reader.stop()
        self.assertEqual(self.pulses(), {LEFT: AT_REST, RIGHT: AT_60_DEGREES})
        # A handler is deepest when it reports a fault; the NMI may still come on top of it.
        self.assertGreaterEqual(self.main_stack_left(), NMI_NEEDS)
        info = rsc.info(self.board.port)
        states = {thread["name"]: thread["state"] for thread in info["threads"]}
        self.assertEqual((states["wild"], states["tame"]), ("stopped", "blocked"))
        status = info["status"]
        self.assertEqual((status["faults"], status["safety_late_us"]), (1, 0))
        self.assertGreaterEqual(status["safety_checks"], status["program_us"] // 10_000)


SKIN_CONFIG = {
    "board": NAME,
    "sensors": [
        {"name": "pad", "type": "I2C", "bus": 0, "address": "0x70", "device": "max34451",
         "channels": {"FORCE": {"input": 0, "range": [0, 10], "rate": "50Hz"}}},
        {"name": "other", "type": "I2C", "bus": 0, "address": "0x70", "device": "max34451",
         "channels": {"LEVEL": {"input": 1, "range": [0, 10], "rate": "50Hz"}}}],
    "actuators": ACTUATORS,
    "algorithms": [{"name": "skin", "module": "touch_levels", "input": "pad", "config": {"light": 1, "firm": 5}}]}
SKIN_PROGRAM = """
BEHAVIOR feels PRIORITY 20
  WHEN skin LEVEL IS firm
  DO MOVE left_arm TO 60deg
  END
END
BEHAVIOR tame PRIORITY 10
  WHEN other LEVEL > 2
  DO MOVE right_arm TO 60deg
  END
END
"""
MODULE = "touch_levels_process"
ARENA = 0x20004000  # behaviours may read it, modules may not
PUNISH = "robosync::layers::AlgorithmLayer::punish("
TICK = "SysTick_Handler"
LOWERED = 9  # below the last behaviour


@unittest.skipUnless(touched.ON_A_BUS, "QEMU has no I2C of this board: no sensor touches the module")
class Algorithms(FirmwareTest):
    """A module that goes wild: it is lowered or stopped, its outputs become unknown, and everything else continues."""

    def setUp(self):
        super().setUp()
        self.board.set_touch(0, 0)
        self.board.set_touch(0, 1)
        self.upload(SKIN_PROGRAM, SKIN_CONFIG)
        self.reader = LineReader("monitor", "--port", self.board.port, "--format", "json")
        for value in [1, 2] * 50:  # until the monitor listens
            self.board.set_touch(value, 1)
            if self.reader.wait_for(lambda lines: lines, 0.2):
                break

    def tearDown(self):
        if self.reader:
            self.reader.stop()
        super().tearDown()

    def events(self, **wanted):
        found = [json.loads(line) for line in self.reader.lines]
        return [e for e in found if all(e.get(key) == value for key, value in wanted.items())]

    def expect(self, **wanted):
        self.assertTrue(self.reader.wait_for(lambda _: self.events(**wanted), PATIENCE),
                        f"no {wanted} in {self.reader.lines}")

    def in_module(self, act):
        """Calls act(debugger) the next time the module is called."""
        with self.debugger() as debugger:
            debugger.run_to(self.symbols[MODULE], lambda: None)
            act(debugger)

    def stay(self, debugger):
        """Makes it take milliseconds instead of some microseconds."""
        debugger.set_register(PC, endless_loop())
        for _ in range(3):
            debugger.run_to(self.symbols[TICK], lambda: None)
            debugger.run_to(endless_loop(), lambda: None)
        debugger.set_register(PC, self.symbols[MODULE])

    def others_go_on(self, stopped, priority=20):
        self.assertLessEqual({e["thread"] for e in self.events(event="fault")}, {"skin"})
        self.board.set_touch(6, 1)
        self.expect(event="command", actuator="right_arm")
        self.expect(event="done", actuator="right_arm")
        self.reader.stop()
        self.reader = None
        info = rsc.info(self.board.port)
        threads = {thread["name"]: (thread["state"], thread["priority"]) for thread in info["threads"]}
        self.assertEqual(threads["skin"], ("stopped" if stopped else "blocked", priority))
        self.assertEqual(threads["feels"], ("blocked", 20))
        status = info["status"]
        self.assertEqual((status["faults"], status["safety_late_us"]), (1 if stopped else 0, 0))

    def test_one_that_touches_what_is_not_its_own_is_stopped(self):
        """It may not even access what behaviours may read."""
        self.in_module(lambda debugger: debugger.set_register(2, ARENA))  # an argument that it only reads
        self.expect(event="fault", thread="skin", cause=NO_ACCESS)
        self.expect(event="stale", sensor="skin")
        address = next(fault["address"] for fault in self.events(event="fault", cause=NO_ACCESS))
        self.assertTrue(ARENA <= address < ARENA + 64, hex(address))
        self.others_go_on(stopped=True)

    def test_one_that_takes_longer_than_it_declares_is_lowered_and_stopped_the_next_time(self):
        self.in_module(self.stay)
        self.expect(event="lowered", sensor="skin")
        self.board.set_touch(6, 0)
        self.expect(event="command", actuator="left_arm")  # it works nevertheless
        self.assertEqual(self.events(event="fault"), [])
        self.in_module(self.stay)
        self.expect(event="fault", thread="skin", cause=OVERRUN)
        self.assertEqual(len(self.events(event="lowered")), 1)
        self.expect(event="stale", sensor="skin")
        self.others_go_on(stopped=True, priority=LOWERED)

    def stay_until_seen(self, debugger):
        """Stays until the safety monitor, which checks every ten milliseconds, has seen it."""
        punish = next(at for name, at in self.symbols.items() if name.startswith(PUNISH))
        debugger.set_register(PC, endless_loop())
        debugger.run_to(punish, lambda: None)
        debugger.run_to(endless_loop(), lambda: None)
        debugger.set_register(PC, self.symbols[MODULE])

    def test_one_that_the_monitor_has_seen_is_not_told_twice_in_one_release(self):
        self.in_module(self.stay_until_seen)
        self.expect(event="lowered", sensor="skin")
        self.board.set_touch(6, 0)
        self.expect(event="command", actuator="left_arm")
        self.assertEqual(self.events(event="fault"), [])
        self.others_go_on(stopped=False, priority=LOWERED)

    def test_one_that_never_ends_is_lowered_and_stopped(self):
        self.in_module(lambda debugger: debugger.set_register(PC, endless_loop()))
        self.expect(event="lowered", sensor="skin")
        self.expect(event="fault", thread="skin", cause=OVERRUN, pc=endless_loop())
        self.expect(event="stale", sensor="skin")
        self.others_go_on(stopped=True, priority=LOWERED)


class LargeModule(FirmwareTest):
    """One with more memory than a kilobyte: its region of the MPU is as large as its record in the image says, and no larger."""

    REGION = 10 * 1024

    def test_it_stays_within_it(self):
        arena = json.loads((ROOT / f"stdlib/boards/{NAME}.json").read_text())["arena"]
        begin = int(arena["begin"], 16) + arena["bytes"] - self.REGION
        robot = json.loads(self.for_board(PROGRAMS / "listening.json").read_text())
        self.upload((PROGRAMS / "listening.rsl").read_text(), robot)
        reader = LineReader("feed", *(f"microphone.BANDS_{i}=0" for i in range(1, 5)), "--port", self.board.port,
                            "--watch", "60s", "--format", "json")
        try:
            self.assertTrue(reader.wait_for(lambda lines: any('"channel":"WORD"' in line for line in lines), PATIENCE))
            with self.debugger() as debugger:
                debugger.run_to(self.symbols["own_words_process"], lambda: None)
                debugger.set_register(2, begin - 32)  # an argument that it only reads
            self.assertTrue(reader.wait_for(lambda lines: any('"event":"fault"' in line for line in lines), PATIENCE))
        finally:
            reader.stop()
        fault, *_ = [event for event in map(json.loads, reader.lines) if event["event"] == "fault"]
        self.assertEqual((fault["thread"], fault["cause"]), ("voice", NO_ACCESS))
        self.assertTrue(begin - 32 <= fault["address"] < begin, hex(fault["address"]))


SAFETY_PROGRAM = f"""
SAFETY pinch
  WHEN {touched.TAME_IS_PRESSED}
  DO STOP ALL
  RESUME WHEN {touched.TAME_IS_FREE}
END
""" + PROGRAM
IN_SANDBOX = "robosync::safety::(anonymous namespace)::run_bytecode("  # (machine, code, progress)
KERNEL = "robosync_kernel"


class Safety(FirmwareTest):
    """SAFETY's bytecode can access only its own memory, although it runs in the safety thread."""

    def setUp(self):
        super().setUp()
        self.hand.rest(TAME)
        self.upload(SAFETY_PROGRAM, CONFIG)

    def place(self, begin):
        return next(at for name, at in self.symbols.items() if name.startswith(begin))

    def in_sandbox(self, act):
        """Calls act(debugger) the next time a SAFETY rule's bytecode begins."""
        with self.debugger() as debugger:
            debugger.run_to(self.place(IN_SANDBOX), lambda: None)
            return act(debugger)

    def test_what_it_can_read(self):
        """As far as QEMU can tell: it checks the beginning of a page with the MPU."""
        def look(debugger):
            places = {"the program": debugger.register(1), "flash": self.symbols["memset"], "the kernel": self.symbols[KERNEL],
                      "the watchdog": WATCHDOG}
            return {what for what, at in places.items() if debugger.read_words(at, 1) is not None}

        self.assertEqual(self.in_sandbox(look), {"the program", "flash"})

    def ends_in_a_reset(self, act, address):
        self.in_sandbox(act)
        give_up = time.monotonic() + PATIENCE
        while (status := rsc.info(self.board.port)["status"])["reset_reason"] != "software":
            self.assertLess(time.monotonic(), give_up, status)
        fault = status["last_fault"]
        self.assertEqual((fault["thread"], fault["cause"], fault["address"]), ("safety", NO_ACCESS, address))
        self.assertEqual(self.pulses(), {})

    def test_one_that_reads_what_is_not_its_own_ends_in_a_reset_with_all_outputs_off(self):
        self.ends_in_a_reset(lambda debugger: debugger.set_register(0, LINE), LINE)

    def writes(self, target):
        def clear(debugger):
            debugger.set_register(0, target)
            debugger.set_register(1, 0)
            debugger.set_register(2, 4)
            debugger.set_register(PC, self.symbols["memset"])

        self.ends_in_a_reset(clear, target)

    def test_one_that_writes_the_kernels_memory_does_too(self):
        self.writes(self.symbols[KERNEL])

    def test_one_that_writes_to_the_watchdog_does_too(self):
        self.writes(WATCHDOG)

    def test_one_that_writes_the_flash_does_too(self):
        self.writes(self.symbols["memset"])


if __name__ == "__main__":
    unittest.main()

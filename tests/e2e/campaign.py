"""The safety campaign: faults of all kinds in the shipped firmware, at drawn instants, and a hazard beside each.

A run uploads a program that moves an arm and a motor, injects one fault at a random place of the firmware, and causes a
hazard before or after it: a reading that trips SAFETY, or a stop frame. From the hazard on, the board is inspected each
time it kicks its watchdog or enters its NMI, until the bound has passed: by then, and from then on, all outputs
must be off. A pin that the program does not have must never be driven, and after a reset no pin at all.

The seed and the number of the run determine what happens, and at which place of the firmware, so that a single run can be
repeated. Only the arrival times of bytes on the line depend on the host.
"""

import argparse
import json
import random
import re
import socket
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "scripts/python"), str(ROOT / "bench"), str(Path(__file__).resolve().parent)]

import rsc  # noqa: E402
import wire  # noqa: E402
from board import FIRMWARE, Board, end_on_signals  # noqa: E402
from counting import of_the_board, symbols  # noqa: E402
from debugger import INTERPRETER, PC, Debugger, endless_loop  # noqa: E402

CLOCK = 0x40001004  # timer 1, which counts down
CLOCK_MHZ = 25
UART = 0x40004000
NOWHERE = 0xA0000000
SP, LR = 13, 14
PINS = 36
ARM, MOTOR = 3, 4
LEVEL, HAZARD = 0, 1  # inputs of the sensor
STALE_MS = 100
BOUND_MS = STALE_MS + 20  # a sensor that has just measured falls silent; one period of the safety thread, one of the sensor
STAYS = 3  # inspections after the bound
MOST_KICKS = 30  # watchdog kicks for which a fault waits for its place
STARTS = 5
ATTEMPTS = 160  # of a quarter of a second: the machine may be busy
STOP = b"\0" + wire.frame("stop", sequence=255)
CONFIG = {
    "sensors": [{"name": "touch", "type": "I2C", "bus": 0, "address": "0x70", "device": "max34451", "channels": {
        "LEVEL": {"input": LEVEL, "range": [0, 10], "rate": "50Hz", "stale_after": f"{STALE_MS}ms"},
        "HAZARD": {"input": HAZARD, "range": [0, 10], "rate": "50Hz", "stale_after": f"{STALE_MS}ms"}}}],
    "actuators": [
        {"name": "arm", "type": "PWM", "pin": ARM, "device": "servo", "range": ["0deg", "100deg"], "safe": "coast"},
        {"name": "motor", "type": "PWM", "pin": MOTOR, "device": "pwm", "on_release": "hold"}]}
PROGRAM = """
SAFETY pinch
  WHEN touch HAZARD > 7
  DO STOP ALL
  RESUME WHEN touch HAZARD < 2
END
BEHAVIOR moves PRIORITY 20
  EVERY 40ms DO
    MOVE arm TO 100deg AT 20deg/s
    RUN motor TO 70%
  END
END
BEHAVIOR thinks PRIORITY 10
  REMEMBER n = 0
  EVERY 20ms DO
    REPEAT 100 TIMES
      RAISE n BY 1
      LOWER n BY 1
    END
  END
END
"""
# Where a fault is injected: functions that the board calls all the time. The interpreter runs in the behaviours' threads.
PLACES = {"interpreter": INTERPRETER, "sensor": "robosync::layers::Mailboxes::post(",
          "actuator": "robosync::guard::OutputGuard::drive(", "bus": "robosync::boards::AskingBoard<robosync::boards::mps2::Buses>::i2c_transfer(",
          "bits": "Timer0_Handler",
          "safety": "robosync::Runtime::look_at_rules(", "switch": "PendSV_Handler"}
WATCHED = {"kick": of_the_board("Board::watchdog_kick()"), "nmi": "NMI_Handler", "reset": "Reset_Handler",
           "said": "robosync::Runtime::say(bool)"}
GRANT = "robosync::kernel::Kernel::grant("


class Violation(AssertionError):
    """The board did something forbidden."""


class WasReset(Exception):
    """The board restarts: only its outputs can still be wrong."""


def addresses():
    known = symbols(FIRMWARE)
    wanted = {**PLACES, **WATCHED, "grant": GRANT}
    found = {key: next(at for name, at in known.items() if name.startswith(start)) for key, start in wanted.items()}
    return {**found, "endless": endless_loop(), "pulses": known["robosync_virtual_pwm"], "kernel": known["robosync_kernel"]}


class Control(Debugger):
    """The debugger, with additions for the campaign."""

    stands = False  # the board has stopped at a place

    def run_until(self, places):
        """Lets the board run until it reaches one of {name: address}; returns the name. If it stands at such a place, it first
        steps off it, since QEMU would not leave it; but a sleeping core must not be stepped, or its timers stop."""
        if self.stands:
            self._ask("s")
        for address in places.values():
            self._expect_ok(f"Z0,{address:x},2")
        stopped = self._ask("c")
        if not stopped.startswith(("T05", "S05")):
            raise AssertionError(f"the board stopped for another reason: {stopped}")
        self.stands = True
        for address in places.values():
            self._expect_ok(f"z0,{address:x},2")
        at = self.register(PC)
        return next(name for name, address in places.items() if address == at)

    def __exit__(self, kind, *rest):
        """A board that hangs no longer answers, nor does one that never reached the place where it was to stop."""
        if kind is not None and issubclass(kind, (Violation, TimeoutError)):
            self._socket.close()
        else:
            super().__exit__(kind, *rest)

    def flip(self, address, bit):
        """Does nothing if the running thread cannot read the address."""
        raw = self._ask(f"m{address:x},1")
        if raw.startswith("E"):
            return
        self._expect_ok(f"M{address:x},1:{int(raw, 16) ^ 1 << bit:02x}")


class Line(wire.Line):
    """Repeats a request until it is answered, as rsc does."""

    def patient(self, name, payload=b"", reply=None):
        self._socket.settimeout(0.25)
        for _ in range(ATTEMPTS):
            try:
                self.send_raw(b"\0")  # ends any rest of noise
                return self.ask(name, payload, reply)
            except (socket.timeout, TimeoutError, ValueError, KeyError):
                continue
        raise Violation(f"no answer to {name}")

    def upload(self, image):
        size, name = len(image), wire.name_of(image)
        self.patient("hello", self.introduction(), "hello_reply")
        for _ in range(ATTEMPTS):
            begun = self.beginning(size, name)
            status = wire.unpack("TransferStatus", self.patient("begin", begun, "transfer_status"))
            while status.next_offset < size:
                at = status.next_offset
                data = wire.piece_head(self.session, at) + image[at:at + 236]
                status = wire.unpack("TransferStatus", self.patient("data", data, "transfer_status"))
            yield status
            if wire.unpack("ActivateResult", self.patient("activate", wire.activation(self.session, name), reply="activate_result")).running:
                return
        raise Violation("a good program is refused")


class Run:
    """One fault and one hazard on a board that has started."""

    def __init__(self, robot, number):
        self.robot = robot
        self.random = random.Random(f"{robot.seed}/{number}")
        self.fault = self.random.choice(list(FAULTS))
        self.hazard = self.random.choice(("reading", "reading", "stop"))
        self.hazard_first = self.random.random() < 0.5
        self.gdb = None
        self.told = []  # for the report of a violation
        self.since = None  # the clock's count at the hazard

    def say(self, what):
        self.told.append(what)

    def go(self):
        try:
            with Control(self.robot.gdb) as self.gdb:
                steps = [lambda: FAULTS[self.fault](self), self.come]
                for step in reversed(steps) if self.hazard_first else steps:
                    step()
                self.watch()
        except WasReset:
            self.look_behind_a_reset()

    def look_behind_a_reset(self):
        """Works without the debugger: with one attached, QEMU's watchdog fires too early while the board starts."""
        self.say("reset")
        self.robot.line.patient("get_status", reply="status")
        for _ in range(5 * STAYS):
            if driven := {pin for pin, pulse in enumerate(self.robot.pulses()) if pulse}:
                raise Violation(f"driven after a reset: {driven}")

    def come(self):
        """Causes the hazard. For a stop, it begins when the last byte has arrived, unless the board fails before."""
        self.say(f"hazard: {self.hazard}")
        if self.hazard == "reading":
            self.robot.board.set_touch(9, HAZARD)
        else:
            self.robot.line.send_raw(STOP)
            self.await_one_of("said", "nmi", "reset")
        self.since = self.robot.clock()

    def await_one_of(self, *names):
        """Returns which one came. A board that hangs and reaches none of them is a violation."""
        try:
            came = self.gdb.run_until({name: self.robot.at[name] for name in names})
        except socket.timeout:
            raise Violation(f"the board comes to none of {names}") from None
        if came == "reset":
            raise WasReset
        return came

    def watch(self):
        behind = 0
        while behind < STAYS:
            self.look(self.await_one_of("kick", "nmi", "reset"))
            behind += self.is_over()

    def is_over(self):
        return self.since is not None and self.passed_ms() > BOUND_MS

    def passed_ms(self):
        return (self.since - self.robot.clock()) % (1 << 32) / 1000 / CLOCK_MHZ

    def look(self, came):
        pulses = self.robot.pulses()
        driven = {pin for pin, pulse in enumerate(pulses) if pulse}
        if driven - {ARM, MOTOR}:
            raise Violation(f"pins that nobody has are driven: {driven}")
        if driven and self.is_over():
            raise Violation(f"{driven} driven {self.passed_ms():.1f} ms after the hazard, at {came}")

    # --- faults ---

    def to(self, place, at_most=30):
        """Waits until the board has reached the place a random number of times, but not for ever: halted actuators never do.
        False if the board fails before."""
        times, kicks = self.random.randint(1, at_most), 0
        while times > 0 and kicks < MOST_KICKS:
            came = self.await_one_of(place, "kick", "nmi", "reset")
            if came == "nmi":
                return False
            if came == "kick":
                self.look(came)
                kicks += 1
            times -= came == place
        self.say(f"at {place}" if times == 0 else "at a kick")
        return True

    def to_behavior(self):
        """Stops in a behaviour's thread, recognized because it may not read the kernel's memory."""
        skipped = self.random.randint(0, 12)
        for _ in range(200):
            if self.await_one_of("interpreter", "nmi", "reset") != "interpreter":
                return False
            if self.gdb.read_words(self.robot.at["kernel"], 1) is None:
                skipped -= 1
                if skipped < 0:
                    return True
        return False  # SAFETY has stopped them

    def flip_bits(self):
        if not self.to_behavior():
            return
        begin, size = self.robot.writable
        stack = self.gdb.register(SP)
        for _ in range(self.random.randint(1, 12)):
            in_stack = self.random.random() < 0.3
            address = stack + self.random.randrange(160) if in_stack else begin + self.random.randrange(size)
            self.gdb.flip(address, self.random.randrange(8))

    def crash(self):
        if self.to_behavior():
            self.gdb.set_register(PC, NOWHERE)

    def go_wild(self):
        if self.to_behavior():
            self.gdb.set_register(0, UART)

    def spin(self):
        if self.to_behavior():
            self.gdb.set_register(PC, self.robot.at["endless"])

    def exhaust_stack(self):
        if self.to_behavior():
            self.gdb.set_register(SP, self.gdb.register(SP) - self.random.choice((256, 1024, 4096)))

    def crash_anybody(self):
        if self.to(self.random.choice(list(PLACES))):
            self.gdb.set_register(PC, NOWHERE)

    def hang_anybody(self):
        if self.to(self.random.choice(list(PLACES))):
            self.gdb.set_register(PC, self.robot.at["endless"])

    def fail_bus(self):
        for _ in range(self.random.randint(1, 25)):
            if self.await_one_of("bus", "nmi", "reset") != "bus":
                return
            self.gdb.set_register(0, 0)  # no acknowledge
            self.gdb.set_register(PC, self.gdb.register(LR) & ~1)

    def storm(self):
        self.to(self.random.choice(list(PLACES)))
        self.robot.line.send_raw(b"\xff" * self.random.randint(100, 3000))

    def make_noise(self):
        self.to(self.random.choice(list(PLACES)))
        self.robot.line.send_raw(self.random.randbytes(self.random.randint(1, 600)))

    def cut_upload(self):
        self.robot.line.send_raw(b"\0" + wire.frame("begin", self.robot.line.beginning(2000, self.random.randbytes(8))))
        data = wire.frame("data", wire.piece_head(self.robot.line.session, 0) + self.random.randbytes(200))
        self.robot.line.send_raw(data[:self.random.randrange(len(data))])
        self.to(self.random.choice(list(PLACES)))

    def reset(self):
        self.to(self.random.choice(list(PLACES)))
        self.robot.board.qmp.command("system_reset")
        raise WasReset


FAULTS = {"nothing": lambda run: run.to("switch"), "bits flipped": Run.flip_bits, "behaviour crashes": Run.crash,
          "behaviour goes wild": Run.go_wild, "behaviour spins": Run.spin, "stack exhausted": Run.exhaust_stack,
          "anybody crashes": Run.crash_anybody, "anybody hangs": Run.hang_anybody, "bus fails": Run.fail_bus,
          "interrupts storm": Run.storm, "noise": Run.make_noise, "upload is cut": Run.cut_upload, "reset": Run.reset}


class Robot:
    """A board that runs the campaign's program."""

    def __init__(self, seed, folder):
        self.seed, self.gdb = seed, Path(folder) / "gdb"
        self.at = addresses()
        (Path(folder) / "robot.json").write_text(json.dumps(CONFIG))
        (Path(folder) / "robot.rsl").write_text(PROGRAM)
        rsc.run("compile", Path(folder) / "robot.rsl", "-o", Path(folder) / "robot.rsb", "--seed", 1, "--anyway")
        self.image = (Path(folder) / "robot.rsb").read_bytes()
        self.board = Board(icount="shift=5,sleep=off", extra=["-gdb", f"unix:{self.gdb},server=on,wait=off"])
        self.line = Line(self.board.port)
        try:
            self.writable = self._find_writable()
        except BaseException:
            self.stop()
            raise

    def _find_writable(self):
        """(address, bytes) of what the behaviours' threads may write."""
        uploaded = self.line.upload(self.image)
        next(uploaded)
        activate = wire.frame("activate", wire.activation(self.line.session, wire.name_of(self.image)))
        with Control(self.gdb) as debugger:
            debugger.run_to(self.at["grant"], lambda: self.line.send_raw(activate))
            _, _, begin, size = debugger.read_words(debugger.register(1), 4)
        return begin, size

    def words(self, address, count):
        """Words of the memory, even while the firmware runs."""
        said = self.board.qmp.command("human-monitor-command", **{"command-line": f"xp /{count}xw {address:#x}"})
        return [int(word, 16) for word in re.findall(r"0x([0-9a-f]{8})\b", said)]

    def clock(self):
        return self.words(CLOCK, 1)[0]

    def pulses(self):
        return self.words(self.at["pulses"], PINS)

    def begin(self):
        """Starts the program without a hazard, and waits until both actuators move."""
        for channel in (LEVEL, HAZARD):
            self.board.set_touch(1, channel)
        for _ in self.line.upload(self.image):
            pass
        self.line.patient("resume", self.line.resumption(), "status")
        give_up = time.monotonic() + 20
        while not all(self.pulses()[pin] for pin in (ARM, MOTOR)):
            if time.monotonic() > give_up:
                raise Violation("the robot does not move")

    def stop(self):
        self.line.close()
        self.board.stop()


def start(seed, folder):
    """Starts a robot. If the machine is so busy that QEMU's watchdog resets the board under the debugger, tries another one."""
    for _ in range(STARTS - 1):
        try:
            return Robot(seed, folder)
        except TimeoutError:
            continue
    return Robot(seed, folder)


def campaign(runs, seed, first=0, show=lambda *_: None):
    """[(number of the run, fault, what was done, what went wrong)] of the failed runs. A violation replaces the board."""
    wrong, robot = [], None
    with tempfile.TemporaryDirectory(prefix="robosync-campaign-") as folder:
        try:
            for number in range(first, first + runs):
                robot = robot or start(seed, folder)
                run = Run(robot, number)
                try:
                    robot.begin()
                    run.go()
                except Violation as violation:
                    wrong.append((number, run.fault, run.told, str(violation)))
                    robot.stop()
                    robot = None
                show(number, run, wrong)
        finally:
            if robot:
                robot.stop()
    return wrong


def main():
    parser = argparse.ArgumentParser(prog="campaign.py", description=__doc__.split("\n", 1)[0])
    parser.add_argument("runs", type=int)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--first", type=int, default=0, help="number of the first run")
    wanted = parser.parse_args()

    def show(number, *_):
        if (number + 1 - wanted.first) % 100 == 0:
            print(f"{number + 1 - wanted.first} of {wanted.runs}", flush=True)

    end_on_signals()
    wrong = campaign(wanted.runs, wanted.seed, wanted.first, show)
    for number, fault, told, what in wrong:
        print(f"{number}: {fault} ({', '.join(told)}): {what}; again: campaign.py 1 --seed {wanted.seed} --first {number}")
    print(f"{wanted.runs - len(wrong)} passed, {len(wrong)} failed")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())

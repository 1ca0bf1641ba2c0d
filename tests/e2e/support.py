"""Shared by the end-to-end tests: compiling, scenarios, and a robot that runs a program."""

import json
import os
import signal
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

import rsc
from board import DEVICES, FAST, FIRMWARE, NAME, ROOT, Board

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "generators/programs"))

import on_board  # noqa: E402
from stimuli import UNITS  # noqa: E402

PROGRAMS = HERE / "programs"
CONFIG = PROGRAMS / "robot.json"
SEED = 20_250_711
PROFILE = json.loads((ROOT / f"stdlib/boards/{NAME}.json").read_text("utf-8"))


def pins_in(rows):
    """The pins in a list of the profile."""
    return [pin for row in rows for pin in range(row["pins"][0], row["pins"][1] + 1)]


INPUTS, OUTPUTS, ENABLES = pins_in(PROFILE["inputs"]), pins_in(PROFILE["outputs"]), pins_in(PROFILE.get("enables", []))
# The outputs on which a pulse may be as short and as long as a program wants it.
AT_WILL = pins_in(row for row in PROFILE["outputs"] if row["pulse_us"] == [0, 20_000])

needs_i2c = unittest.skipUnless(NAME in DEVICES, "QEMU has no I2C of this board to which a device can be connected")

STOPS_WHEN_FAR = """
SAFETY far
  WHEN near X > 90
  DO STOP ALL
  RESUME WHEN near X < 5
END
"""

# A motor that runs forward at 70 % when `near` is above 10, and backward at 25 % when it is above 50.
TURNS_ROUND = """
WHEN near X > 10
DO RUN wheel TO 70%
END
WHEN near X > 50
DO RUN wheel BACKWARD AT 25%
END
"""


def wheel_on(forward, back):
    """The robot.json for TURNS_ROUND, with the motor on these two pins."""
    return json.dumps({
        "board": NAME,
        "sensors": [{"name": "near", "type": "VIRTUAL", "channels": {"X": {"range": [0, 100]}}}],
        "actuators": [{"name": "wheel", "type": "PWM", "pins": [forward, back], "device": "motor"}]})


PATIENCE = 20  # seconds


class RobotTest(unittest.TestCase):
    """One board for each test, and a folder that is deleted after it. ROBOSYNC_BOARD in the environment selects the board."""

    elf = FIRMWARE
    icount = FAST
    before = "null"  # character device for the output of the machine's other serial lines
    units = UNITS  # of the channels that scenarios feed

    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="robosync-e2e-")
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        self.switch_on()

    def switch_on(self):
        self.board = Board(self.elf, icount=self.icount, extra=self.qemu_arguments(), before=self.before)
        self.addCleanup(self.board.stop)

    def restart(self):
        self.board.stop()
        self.switch_on()

    def qemu_arguments(self):
        return []

    def compile(self, program, config=CONFIG):
        image = self.folder / f"{Path(program).stem}.rsb"
        config = self.for_board(config)
        # With a seed, because the board would otherwise choose another one at each start.
        rsc.run("compile", program, "--config", config, "--seed", SEED, "-o", image, "--anyway")
        return image

    def for_board(self, config):
        """Adapts a robot.json to the running board: to pins that it has."""
        robot = on_board.read(config)
        wired_as_it_can(robot.get("actuators", []))
        path = self.folder / "robot.json"
        path.write_text(json.dumps({**robot, "board": NAME}))
        return path

    def upload(self, program, *arguments):
        return rsc.run("upload", program, "--port", self.board.port, *arguments)

    def status(self):
        return rsc.info(self.board.port)["status"]

    def listen(self):
        """A monitor that tells events as JSON, from now on."""
        reader = LineReader("monitor", "--port", self.board.port, "--format", "json")
        self.addCleanup(reader.stop)
        self.assertTrue(reader.wait_for(lambda lines: lines, PATIENCE))
        return reader

    def await_event(self, reader, event, times=1, **wanted):
        wanted = {"event": event, **wanted}

        def came(lines):
            return sum(wanted.items() <= json.loads(line).items() for line in lines) >= times
        self.assertTrue(reader.wait_for(came, PATIENCE), (wanted, reader.lines[-8:]))

    def write_scenario(self, readings, lead_ms):
        stimuli = [{"at": f"{lead_ms + r.at_ms}ms", "sensor": r.channel.split(".")[0],
                    "channel": r.channel.split(".")[1], "value": f"{r.value}{self.units[r.channel]}"} for r in readings]
        path = self.folder / "scenario.json"
        path.write_text(json.dumps({"stimuli": stimuli}))
        return path


def wired_as_it_can(actuators):
    """Moves actuators from pins that the board does not have for them to free ones. Those for which there are none become virtual."""
    taken = {int(str(pin), 0) for actuator in actuators for pin in pins_of(actuator)}
    free = [pin for pin in OUTPUTS if pin not in taken]
    enables = {}
    for actuator in actuators:
        allowed = AT_WILL if actuator.get("device") in ("motor", "pwm", "differential_drive") else OUTPUTS
        pins = pins_of(actuator)
        found = [pin for pin in free if pin in allowed][:len(pins)]
        if "enable" in actuator:
            at = enables.setdefault(actuator["enable"], len(enables))
            if at >= len(ENABLES):
                become_virtual(actuator)
            else:
                actuator["enable"] = ENABLES[at]
        elif all(int(str(pin), 0) in allowed for pin in pins):
            continue
        elif len(found) < len(pins):
            become_virtual(actuator)
        else:
            free = [pin for pin in free if pin not in found]
            actuator.update({"left": found[:2], "right": found[2:]} if "left" in actuator else
                            {"pin": str(found[0])} if "pin" in actuator else {"pins": found})


def pins_of(actuator):
    if "left" in actuator:
        return [*actuator["left"], *actuator["right"]]
    return [actuator["pin"]] if "pin" in actuator else actuator.get("pins", [])


def become_virtual(actuator):
    for wiring in ("pin", "pins", "bus", "address", "channel", "enable"):
        actuator.pop(wiring, None)
    actuator["type"] = "VIRTUAL"


def host_trace(image, scenario, until_ms):
    """The lines of `rsc run`."""
    return rsc.run("run", image, "--fresh", "--scenario", scenario, "--duration", f"{until_ms}ms",
                   "--format", "json").splitlines()


class LineReader:
    """The stdout of a running rsc, line by line, without waiting for its end.

    It goes through a file, which never blocks: an rsc that had to wait for this process would not
    read from the board, whose virtual time does not wait.
    """

    def __init__(self, *arguments):
        self.lines = []
        self._file = tempfile.TemporaryFile()
        self._rest = b""
        self._process = subprocess.Popen([str(rsc.TOOL), *map(str, arguments)],
                                         stdin=subprocess.DEVNULL, stdout=self._file,
                                         stderr=subprocess.PIPE)
        self._read_to = 0

    def _read(self):
        data = os.pread(self._file.fileno(), os.fstat(self._file.fileno()).st_size, self._read_to)
        self._read_to += len(data)
        *whole, self._rest = (self._rest + data).split(b"\n")
        self.lines += [line.decode() for line in whole]

    def wait_for(self, condition, timeout):
        """True if condition(lines) becomes true before the timeout and before rsc ends."""
        deadline = time.monotonic() + timeout
        while True:
            ended = self._process.poll() is not None
            self._read()
            if condition(self.lines):
                return True
            if ended or time.monotonic() > deadline:
                return False
            time.sleep(0.01)

    def stop(self):
        """Ends rsc, if it still runs; returns its stderr."""
        return self.end(signal.SIGTERM)[1] if self._process.stderr is not None else ""

    def end(self, ending):
        """Sends the signal, if any, and waits for the end; returns the exit code and stderr."""
        if ending is not None:
            self._process.send_signal(ending)
        errors = self._process.stderr.read().decode()
        code = self._process.wait()
        self._read()
        self._process.stderr.close()
        self._process.stderr = None
        self._file.close()
        return code, errors

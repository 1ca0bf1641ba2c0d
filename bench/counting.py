"""Runs an ELF in QEMU under the counting plugin, and returns the counts between markers."""

import copy
import functools
import re
import struct
import subprocess
import tempfile
import time
from pathlib import Path

from board import FIRMWARE, qemu

ROOT = Path(__file__).resolve().parents[1]
BUILT = ROOT / "build/m4/bench"
PLUGIN = ROOT / "build/host/bench/libcount_plugin.so"
TIMEOUT = 120
PATIENCE = 60  # seconds; normally one is enough, but the machine may be busy
IMAGE_ADDRESS = 0x21000000  # bench/firmware/given.hpp
READINGS_ADDRESS = 0x21100000
READING = "robosync::layers::Mailboxes::post("  # called at the sensor's sample rate, so it serves as a clock in the robot's time


class BenchError(RuntimeError):
    """Something that a figure needs is missing, or the bench firmware reports a failure."""


@functools.cache
def symbols(elf):
    """{name: address} of an ELF. C++ names are demangled, and the Thumb bit is cleared."""
    listing = subprocess.run(["arm-none-eabi-nm", "-C", str(elf)], check=True, text=True,
                             stdout=subprocess.PIPE).stdout
    found = {}
    for line in listing.splitlines():
        words = line.split(maxsplit=2)
        if len(words) == 3 and line[0] != " ":  # undefined symbols have no address, and a few have no name
            found[words[2]] = int(words[0], 16) & ~1
    return found


def functions(*wanted):
    """{start of a name: address} of functions in the shipped firmware."""
    found = {begin: at for name, at in symbols(FIRMWARE).items() for begin in wanted if name.startswith(begin)}
    if len(found) != len(wanted):
        raise BenchError(f"the firmware has not all of {wanted}")
    return found


@functools.cache
def of_the_board(name):
    """Puts the namespace of the firmware's own board in front of a name."""
    for known in symbols(FIRMWARE):
        if found := re.match(r"robosync::boards::\w+::(?=Board::)", known):
            return found[0] + name
    raise BenchError(f"no code of a board in {FIRMWARE}")


class Count(int):
    """A number of executed instructions, at a mark or between two. When the plugin profiles, it also knows which
    instructions these were. A count chosen by max() and the like keeps that; other arithmetic gives a plain number."""

    def __new__(cls, value, places, line=None):
        count = super().__new__(cls, value)
        count.places = places  # for each line of the plugin's output: [(address, how often it ran)]
        count.line = line  # of the mark
        return count

    def __add__(self, other):
        """Adds instructions that are not in the profile."""
        return Count(int(self) + int(other), self.places)

    def __sub__(self, other):
        difference = int(self) - int(other)
        if self.line is None or not isinstance(other, Count):
            return difference
        return Count(difference, self.places[other.line + 1:self.line + 1])


class Marks:
    """What the plugin wrote: [(marker name, instructions executed before it)], and for each mark the instructions
    counted apart. Also what the firmware printed: [[word, number …]]."""

    def __init__(self, names, path, said=""):
        by_address = {address: name for name, address in names.items()}
        lines = [line.split() for line in path.read_text().splitlines()]
        places = [[(int(address, 16), int(count)) for address, count in (word.split(":") for word in line[3:])]
                  for line in lines]
        self.all = [(by_address[int(line[0], 16)], Count(line[1], places, i)) for i, line in enumerate(lines)]
        self.apart = [int(line[2]) for line in lines]
        lines = (line.split() for line in said.splitlines())
        self.said = [[word, *map(int, numbers)] for word, *numbers in lines]

    def spans(self, begin, end):
        """Instructions from each `begin` to the next `end`."""
        found, start = [], None
        for name, count in self.all:
            if name == begin:
                start = count
            elif name == end and start is not None:
                found.append(count - start)
                start = None
        if not found:
            raise BenchError(f"never ran from {begin} to {end}")
        return found

    def parts(self, begin, end):
        """The marks from each `begin` to the next `end`, each as Marks."""
        names = [name for name, _ in self.all]
        found = []
        for start in (i for i, name in enumerate(names) if name == begin):
            part = copy.copy(self)
            part.all = self.all[start:names.index(end, start)]
            found.append(part)
        return found

    def heard(self, what):
        """The numbers of each printed line that begins with this word."""
        return [numbers for word, *numbers in self.said if word == what]


def wait_for_readings(path, times, what=READING):
    """Waits until the plugin has written this many more marks of readings: a time on the robot's clock, however slow
    the host is. `what`: another function to count."""
    mark = f"{functions(what)[what]:x} "
    deadline = time.monotonic() + PATIENCE
    with open(path, encoding="ascii") as lines:
        lines.seek(0, 2)
        while times > 0:
            if time.monotonic() > deadline:
                raise BenchError(f"the board has not come to {what} for long")
            line = lines.readline()
            times -= line.startswith(mark)
            if not line:
                time.sleep(0.01)


profiling = False  # whether the plugin also writes a profile (profiled.py)


def plugin_arguments(names, out, apart=()):
    """`apart`: [(begin, end)] of the code whose instructions are counted separately."""
    if not PLUGIN.exists():
        raise BenchError(f"no {PLUGIN}: build the preset host first")
    marks = "".join(f",mark={address:#x}" for address in names.values())
    ranges = "".join(f",apart={begin:#x}-{end:#x}" for begin, end in apart)
    return ["-plugin", f"{PLUGIN},out={out}{marks}{ranges}{',profile=on' if profiling else ''}"]


def code_of_function(function):
    """[(address, instruction)] of the function in the shipped firmware whose name begins with `function`."""
    listing = subprocess.run(["arm-none-eabi-objdump", "-d", "-C", "--no-show-raw-insn", str(FIRMWARE)], check=True,
                             text=True, stdout=subprocess.PIPE).stdout
    code = re.search(rf"^\w+ <{re.escape(function)}.*?^$", listing, re.M | re.S)
    if not code:
        raise BenchError(f"the firmware has no {function}")
    return [(int(at, 16), what) for at, what in re.findall(r"^\s*(\w+):\s+(.+)$", code[0], re.M)]


def ends_of(function):
    """Addresses of the function's return instructions."""
    return [at for at, what in code_of_function(function) if what.endswith("pc}") or what == "bx\tlr"]


def begin_of(handler):
    """The address of the second instruction of an interrupt handler: if the interrupt comes during a device access,
    QEMU does not show the first one to the plugin."""
    return code_of_function(handler)[1][0]


def return_instructions(elf, function):
    """Addresses of the return instructions of an exception handler."""
    listing = subprocess.run(["arm-none-eabi-objdump", "-d", f"--disassemble={function}", str(elf)],
                             check=True, text=True, stdout=subprocess.PIPE).stdout
    found = [line.split(":")[0] for line in listing.splitlines() if line.endswith("bx\tlr")]
    return [int(address, 16) for address in found]


def loaded(path, address):
    return ["-device", f"loader,file={path},addr={address:#x},force-raw=on"]


def run_given(elf, image, readings=(), extra=None):
    """run() with an image, and with the readings that its rules or CHECKs get one after another."""
    with tempfile.TemporaryDirectory(prefix="robosync-bench-") as folder:
        file = Path(folder) / "readings"
        file.write_bytes(struct.pack(f"<{1 + len(readings)}i", len(readings), *readings))
        return run(elf, loaded(image, IMAGE_ADDRESS) + loaded(file, READINGS_ADDRESS), extra)


def run(elf, arguments=(), extra=None):
    """Boots a bench firmware, which ends QEMU itself. Returns its marks and the `extra` ones."""
    if not Path(elf).exists():
        raise BenchError(f"no {elf}: build the preset m4 first")
    names = {name: at for name, at in symbols(elf).items() if name.startswith("mark_")}
    names |= extra or {}
    with tempfile.TemporaryDirectory(prefix="robosync-bench-") as folder:
        out = Path(folder) / "marks"
        done = subprocess.run([*qemu(), "-serial", "none", "-kernel", str(elf),
                               "-icount", "shift=0,sleep=off", "-semihosting",
                               *plugin_arguments(names, out), *arguments],
                              check=False, timeout=TIMEOUT, text=True, stdin=subprocess.DEVNULL,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        if done.returncode:
            raise BenchError(f"{Path(elf).name} failed ({done.returncode}): {done.stdout.strip()}")
        return Marks(names, out, done.stdout)

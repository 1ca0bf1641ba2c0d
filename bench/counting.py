"""Runs an ELF in QEMU under the counting plugin, and gives what was counted between markers."""

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
PATIENCE = 60  # seconds for what takes one, on a busy machine
IMAGE_ADDRESS = 0x21000000  # bench/firmware/given.hpp
READINGS_ADDRESS = 0x21100000
READING = "robosync::layers::Mailboxes::post("  # a sensor's, which it takes at its rate: a clock of the robot's own


class BenchError(RuntimeError):
    """Something needed for a figure is missing, or the bench firmware says it failed."""


@functools.cache
def symbols(elf):
    """{name: address} of an ELF, C++ names as the source writes them, the Thumb bit taken off."""
    listing = subprocess.run(["arm-none-eabi-nm", "-C", str(elf)], check=True, text=True,
                             stdout=subprocess.PIPE).stdout
    found = {}
    for line in listing.splitlines():
        words = line.split(maxsplit=2)
        if len(words) == 3 and line[0] != " ":  # undefined ones have no address, a few no name
            found[words[2]] = int(words[0], 16) & ~1
    return found


def functions(*wanted):
    """{beginning of a name: address} of the shipped firmware's functions."""
    found = {begin: at for name, at in symbols(FIRMWARE).items() for begin in wanted if name.startswith(begin)}
    if len(found) != len(wanted):
        raise BenchError(f"the firmware has not all of {wanted}")
    return found


@functools.cache
def of_the_board(name):
    """What the code of the firmware's own board begins with, whichever board that is."""
    for known in symbols(FIRMWARE):
        if found := re.match(r"robosync::boards::[a-z]\w*::", known):
            return found[0] + name
    raise BenchError(f"no code of a board in {FIRMWARE}")


class Count(int):
    """A number of executed instructions, which knows which they were when the plugin profiles: at a mark, or between two.
    What is chosen of several by max() and its like still does; what is figured out of them is a number."""

    def __new__(cls, value, places, line=None):
        count = super().__new__(cls, value)
        count.places = places  # of each line of the plugin's: [(address, how often it ran)]
        count.line = line  # of a mark
        return count

    def __add__(self, other):
        """What ran later, of which nobody knows what it was."""
        return Count(int(self) + int(other), self.places)

    def __sub__(self, other):
        difference = int(self) - int(other)
        if self.line is None or not isinstance(other, Count):
            return difference
        return Count(difference, self.places[other.line + 1:self.line + 1])


class Marks:
    """What the plugin wrote: [(marker name, instructions executed before it)], and for each of them those
    executed apart; and what the firmware said: [[word, number …]]."""

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
        """The marks from each `begin` to the next `end`, as marks of their own."""
        names = [name for name, _ in self.all]
        found = []
        for start in (i for i, name in enumerate(names) if name == begin):
            part = copy.copy(self)
            part.all = self.all[start:names.index(end, start)]
            found.append(part)
        return found

    def heard(self, what):
        """The numbers of each line that began with this word."""
        return [numbers for word, *numbers in self.said if word == what]


def wait_for_readings(path, times, what=READING):
    """Until the plugin has written so many marks of readings from now on: so much time has passed for the robot, however
    slow the host is. Or of another function."""
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


profiling = False  # does the plugin say what ran (profile.py)?


def plugin_arguments(names, out, apart=()):
    """`apart`: [(begin, end)] of the code whose instructions are counted by themselves."""
    if not PLUGIN.exists():
        raise BenchError(f"no {PLUGIN}: build the preset host first")
    marks = "".join(f",mark={address:#x}" for address in names.values())
    ranges = "".join(f",apart={begin:#x}-{end:#x}" for begin, end in apart)
    return ["-plugin", f"{PLUGIN},out={out}{marks}{ranges}{',profile=on' if profiling else ''}"]


def code_of_function(function):
    """[(address, instruction)] of a function of the shipped firmware, whose name begins so."""
    listing = subprocess.run(["arm-none-eabi-objdump", "-d", "-C", "--no-show-raw-insn", str(FIRMWARE)], check=True,
                             text=True, stdout=subprocess.PIPE).stdout
    code = re.search(rf"^\w+ <{re.escape(function)}.*?^$", listing, re.M | re.S)
    if not code:
        raise BenchError(f"the firmware has no {function}")
    return [(int(at, 16), what) for at, what in re.findall(r"^\s*(\w+):\s+(.+)$", code[0], re.M)]


def ends_of(function):
    """Addresses of the instructions by which it returns."""
    return [at for at, what in code_of_function(function) if what.endswith("pc}") or what == "bx\tlr"]


def begin_of(handler):
    """The second instruction of an interrupt's handler: of one that comes while a device is accessed, QEMU shows the plugin no
    first one."""
    return code_of_function(handler)[1][0]


def return_instructions(elf, function):
    """Addresses of the instructions by which an exception handler returns."""
    listing = subprocess.run(["arm-none-eabi-objdump", "-d", f"--disassemble={function}", str(elf)],
                             check=True, text=True, stdout=subprocess.PIPE).stdout
    found = [line.split(":")[0] for line in listing.splitlines() if line.endswith("bx\tlr")]
    return [int(address, 16) for address in found]


def loaded(path, address):
    return ["-device", f"loader,file={path},addr={address:#x},force-raw=on"]


def run_given(elf, image, readings=(), extra=None):
    """run() with an image, and the readings that its rules or CHECKs get one after the other."""
    with tempfile.TemporaryDirectory(prefix="robosync-bench-") as folder:
        file = Path(folder) / "readings"
        file.write_bytes(struct.pack(f"<{1 + len(readings)}i", len(readings), *readings))
        return run(elf, loaded(image, IMAGE_ADDRESS) + loaded(file, READINGS_ADDRESS), extra)


def run(elf, arguments=(), extra=None):
    """Boots a bench firmware (it ends QEMU itself); gives its marks, and the `extra` ones."""
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

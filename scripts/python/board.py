"""The robot's board in QEMU: boots the firmware and gives access to its serial line and its touch sensor.

Used by scripts/robot, scripts/demo and tests/e2e. ROBOSYNC_BOARD in the environment selects the board; the preset
with its firmware must have been built. Guarantees that QEMU ends with the `with` block or the process, and that its
temporary files are deleted.
"""

import functools
import json
import os
import re
import shutil
import signal
import socket
import subprocess
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PRESETS = json.loads((ROOT / "CMakePresets.json").read_text("utf-8"))["configurePresets"]
REFERENCE = next(preset for preset in PRESETS if preset["name"] == "m4")["cacheVariables"]["ROBOSYNC_BOARD"]
NAME = os.environ.get("ROBOSYNC_BOARD", REFERENCE)
# A twin is built in the folder of the board whose runtime it shares.
OF = {twin: told["ROBOSYNC_BOARD"] for told in (preset.get("cacheVariables", {}) for preset in PRESETS)
      for twin in filter(None, told.get("ROBOSYNC_TWINS", "").split(";"))}
BUILT = ROOT / "build" / (f"{OF[NAME]}/{NAME}" if NAME in OF else "m4" if NAME == REFERENCE else NAME)
FIRMWARE = BUILT / "robosync.elf"
# The devices on its buses in QEMU.
DEVICES = {REFERENCE: ["-device", "max34451,id=touch,address=0x70"]}
# Its store, whose size is in its profile and whose content is in a file: an EEPROM, or part of the flash, from that address on.
# QEMU cannot back the flash by a file: this loads it at the start, and saves it at the end.
EEPROMS = {REFERENCE: "at24c-eeprom,address=0x50,rom-size={size},drive=store"}
FLASHES = {"microbit-v2": 0x8_0000 - 221_184, "b-l475e-iot01a": 0x0808_0000, "nucleo-l476rg": 0x0808_0000}
KEEPS_BY_ITSELF = {"microbit-v2"}  # in QEMU it has its store without a file, too: that one is blank at the start
BLANK = b"\xff"
HAVE_WATCHDOG = {REFERENCE}  # in QEMU
SINCE = {"b-l475e-iot01a": (9, 2), "nucleo-l476rg": (9, 2), "microbit-v2": (9, 2)}
UNPACKED = ROOT / "build/qemu/usr"  # by scripts/emulator
# The boards for which scripts/emulator makes a QEMU of their own, and further options of the machine: bytes of its memory, or how
# much may be loaded into it.
MADE = {"microbit-v2": ROOT / "build/qemu-microbit-v2"}
MEMORY = {"microbit-v2": ["-global", "nrf51-soc.sram-size=131072", "-global", "nrf51-soc.flash-size=524288"],
          "b-l475e-iot01a": ["-m", "1M"], "nucleo-l476rg": ["-m", "1M"]}
LOSES_INTERRUPT = {"microbit-v2"}  # its UART's, when a byte has to wait
TOUCH = "/machine/peripheral/touch"  # the MAX34451 on the I2C bus, QMP path
BOOT_SECONDS = 20  # on a busy machine
# Virtual time counts instructions, so that the firmware does not miss deadlines because the host is busy. While the
# firmware idles,
REAL_TIME = "shift=5,sleep=on"  # 32 ns each (about 25 MHz): time follows the host's clock, without its jumps;
FAST = "shift=4,sleep=off"  # 16 ns each (an STM32F401's 84 MHz): idle time is skipped.


STEADY_CLOCK = ROOT / "build/host/libsteady_clock.so"  # scripts/steady_clock


class BoardError(RuntimeError):
    """QEMU is missing, did not start, or ended."""


def told_by_build(what):
    """One of the settings that the board's board.cmake makes for emulators."""
    file = BUILT / what
    if not file.is_file():
        raise BoardError(f"no {file}: run scripts/firmware {NAME} first")
    return file.read_text("utf-8").strip()


def machine():
    """QEMU's name of the board, or of the one that substitutes for it."""
    return told_by_build("machine")


def lines_before(device):
    """QEMU's options for the serial lines before the link's."""
    return ["-serial", device] * int(told_by_build("line"))


@functools.cache
def emulator():
    """The installed QEMU if it has the board, otherwise the one that scripts/emulator has unpacked or made."""
    installed = shutil.which("qemu-system-arm")
    if installed is None:
        raise BoardError("qemu-system-arm is not installed (Debian package qemu-system-arm)")
    since = SINCE.get(NAME, (0, 0))
    said = subprocess.run([installed, "--version"], check=True, text=True, stdout=subprocess.PIPE).stdout
    if tuple(map(int, re.search(r"version (\d+)\.(\d+)", said).groups())) >= since:
        return [made(installed)]
    unpacked = UNPACKED / "bin/qemu-system-arm"
    if not unpacked.is_file():
        raise BoardError(f"{NAME} needs QEMU {since[0]}.{since[1]} or newer: run scripts/emulator first")
    return [made(str(unpacked)), "-L", str(UNPACKED / "share/qemu")]


def made(program):
    """The QEMU that was made from `program` for this board, if any."""
    own = MADE.get(NAME)
    if own is not None and not own.is_file():
        raise BoardError(f"{NAME} needs a QEMU of its own, which is not there: run scripts/emulator first")
    return str(own or program)


def qemu():
    """The command that starts QEMU with that board."""
    return [*emulator(), "-M", machine(), *MEMORY.get(NAME, []), "-display", "none", "-monitor", "none"]


class Qmp:
    """QEMU's control socket: one command at a time, events skipped."""

    def __init__(self, path):
        self._socket = socket.socket(socket.AF_UNIX)
        self._socket.settimeout(BOOT_SECONDS)
        try:
            self._socket.connect(str(path))
        except OSError:
            self._socket.close()
            raise
        self._lines = self._socket.makefile("rw", encoding="utf-8")
        self._lines.readline()  # the greeting
        self.command("qmp_capabilities")

    def command(self, name, **arguments):
        self._lines.write(json.dumps({"execute": name, "arguments": arguments}) + "\n")
        self._lines.flush()
        while line := self._lines.readline():
            reply = json.loads(line)
            if "error" in reply:
                raise BoardError(f"QMP {name}: {reply['error']['desc']}")
            if "return" in reply:
                return reply["return"]
        raise BoardError("QEMU ended")

    def close(self):
        self._lines.close()
        self._socket.close()


def with_store(path):
    """QEMU's options for the board's store."""
    if NAME not in EEPROMS and NAME not in FLASHES:
        raise BoardError(f"{NAME} has no store in QEMU")
    size = store_bytes()
    try:
        with open(path, "ab") as file:
            if file.tell() not in (0, size):
                raise BoardError(f"{path} is something else: a store has {size} bytes, this file {file.tell()}")
            if file.tell() == 0:
                file.write(BLANK * size)
    except OSError as error:
        raise BoardError(f"{path}: {error.strerror}") from error
    name = str(path).replace(",", ",,")
    if NAME in FLASHES:
        return ["-device", f"loader,file={name},addr={FLASHES[NAME]:#x},force-raw=on"]
    return ["-drive", f"if=none,format=raw,file={name},id=store", "-device", EEPROMS[NAME].format(size=size)]


def store_bytes():
    return json.loads((ROOT / "stdlib/boards" / f"{NAME}.json").read_text("utf-8"))["store"]


def socket_of(port):
    """A connection to a --port of rsc that is a socket of either kind."""
    kind, place = port.split(":", 1)
    if kind == "tcp":
        host, number = place.rsplit(":", 1)
        line = socket.create_connection((host, int(number)))
        line.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)  # sends each byte when it is written, as a line does
        return line
    line = socket.socket(socket.AF_UNIX)
    line.connect(place)
    return line


class Board:
    """One running board. `port` is a --port for rsc."""

    def __init__(self, elf=FIRMWARE, pty=False, serial_path=None, icount=REAL_TIME, extra=(), store=None, line=None, before="null"):
        """`store`: a file with the board's non-volatile memory, created if missing; None: the board keeps nothing. `line`: one
        of QEMU's character devices, instead of one that rsc can use; then there is no `port`. `before`: the character device
        for the output of the machine's serial lines before the link's."""
        if not Path(elf).is_file():
            raise BoardError(f"no firmware at {elf}: run scripts/firmware {NAME} first")
        self._folder = tempfile.TemporaryDirectory(prefix="robosync-")
        self.qmp_path = Path(self._folder.name) / "qmp"
        self._serial_path = Path(serial_path or Path(self._folder.name) / "serial").resolve()
        self._pty = pty
        self._line = line
        self._before = before
        # A Unix socket blocks after some hundred unread bytes, TCP after megabytes. When it blocks, a board whose time runs
        # ahead loses events of its trace, and QEMU's micro:bit loses the interrupt of its UART.
        self._tcp = (icount == FAST or NAME in LOSES_INTERRUPT) and not pty and not serial_path and not line
        self._log = Path(self._folder.name) / "qemu.log"
        self._flash_file = store if NAME in FLASHES else None
        self._process = self._start(elf, icount, [*extra, *(with_store(store) if store else [])])
        self.qmp = None
        try:
            self.qmp = self._connect()
            self.port = self._find_port()
        except BaseException:
            self.stop()
            raise

    def _start(self, elf, icount, extra):
        line = "pty" if self._pty else f"socket,path={self._serial_path},server=on,wait=off"
        if self._tcp:
            line = "socket,host=127.0.0.1,port=0,server=on,wait=off,nodelay=on"
        line = self._line or line
        command = [*qemu(), "-kernel", str(elf),
                   "-chardev", f"{line},id=line", *lines_before(self._before), "-serial", "chardev:line",
                   *DEVICES.get(NAME, []),
                   "-qmp", f"unix:{self.qmp_path},server=on,wait=off",
                   "-icount", icount, *extra]
        environment = {**os.environ}
        if str(UNPACKED / "share/qemu") in command:
            environment["QEMU_MODULE_DIR"] = str(UNPACKED / "lib/x86_64-linux-gnu/qemu")  # those of its own build
        if icount == REAL_TIME:
            if not STEADY_CLOCK.is_file():  # ld.so would only warn
                raise BoardError(f"no {STEADY_CLOCK}: build rsc of the preset host first")
            environment["LD_PRELOAD"] = str(STEADY_CLOCK)
        with open(self._log, "wb") as log:
            return subprocess.Popen(command, env=environment, stdin=subprocess.DEVNULL, stdout=log, stderr=log,
                                    start_new_session=True)

    def _connect(self):
        deadline = time.monotonic() + BOOT_SECONDS
        while time.monotonic() < deadline:
            self.check()
            try:
                return Qmp(self.qmp_path)
            except (FileNotFoundError, ConnectionRefusedError):
                time.sleep(0.02)
        raise BoardError("QEMU does not answer on its control socket")

    def _find_port(self):
        if self._line:
            return None
        if not self._pty and not self._tcp:
            return f"unix:{self._serial_path}"
        for device in self.qmp.command("query-chardev"):
            if device["label"] == "line" and self._tcp:
                return re.search(r"tcp:[\d.]+:\d+", device["filename"])[0]
            if device["label"] == "line":
                return device["filename"].removeprefix("pty:")
        raise BoardError("QEMU made no line")

    def check(self):
        """Raises with QEMU's last words if it is no longer running."""
        if self._process.poll() is not None:
            raise BoardError(f"QEMU ended ({self._process.returncode}): {self.log()}")

    def log(self):
        return self._log.read_text(encoding="utf-8", errors="replace").strip()

    def wait(self):
        return self._process.wait()

    def processor_seconds(self):
        """What QEMU has used of this machine's processor: while the firmware never sleeps, the board's time goes on with it."""
        used = Path(f"/proc/{self._process.pid}/stat").read_text().rpartition(")")[2].split()[11:13]  # user, system
        return sum(map(int, used)) / os.sysconf("SC_CLK_TCK")

    def hold_up(self, seconds):
        """Stops QEMU for this time, as a busy host would."""
        self._process.send_signal(signal.SIGSTOP)
        try:
            time.sleep(seconds)
        finally:
            self._process.send_signal(signal.SIGCONT)

    def set_touch(self, raw, channel=0):
        """Sets what the touch sensor's input measures from now on, as its raw 16-bit number."""
        self.qmp.command("qom-set", path=TOUCH, property=f"vout[{channel}]", value=raw)

    def word(self, address):
        """A word of its memory, even while the firmware runs."""
        said = self.qmp.command("human-monitor-command", **{"command-line": f"xp /1xw {address:#x}"})
        return int(said.split()[1], 16)

    def cut_power(self):
        """Immediately, whatever the firmware is doing."""
        self._save_flash()
        self._process.kill()
        self._process.wait()
        self.stop()

    def _save_flash(self):
        if self._flash_file is None or self.qmp is None:
            return
        self.qmp.command("stop")
        self.qmp.command("memsave", val=FLASHES[NAME], size=store_bytes(), filename=str(Path(self._flash_file).resolve()))
        self._flash_file = None

    def stop(self):
        if self.qmp and self._process.poll() is None:
            self._save_flash()
        if self.qmp:
            self.qmp.close()
            self.qmp = None
        if self._process.poll() is None:
            self._process.terminate()
            try:
                self._process.wait(timeout=5)
            except subprocess.TimeoutExpired:
                self._process.kill()
                self._process.wait()
        if not self._pty:
            self._serial_path.unlink(missing_ok=True)
        self._folder.cleanup()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.stop()


def end_on_signals():
    """Turns SIGTERM and SIGHUP into SystemExit, so that `with Board()` cleans up."""
    def leave(number, _frame):
        raise SystemExit(128 + number)

    for number in (signal.SIGTERM, signal.SIGHUP):
        signal.signal(number, leave)

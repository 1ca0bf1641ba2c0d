"""scripts/demo, after the build. Everything shown comes from rsc and the firmware; nothing is staged.

It also checks what it shows: exit code 1 if the robot does not react as the program says, or if it
stopped, restarted or skipped a safety check during the second upload.
"""

import difflib
import re
import subprocess
import sys
import tempfile
import threading
import time
from pathlib import Path

import periods
import rsc
from board import Board, BoardError, end_on_signals, machine

ROOT = rsc.ROOT
EXAMPLE = ROOT / "examples/touch_companion"
READINGS = range(6)
BEFORE = 9  # the reading while a program starts, so that reading 0 is a change
HOLD_SECONDS = 0.5  # how long each reading lasts after the robot has noticed it
PATIENCE_SECONDS = 15
LEAST_CHECKS = 0.95  # of those that were due; checks are skipped while the computer is too busy
SAFETY_PERIOD_US = 1000 * periods.safety_ms()
OLD, NEW = "LEVEL < 3", "LEVEL < 5"
GENTLE, HARSH = "greeting.wav", "warning.wav"  # the sounds tell the two responses apart
RESPONSES = {GENTLE: "gentle_response", HARSH: "aggressive_response"}


class DemoError(RuntimeError):
    """The robot did not do what the program says."""


def step(text):
    print(f"\n\033[1m{text}\033[0m" if sys.stdout.isatty() else f"\n{text}", flush=True)


def indent(text):
    for line in text.rstrip().splitlines():
        print(f"    {line}")
    sys.stdout.flush()


def show_rsc(*arguments):
    """Runs rsc, showing the command and all its output."""
    shown = [str(a).replace(str(ROOT) + "/", "") for a in arguments]
    print(f"  $ rsc {' '.join(shown)}")
    done = rsc.call(*arguments)
    indent(done.stderr + done.stdout)
    if done.returncode:
        raise DemoError(f"rsc {arguments[0]} ended with {done.returncode}")
    return done.stdout + done.stderr


class Monitor:
    """`rsc monitor` in the background: shows its lines as they come, and stores them."""

    def __init__(self, board):
        self.lines = []
        self._board = board
        self._shows = False
        self._process = subprocess.Popen([str(rsc.TOOL), "monitor", "--port", board.port], text=True,
                                         stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                                         stderr=subprocess.STDOUT, bufsize=1)
        self._reader = threading.Thread(target=self._read, daemon=True)
        self._reader.start()

    def _read(self):
        for line in self._process.stdout:
            self.lines.append(line.rstrip())
            if self._shows:
                print(f"      {line.rstrip()}", flush=True)

    def wait_for(self, text, since):
        """Waits until a line after the first `since` lines ends in `text`."""
        deadline = time.monotonic() + PATIENCE_SECONDS
        while not any(line.endswith(text) for line in self.lines[since:]):
            if time.monotonic() > deadline:
                raise DemoError(f"the robot does not say `{text}`")
            time.sleep(0.02)

    def __enter__(self):
        """Returns when the monitor listens. Until it prints more than the board's name, the touch reading alternates above the
        threshold."""
        deadline = time.monotonic() + PATIENCE_SECONDS
        while len(self.lines) < 2 and time.monotonic() < deadline:
            self._board.set_touch(BEFORE - 1)
            time.sleep(0.1)
            self._board.set_touch(BEFORE)
            time.sleep(0.1)
        self.wait_for(f"touch LEVEL = {BEFORE}", 0)
        self._shows = True
        return self

    def __exit__(self, *_):
        self._process.terminate()
        self._process.wait()
        self._reader.join()


def touch_and_watch(board, threshold):
    """Touches with 0 … 5, and checks the response to each reading."""
    with Monitor(board) as monitor:
        for reading in READINGS:
            before = len(monitor.lines)
            print(f"    touch {reading}", flush=True)
            board.set_touch(reading)
            monitor.wait_for(f"touch LEVEL = {reading}", before)
            time.sleep(HOLD_SECONDS)
            said = "\n".join(monitor.lines[before:])
            expect_response(reading, threshold, said)


def expect_response(reading, threshold, said):
    """A rule reacts to an edge: a response runs when the reading crosses over, here only at the threshold."""
    started = {name for name in (GENTLE, HARSH) if name in said}
    wanted = {HARSH} if reading == threshold else set()
    if reading == READINGS[0]:
        wanted = {GENTLE}
    for sound in started:
        print(f"    -> {RESPONSES[sound]}", flush=True)
    if started != wanted:
        raise DemoError(f"touch {reading}: {started or 'nothing'} ran, not {wanted or 'nothing'}")


def change_threshold(folder):
    """A copy of the program with another threshold; shows the difference."""
    old = (EXAMPLE / "robot.rsl").read_text()
    new = old.replace(OLD, NEW)
    if new == old:
        raise DemoError(f"robot.rsl does not say `{OLD}`")
    (folder / "robot.rsl").write_text(new)
    (folder / "robot.json").write_bytes((EXAMPLE / "robot.json").read_bytes())
    lines = list(difflib.unified_diff(old.splitlines(), new.splitlines(), lineterm="", n=0))
    indent("\n".join(lines[3:]))
    return folder / "robot.rsl"


def check_went_on(before, after):
    """Checks that the board did not reboot and the safety checks continued. Their lateness is shown, not judged: here QEMU's
    clock follows this computer's, so anything that delays QEMU makes the robot late. Where the clock
    counts instructions, tests/e2e requires that none is late."""
    seconds = (after["uptime_us"] - before["uptime_us"]) / 1e6
    checks = after["safety_checks"] - before["safety_checks"]
    print(f"    uptime         {before['uptime_us'] / 1e6:8.3f} s -> {after['uptime_us'] / 1e6:8.3f} s")
    print(f"    safety checks  {before['safety_checks']:8} -> {after['safety_checks']:8}"
          f"      ({checks / seconds:.1f} a second, latest {after['safety_late_us']} us late on this computer)")
    print(f"    activations    {before['activations']:8} -> {after['activations']:8}")
    if seconds <= 0:
        raise DemoError("the board has restarted")
    if after["activations"] != before["activations"] + 1:
        raise DemoError("the new program was not activated just once")
    if checks < LEAST_CHECKS * 1e6 * seconds / SAFETY_PERIOD_US:
        raise DemoError(f"only {checks} safety checks in {seconds:.3f} s")
    if after["faults"] != 0:
        raise DemoError("a thread has faulted")


def show(folder):
    program, image = EXAMPLE / "robot.rsl", folder / "robot.rsb"
    step("1. The program: the listing of the paper, and its robot.json")
    indent(program.read_text())
    step("2. Check it, and compile it to bytecode")
    show_rsc("check", program)
    show_rsc("compile", program, "-o", image)
    step(f"3. Boot the firmware on a Cortex-M4 (QEMU, {machine()}, touch sensor MAX34451 on I2C)")
    with Board() as board:
        board.set_touch(BEFORE)
        step("4. Upload the image over the serial line into the running firmware")
        show_rsc("upload", image, "--port", board.port)
        step("5. Touch the sensor: 0, 1, 2 … 5. The program says: below 3 is gentle")
        touch_and_watch(board, threshold=3)
        before = rsc.info(board.port)["status"]
        step("6. Change the threshold in the source, and upload again: no reboot, no reflash")
        changed = change_threshold(folder)
        board.set_touch(BEFORE)
        report = show_rsc("upload", changed, "--port", board.port)
        step("7. Touch it again. Now below 5 is gentle")
        touch_and_watch(board, threshold=5)
        step("8. And the robot was there all the time")
        check_went_on(before, rsc.info(board.port)["status"])
    size, milliseconds = re.search(r"(\d+) bytes in ([\d.]+) ms", report).groups()
    step(f"Uploaded into the running robot: {size} bytes in {milliseconds} ms")


def main():
    end_on_signals()
    try:
        with tempfile.TemporaryDirectory(prefix="robosync-demo-") as folder:
            show(Path(folder))
    except (DemoError, BoardError, rsc.RscError, subprocess.TimeoutExpired) as error:
        print(f"\ndemo: {error}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())

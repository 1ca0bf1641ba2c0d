"""Uploads that end in a power cut or a reset at a random instant: whatever was in progress, the robot then runs a program
that it had kept before, or the new one, intact.

Uses the board of ROBOSYNC_BOARD, which must have a store. The store is carried over from run to run, so its slots are used in
turn. The seed determines what happens and when; since the host runs in real time, the same seed hits other instants of the
board's.
"""

import argparse
import json
import random
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import rsc
from board import FAST, NAME, REFERENCE, end_on_signals
from player import StoredBoard

PATIENCE = 20  # seconds
LONGEST = 0.6  # from the call of `rsc upload` to the cut: an upload takes 0.1 s to 0.3 s, and keeping the program as long again
PROGRAM = "WHEN touch LEVEL > {threshold}\nDO LOG \"touched\", {threshold}\nEND\n"
ROBOT = {"board": NAME, "sensors": [{"name": "touch", "type": "VIRTUAL", "channels": {"LEVEL": {"range": [0, 10]}}}], "actuators": []}
SIZES = (1, 40)  # rules of the two programs: one frame, and many


class Broken(AssertionError):
    """The robot is not in a correct state after a cut."""


class Robot:
    """A board that can be switched off and on."""

    def __init__(self, folder):
        self.folder = Path(folder)
        self.images = [self._compile(rules) for rules in SIZES]
        self.board = None
        self.names = {}
        self.running = None

    def begin(self):
        """Switches it on and has it keep both programs."""
        self.switch_on()
        self.names = {image: self._keep(image) for image in self.images}

    def _compile(self, rules):
        program, image = self.folder / f"{rules}.rsl", self.folder / f"{rules}.rsb"
        (self.folder / "robot.json").write_text(json.dumps(ROBOT))
        program.write_text("".join(PROGRAM.format(threshold=rule % 10) for rule in range(rules)))
        rsc.run("compile", program, "--seed", 1, "-o", image)
        return image

    def _keep(self, image):
        rsc.run("upload", image, "--port", self.board.port)
        self.settle()
        return self.running

    def switch_on(self):
        self.board = StoredBoard(icount=FAST, store=self.folder / "store")

    def switch_off(self):
        if self.board:
            self.board.stop()

    def uploading(self, image):
        return subprocess.Popen([rsc.TOOL, "upload", image, "--port", self.board.port], stdin=subprocess.DEVNULL,
                                stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)

    def settle(self):
        """Waits until it runs a program and no trial is in progress; `running` is that program then."""
        give_up = time.monotonic() + PATIENCE
        while True:
            said = self.info(give_up)
            if said["kept"]["state"] == "kept" and said["board"]["program"]:  # it may have started with it between the two questions
                self.running = said["board"]["program"]["hash"]
                return
            if time.monotonic() > give_up:
                raise Broken(f"after {PATIENCE} s it still says {said['kept']}")

    def info(self, give_up):
        """Tries several times where the board may be slower than rsc waits: its flash is played, or its emulator is slow."""
        while True:
            try:
                return rsc.info(self.board.port)
            except rsc.RscError:
                if NAME == REFERENCE or time.monotonic() > give_up:
                    raise


def cut(robot):
    robot.board.cut_power()


def reset(robot):
    robot.board.reset()


def one(robot, draw):
    """Runs an upload to its end; returns what happened, in words."""
    image = next(image for image, name in robot.names.items() if name != robot.running)
    end = draw.choice((cut, reset))
    after = draw.random() * LONGEST
    upload = robot.uploading(image)
    time.sleep(after)
    end(robot)
    if end is cut:
        robot.switch_on()
    try:
        said = upload.communicate(timeout=PATIENCE)[1]
    except subprocess.TimeoutExpired:
        upload.kill()
        upload.communicate()
        raise Broken("rsc upload does not end") from None
    if upload.returncode not in (0, 1, 3) or (upload.returncode and not said.startswith("rsc: ")):
        raise Broken(f"rsc upload ended with {upload.returncode}: {said}")
    robot.settle()
    if robot.running not in robot.names.values():
        raise Broken(f"{robot.running} runs, which nobody has uploaded")
    which = "the new program" if robot.running == robot.names[image] else "the program before"
    return f"{end.__name__} {after * 1000:.0f} ms after the call of rsc, which ended with {upload.returncode}; {which} runs"


def campaign(runs, seed, show=lambda *_: None):
    """[(run, what is wrong)]"""
    wrong, draw = [], random.Random(seed)
    with tempfile.TemporaryDirectory(prefix="robosync-power-") as folder:
        robot = Robot(folder)
        try:
            robot.begin()
            for run in range(runs):
                try:
                    show(run, one(robot, draw))
                except (Broken, rsc.RscError) as error:
                    wrong.append((run, str(error)))
                    show(run, f"WRONG: {error}")
        finally:
            robot.switch_off()
    return wrong


def main():
    end_on_signals()
    parser = argparse.ArgumentParser(prog="scripts/soak power")
    parser.add_argument("runs", type=int)
    parser.add_argument("--seed", type=int, default=1)
    wanted = parser.parse_args()
    wrong = campaign(wanted.runs, wanted.seed, lambda run, what: print(f"{run}: {what}", flush=True))
    print(f"{wanted.runs} runs, {len(wrong)} wrong")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())

"""A sound player on the board's serial line: the emulated UART sends the bytes that a DFPlayer Mini expects. No emulator has the
module of the micro:bit's line; on_microbit.py checks its registers. ROBOSYNC_BOARD selects the board."""

import json
import re
import sys
import time
import unittest
from pathlib import Path

from support import NAME, ROOT, STOPS_WHEN_FAR, RobotTest

import rsc
from board import REAL_TIME

sys.path.append(str(Path(__file__).resolve().parents[2] / "bench"))

from counting import Marks, ends_of, functions, plugin_arguments

PATIENCE = 20
# UARTs between the link's and this one, as QEMU counts them; the Nucleo's comes right before the link's.
LINES_BETWEEN = {"mps2-an386": 0, "b-l475e-iot01a": 2}
LENGTH = 10
SILENCE = 0
PLAYS = """
BEHAVIOR plays PRIORITY 10
  WHEN near X > 10
  DO
    PLAY sound "two.wav" FOR 400ms
    THEN
    PLAY sound "three.wav" FOR 60s
  END
END
BEHAVIOR stops PRIORITY 20
  WHEN near X IS BETWEEN 30 AND 50 DO STOP sound END
  WHEN near X > 50 DO PLAY sound "one.wav" FOR 60s END
END
""" + STOPS_WHEN_FAR
OTHERS = "WHEN near X > 10 DO LOG \"no sound\" END\n"
END = "its end"
TELL = "robosync::guard::OutputGuard::tell("
SENT = {"mps2-an386": "Uart1Transmit_Handler"}.get(NAME, "Player_Handler")
COSTS = (ROOT / f"runtime-m4/boards/{NAME}/costs.def").read_text()


def command(number, high, low):
    """DFPlayer Mini's manual, "Serial mode": with the checksum, all bytes after the start byte add up to 0."""
    body = [0xFF, 6, number, 0, high, low]
    check = -sum(body) & 0xFFFF
    return bytes([0x7E, *body, check >> 8, check & 0xFF, 0xEF])


def sound_of(said):
    if said == command(0x16, 0, 0):
        return SILENCE
    number = said[5] << 8 | said[6]
    return number if said == command(0x12, *said[5:7]) else said.hex()


class PlayerTest(RobotTest):
    icount = REAL_TIME

    def qemu_arguments(self):
        self.heard = self.folder / "heard"
        if NAME not in LINES_BETWEEN:
            self.before = f"file:{self.heard}"
            return super().qemu_arguments()
        others = ["-serial", "null"] * LINES_BETWEEN[NAME]
        return [*others, "-serial", f"file:{self.heard}", *super().qemu_arguments()]

    def written(self, text):
        near = {"name": "near", "type": "VIRTUAL", "channels": {"X": {"range": [0, 100]}}}
        sound = {"name": "sound", "type": "UART", "device": "dfplayer", "sounds": ["one.wav", "two.wav", "three.wav"]}
        config = {"board": NAME, "sensors": [near], "actuators": [] if text == OTHERS else [sound]}
        (self.folder / "sound.json").write_text(json.dumps(config))
        (self.folder / "sound.rsl").write_text(text)
        return self.folder / "sound.rsl", "--config", self.folder / "sound.json"

    def say(self, verb, *arguments):
        return rsc.run(verb, *arguments, "--port", self.board.port)

    def begin(self):
        """Uploads the program with a reading that SAFETY accepts. Returns what the player is told until then: to be silent, as it
        may be playing anything; twice if SAFETY trips before the reading."""
        self.say("upload", *self.written(PLAYS))
        self.say("feed", "near.X=0")
        self.await_that(lambda sounds: sounds, "any")
        time.sleep(0.2)
        return self.sounds()

    def sounds(self):
        heard = self.heard.read_bytes()
        return [sound_of(heard[at:at + LENGTH]) for at in range(0, len(heard) - LENGTH + 1, LENGTH)]

    def await_that(self, fits, wanted):
        give_up = time.monotonic() + PATIENCE
        while not fits(seen := self.sounds()):
            self.assertLess(time.monotonic(), give_up, f"{seen}, not {wanted}")
            time.sleep(0.01)
        return seen

    def await_sounds(self, *wanted):
        return self.await_that(lambda sounds: sounds == list(wanted), wanted)


class Sound(PlayerTest):
    def test_it_plays_what_the_program_says_and_is_silent_when_that_ends(self):
        before = self.begin()
        self.say("feed", "near.X=20")
        before = self.await_sounds(*before, 2, 3)  # the second replaces the first
        self.say("feed", "near.X=40")
        before = self.await_sounds(*before, SILENCE)
        self.say("feed", "near.X=60")
        before = self.await_sounds(*before, 1)
        self.say("feed", "near.X=95")
        self.await_sounds(*before, SILENCE)

    def begin_to_play(self):
        before = self.begin()
        self.say("feed", "near.X=60")
        return self.await_sounds(*before, 1)

    def test_a_stop_ends_it(self):
        before = self.begin_to_play()
        self.say("stop")
        self.await_sounds(*before, SILENCE)

    def test_a_program_without_it_ends_it(self):
        before = self.begin_to_play()
        self.say("upload", *self.written(OTHERS))
        self.await_sounds(*before, SILENCE)


class Cost(PlayerTest):
    def qemu_arguments(self):
        self.marks, self.known = self.folder / "marks", functions(TELL, SENT)
        self.known[END] = ends_of(SENT)[-1]
        return [*plugin_arguments(self.known, self.marks), *super().qemu_arguments()]

    def most(self, marks, begin, end):
        """Most instructions from one mark to the other with no mark in between."""
        pairs = zip(marks.all, marks.all[1:])
        return max(after - before for (name, before), (other, after) in pairs if (name, other) == (begin, end))

    def test_what_a_command_costs(self):
        said = int(re.search(r"^COST\(say,\s*(\d+),", COSTS, re.M)[1])
        before = self.begin()
        self.say("feed", "near.X=20")
        self.await_sounds(*before, 2, 3)
        marks = Marks(self.known, self.marks)
        measured = self.most(marks, TELL, SENT) + (LENGTH + 1) * self.most(marks, SENT, END)
        print(f"\n  {NAME}: {measured} instructions, said {said}")
        self.assertGreaterEqual(said, measured)
        self.assertLessEqual(said, 1.25 * measured + 60)


if __name__ == "__main__":
    unittest.main()

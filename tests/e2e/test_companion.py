"""rsc companion: a word in a recording, and a face in a picture, reach a program on the shipped firmware."""

import json
import os
import sys
import time
import unittest

import rsc
from board import REAL_TIME, ROOT, Board
from support import LineReader, RobotTest

sys.path.append(str(ROOT / "tests/companion"))
from recordings import RATE, TEST_DATA, as_wav, needs, samples_of, speak  # noqa: E402
from test_face_detect import PICTURES  # noqa: E402

ROBOT = {
    "actuators": [{"name": "arm", "type": "VIRTUAL", "device": "joint", "range": ["0deg", "90deg"]},
                  {"name": "speaker", "type": "VIRTUAL", "device": "speaker"}],
    "sensors": [{"name": "green_button", "type": "VIRTUAL", "channels": {"POSITION": {"labels": ["released", "pressed"]}}}],
    "groups": {"arms": ["arm"]},
}
LISTENS = """
WHEN voice WORD BECOMES forward
DO MOVE arm TO 90deg
END
WHEN voice WORD BECOMES meters
DO SAY "Ten meters"
END
"""
LOOKS = """
WHEN face COUNT > 0
DO SAY "Hello"
END
WHEN face ANGLE < 0deg
DO LOG "to the left"
END
"""
STOPS = """
BEHAVIOR lift PRIORITY 10
  WHEN green_button IS pressed
  DO MOVE arm TO 90deg
  END
END
SAFETY stops
  WHEN voice WORD IS "stop"
  DO STOP ALL
  RESUME WHEN voice WORD IS silence
END
"""
# In the place of arecord: a microphone that hears a file, and says when it began to.
MICROPHONE = """#!/usr/bin/python3
import os, sys, time
samples = open(os.environ["HEARD"], "rb").read()
began = time.monotonic()
open(os.environ["HEARD"] + ".began", "w").write(str(began))
for at in range(0, len(samples), 640):
    time.sleep(max(0, began + (at + 640) / 32000 - time.monotonic()))
    sys.stdout.buffer.write(samples[at:at + 640])
    sys.stdout.buffer.flush()
time.sleep(60)
"""
VOICES = ("en-us", "en-gb", "en-us+f2", "en-us+m3", "en-gb+f4", "en-us+f5", "en-us+m7", "en-gb+m2")
BETWEEN = 2.0  # seconds
LATE = 1.0  # … is too late to stop


class Companion(RobotTest):
    def setUp(self):
        super().setUp()
        self.board.stop()
        self.board = Board(self.elf, icount=REAL_TIME, extra=self.qemu_arguments())
        self.addCleanup(self.board.stop)

    def given(self, program, algorithm):
        (self.folder / "program.rsl").write_text(program)
        (self.folder / "wanted.json").write_text(json.dumps({**ROBOT, "algorithms": [algorithm]}))
        self.upload(self.compile(self.folder / "program.rsl", self.folder / "wanted.json"))

    def run_beside(self, *arguments):
        done = rsc.call("companion", "--config", self.folder / "robot.json", "--port", self.board.port,
                        "--monitor", "--format", "json", *arguments)
        self.assertEqual(done.returncode, 0, done.stderr)
        return [json.loads(line) for line in done.stdout.splitlines()]

    @needs("command_words")
    def test_a_word_of_a_person_moves_the_arm(self):
        self.given(LISTENS, {"name": "voice", "module": "command_words", "input": "microphone", "on": "companion"})
        sound = as_wav(TEST_DATA / "goforward.raw", self.folder / "go.wav", silence=1.0)  # "go forward ten meters"
        events = self.run_beside("--microphone", sound)
        said = [event["value"] for event in events
                if event["event"] == "input" and event["sensor"] == "voice"]
        self.assertEqual(said, ["silence", "forward", "silence", "meters", "silence"])
        did = [(event["actuator"], event["verb"]) for event in events if event["event"] == "command"]
        self.assertEqual(did, [("arm", "MOVE"), ("speaker", "SAY")])
        self.assertNotIn("stale", [event["event"] for event in events])

    def microphone(self, samples):
        """Puts one on the PATH that hears them; when it began stands in the file that it gives."""
        (self.folder / "heard").write_bytes(samples)
        (self.folder / "arecord").write_text(MICROPHONE)
        (self.folder / "arecord").chmod(0o755)
        before = dict(os.environ)
        self.addCleanup(os.environ.update, before)
        os.environ.update(PATH=f"{self.folder}:{before['PATH']}", HEARD=str(self.folder / "heard"))
        return self.folder / "heard.began"

    @needs("command_words")
    def test_the_outputs_are_safe_soon_after_somebody_has_said_stop(self):
        self.given(STOPS, {"name": "voice", "module": "command_words", "on": "companion"})
        heard, ends = bytes(int(BETWEEN * RATE) * 2), []
        for voice in VOICES:
            samples = samples_of(speak("stop", self.folder / "stop.wav", voice))
            loud = [i for i, sample in enumerate(memoryview(samples).cast("h")) if abs(sample) > 300]
            ends.append(len(heard) / 2 / RATE + loud[-1] / RATE)
            heard += samples + bytes(int(BETWEEN * RATE) * 2)
        began = self.microphone(heard)
        reader = LineReader("companion", "--config", self.folder / "robot.json", "--port", self.board.port,
                            "--monitor", "--format", "json", "--microphone", "default")
        self.addCleanup(reader.stop)
        halts = []
        until = time.monotonic() + len(heard) / 2 / RATE + 10
        while time.monotonic() < until and len(halts) < len(VOICES):
            count = len(halts) + 1
            if reader.wait_for(lambda lines: sum('"event":"halt","actuator":"arm"' in line for line in lines) >= count, 1):
                halts.append(time.monotonic() - float(began.read_text()))
        late = [min((halt - end for halt in halts if halt > end - 0.3), default=99) for end in ends]
        stopped = sorted(after for after in late if after < BETWEEN)
        print(f"stopped {len(stopped)} of {len(VOICES)} times, after "
              + ", ".join(f"{1000 * after:.0f}" for after in stopped) + " ms", file=sys.stderr)
        self.assertGreaterEqual(len(stopped), len(VOICES) - 2)
        self.assertLess(stopped[-1], LATE)

    @needs("face_detect")
    def test_a_face_is_greeted(self):
        if not PICTURES.is_dir():
            self.skipTest("there are no pictures: scripts/companion --test gets them")
        self.given(LOOKS, {"name": "face", "module": "face_detect", "on": "companion"})
        events = self.run_beside("--camera", PICTURES / "astronaut.png", "--duration", "4s")
        self.assertIn(("speaker", "SAY"), [(event["actuator"], event["verb"]) for event in events
                                           if event["event"] == "command"])
        self.assertIn("to the left", json.dumps(events))


if __name__ == "__main__":
    unittest.main()

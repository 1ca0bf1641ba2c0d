"""What the tests of a computer beside the robot share: the programs of its modules, what they say, and what they are given."""

import array
import subprocess
import unittest
import wave
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PROGRAMS = ROOT / "build/companion/bin"
RATE = 16_000
TEST_DATA = Path("/usr/share/pocketsphinx/test/data")  # of pocketsphinx-testdata: people who speak
TIMEOUT = 60


def program_of(module):
    return PROGRAMS / f"robosync-{module.replace('_', '-')}"


def needs(module):
    return unittest.skipUnless(program_of(module).is_file(), f"{module} is not built: scripts/companion")


def run(module, source, *arguments):
    """The finished program: its lines as (output, value), what it said on stderr, and its exit code."""
    done = subprocess.run([program_of(module), "--source", source, "--no-pace", *map(str, arguments)], check=False,
                          text=True, timeout=TIMEOUT, stdin=subprocess.DEVNULL,
                          stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    return [tuple(line.split(" ")) for line in done.stdout.splitlines()], done.stderr, done.returncode


def speak(text, path, voice="en-us", speed=175, pitch=50):
    """A synthetic voice, which says `text` into a WAV file."""
    subprocess.run(["espeak-ng", "-v", voice, "-s", str(speed), "-p", str(pitch), "-w", path, text], check=True,
                   stdin=subprocess.DEVNULL)
    return path


def samples_of(path):
    """Those of a WAV file of one channel, as bare samples at RATE, each the nearest in time."""
    with wave.open(str(path)) as file:
        rate, frames = file.getframerate(), memoryview(file.readframes(file.getnframes())).cast("h")
    count = len(frames) * RATE // rate
    return array.array("h", (frames[i * rate // RATE] for i in range(count))).tobytes()


def as_wav(raw, path, silence=0.0):
    """A file of bare samples as WAV, after so many seconds of silence."""
    with wave.open(str(path), "wb") as out:
        out.setnchannels(1)
        out.setsampwidth(2)
        out.setframerate(RATE)
        out.writeframes(bytes(int(silence * RATE) * 2) + Path(raw).read_bytes())
    return path

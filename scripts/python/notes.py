"""Measures how often `pitch` is right about notes (scripts/rates), as a table.

The notes come from the instruments of a sound font (recordings of instruments and singers, played by fluidsynth), or are
computed tones. Each lasts a second, at the loudness of sounds.py. A robot hears them in `rsc run`. Its PITCH is sampled every
20 ms, from 160 ms after a note's beginning until its end."""

import math
import subprocess
import tempfile
from array import array
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import NamedTuple

import rates
import sounds
from rates import DATA, RATE, RAW
from sounds import BYTES, NOISES_DB

PACKAGE = "timgm6mb-soundfont"
FONT = DATA / PACKAGE / "usr/share/sounds/sf2/TimGM6mb.sf2"
NOTE_S, PAUSE_S, SAMPLE_MS, FIRST_MS, LAST_MS = 1.0, 1.0, 20, 160, 980
RIGHT_CENTS, A4, A4_HZ = 50, 69, 440
ROBOT = {
    "sensors": [{"name": "microphone", "type": "VIRTUAL", "device": "microphone"}],
    "actuators": [{"name": "voice", "type": "VIRTUAL", "device": "speaker"}],
    "algorithms": [{"name": "song", "module": "pitch", "input": "microphone"}],
}
PROGRAM = """WHEN song PITCH > 0Hz AND song NOTE IS none  # so that both are read
DO SAY "hm"
END
"""


class Part(NamedTuple):
    name: str
    programs: list  # General MIDI: (number, lowest note, highest note) within the instrument's range and that of `pitch`


class Tones(NamedTuple):
    name: str
    heights: list  # amplitudes of its harmonics
    lowest: int
    highest: int  # notes
    vibrato_cents: int = 0


PARTS = [
    Part("choir and voice", [(52, 43, 81), (53, 43, 81)]),
    Part("ocarina, recorder, flute", [(79, 69, 91), (74, 72, 95), (73, 60, 95)]),
    Part("violin, cello, oboe, clarinet, saxophone", [(40, 55, 95), (42, 40, 76), (68, 58, 91), (71, 50, 91), (65, 49, 80)]),
    Part("trumpet, trombone, horn", [(56, 52, 84), (57, 40, 72), (60, 41, 77)]),
    Part("piano, guitar, harp, vibraphone", [(0, 40, 95), (24, 40, 83), (46, 40, 95), (11, 53, 89)]),
    Part("organ, accordion: several reeds or pipes for a note", [(19, 40, 95), (21, 53, 89)]),
    Tones("whistles: pure tones, 1 to 2 kHz", [1], 84, 94),
    Tones("pure tones, 82 Hz to 1 kHz", [1], 40, 83),
    Tones("tones whose lowest multiple is missing", [0, 1, 0.7, 0.5, 0.35, 0.25], 40, 71),
    Tones("a voice with a vibrato of 40 cents, 6 times a second", [1, 0.6, 0.4, 0.5, 0.3, 0.2], 43, 77, 40),
]


class Note(NamedTuple):
    program: int
    key: int

    def hertz(self):
        return A4_HZ * 2 ** ((self.key - A4) / 12)


def notes(part, which):
    """Every second note of each instrument."""
    return [Note(program, key) for program, low, high in part.programs for key in range(low + which, high + 1, 2)]


def computed(tones, which):
    for key in range(tones.lowest + which, tones.highest + 1, 2):
        note, phase, values = Note(-1, key), 0.0, []
        for i in range(int(NOTE_S * RATE)):
            cents = tones.vibrato_cents * math.sin(2 * math.pi * 6 * i / RATE)
            phase += 2 * math.pi * note.hertz() * 2 ** (cents / 1200) / RATE
            values.append(sum(height * math.sin(n * phase + n * n) for n, height in enumerate(tones.heights, 1)
                              if n * note.hertz() < RATE * 0.45))
        most = max(map(abs, values))
        yield note, sounds.as_loud(array("h", [round(20000 * value / most) for value in values]).tobytes(), RATE)


def track(all_notes):
    """A MIDI file: one note after the other, a thousand ticks a second."""
    pause, sounding = int(PAUSE_S * 1000), int(NOTE_S * 1000)
    events = bytearray()
    for note in all_notes:
        events += b"\x00" + bytes([0xC0, note.program])
        events += length(pause) + bytes([0x90, note.key, 100]) + length(sounding) + bytes([0x80, note.key, 0])
        events += b"\x00" + bytes([0xB0, 120, 0])  # all sound off: the note's decay is not heard
    events += length(2 * pause) + b"\xff\x2f\x00"
    tempo = b"\x00\xff\x51\x03" + (1_000_000).to_bytes(3, "big")
    body = tempo + bytes(events)
    head = b"MThd" + (6).to_bytes(4, "big") + (0).to_bytes(2, "big") + (1).to_bytes(2, "big") + (1000).to_bytes(2, "big")
    return head + b"MTrk" + len(body).to_bytes(4, "big") + body


def length(ticks):
    return bytes([ticks >> 7 | 0x80, ticks & 0x7F])


def played(all_notes):
    """[(note, its sound at 8,000 samples a second)]; silence precedes each in the file that is played."""
    with tempfile.TemporaryDirectory() as name:
        midi, sound = Path(name) / "notes.mid", Path(name) / "notes.wav"
        midi.write_bytes(track(all_notes))
        subprocess.run(["fluidsynth", "-ni", "-q", "-R", "0", "-C", "0", "-g", "0.5", "-r", "32000", "-F", sound, FONT, midi],
                       capture_output=True, check=True)
        raw = subprocess.run(["sox", "-R", sound, *RAW], capture_output=True, check=True).stdout
    for i, note in enumerate(all_notes):
        at = int((i * (PAUSE_S + NOTE_S) + PAUSE_S) * RATE) * BYTES
        yield note, sounds.as_loud(raw[at:at + int(NOTE_S * RATE) * BYTES], RATE)


def lay_out(recordings):
    """(all of them in a row, [(note, beginning in ms)])."""
    pause = bytes(int(PAUSE_S * RATE) * BYTES)
    sound, places = bytearray(pause), []
    for note, recording in recordings:
        places.append((note, rates.milliseconds(sound)))
        sound += recording + pause
    return bytes(sound), places


def heard(sound):
    """[the robot's PITCH in Hz, or None] for each millisecond."""
    changes = {}
    for event in rates.run(ROBOT, PROGRAM, sound, "--all"):
        if event.get("sensor") == "song":
            changes.setdefault(event["t_us"] // 1000, {})[event["channel"]] = event.get("value")
    pitch, note, found = None, "none", []
    for at in range(rates.milliseconds(sound)):
        pitch = changes.get(at, {}).get("PITCH", pitch)
        note = changes.get(at, {}).get("NOTE", note)
        found.append(None if note == "none" else pitch)
    return found


def judged(pitch, note):
    if pitch is None:
        return "none"
    cents = 1200 * math.log2(pitch / note.hertz())
    if abs(cents) <= RIGHT_CENTS:
        return "right"
    return "octave" if abs(abs(cents) - 1200) <= RIGHT_CENTS else "other"


def row(part, which):
    recordings = list(played(notes(part, which)) if isinstance(part, Part) else computed(part, which))
    sound, places = lay_out(recordings)
    hiss, cells = sounds.noise(len(sound), RATE), []
    for below in NOISES_DB:
        pitches = heard(sounds.mixed(sound, hiss, below))
        found = [judged(pitches[begin + at], note) for note, begin in places for at in range(FIRST_MS, LAST_MS, SAMPLE_MS)]
        shares = [100 * found.count(kind) / len(found) for kind in ("right", "octave", "other", "none")]
        cells.append(" · ".join(f"{share:.1f}" for share in shares))
    source = PACKAGE if isinstance(part, Part) else "computed"
    return f"| {len(places)} × {part.name} ({source}) | " + " | ".join(cells) + " |"


def table(which):
    with ThreadPoolExecutor(2) as pool:
        return "\n".join([*sounds.head("notes"), *pool.map(lambda part: row(part, which), PARTS)])


if __name__ == "__main__":
    rates.show(table(rates.half()), "<!-- scripts/rates: notes -->")

"""What robots are fed: readings at program times, some drawn with fixed seeds."""

import itertools
import math
import random
import zlib
from typing import NamedTuple

# Channels that programs read, with the values worth drawing: edges of ranges and of the rules.
CHANNELS = {
    "touch.LEVEL": [0, 1, 2, 2.999, 3, 3.001, 4, 7, 10],
    "proximity.DISTANCE": [2, 29.9, 30, 30.1, 45, 99.9, 100, 400],
    "room.WARMTH": [-20, 19.9, 20, 25, 25.2, 25.6, 80],
    "room.NOISE": [0, 39.9, 40, 40.1, 50, 51, 100],
}
UNITS = {"touch.LEVEL": "", "proximity.DISTANCE": "cm", "room.WARMTH": "C", "room.NOISE": "%"}
# What WideGenerator's robot has besides: a channel that goes stale.
WIDE_CHANNELS = CHANNELS | {"wind.SPEED": [0, 4.999, 5, 5.001, 20]}
WIDE_UNITS = UNITS | {"wind.SPEED": ""}
GAPS_MS = [0, 0, 1, 2, 17, 50, 300, 900]
WIDE_GAPS_MS = [0, 0, 1, 2, 17, 50, 100, 300, 900]


class Reading(NamedTuple):
    at_ms: int  # program time, from the first reading on
    channel: str
    value: float


def touch(*values, every_ms=400):
    return [Reading(i * every_ms, "touch.LEVEL", value) for i, value in enumerate(values)]


PRIORITIES = [
    Reading(0, "touch.LEVEL", 0), Reading(0, "proximity.DISTANCE", 200), Reading(1, "room.NOISE", 60),
    Reading(100, "touch.LEVEL", 5),         # wave
    Reading(900, "proximity.DISTANCE", 20),  # protect interrupts it
    Reading(1000, "touch.LEVEL", 0), Reading(1001, "touch.LEVEL", 9),  # wave may not start
    Reading(1500, "proximity.DISTANCE", 90), Reading(2600, "touch.LEVEL", 0),
    Reading(2700, "touch.LEVEL", 4), Reading(2700, "room.NOISE", 10), Reading(2800, "room.NOISE", 90),
]


def drawn(seed, program, count=40, channels=CHANNELS, gaps=GAPS_MS):
    """`count` readings of what `program` reads; some at one time, some a tick apart, some far apart."""
    random_ = random.Random(seed)
    # The image has no channel that the program does not read.
    names = [c for c in channels if c.replace(".", " ") in program]
    at, readings = 0, []
    for _ in range(count):
        channel = random_.choice(names)
        readings.append(Reading(at, channel, random_.choice(channels[channel])))
        at += random_.choice(gaps)
    return readings


def drawn_wide(seed, program, count=40):
    """The same for what WideGenerator draws."""
    return drawn(f"readings {seed}", program, count, WIDE_CHANNELS, WIDE_GAPS_MS)


FEELING_UNITS = {"pad.FORCE": "N"}  # of tests/e2e/programs/feeling.json
MOVING_UNITS = {"imu.X": "g", "imu.Y": "g", "imu.Z": "g"}  # of tests/e2e/programs/moving.json

HEARING_UNITS = {"microphone.LOUDNESS": "dB", "microphone.HIGHS": "dB", "microphone.PITCH": "Hz",
                 "microphone.CLARITY": "%"}  # of tests/e2e/programs/hearing.json and singing.json


def touches(seed, rounds=2, channel="pad.FORCE"):
    """A hand on a touch sensor: taps, pats, strokes and presses, each of them trembling, with pauses."""
    random_ = random.Random(f"touches {seed}")
    kinds = [(2, 120), (8, 160), (3, 900), (7, 450), (1.6, 290)]
    at, readings = 40, [Reading(0, channel, 0)]
    for level, lasts in random_.sample(rounds * kinds, rounds * len(kinds)):
        until = at + lasts
        while at < until:
            readings.append(Reading(at, channel, round(level * random_.uniform(0.75, 1.2), 3)))
            at += random_.choice([30, 70, 110])
        at = until
        readings.append(Reading(at, channel, 0))
        at += random_.choice([60, 200, 700])
    return readings


# What is done to a body: how long it reads which acceleration, in g.
REST = (600, (0, 0, 1))
MOTIONS = [
    [REST, *3 * [(170, (0, 1.6, 1)), (170, (0, -1.6, 1))]],  # shaken
    [REST, (30, (1, 0, 3))],  # tapped
    [REST, (260, (0.05, 0, 0.1)), (30, (2, 0, 7))],  # dropped
    [REST, (160, (0, 0, 1.4)), (160, (0, 0, 0.6))],  # lifted
    [REST, (1400, (0, -0.9, 0.4))],  # leant to the left
]


def motions(seed, rounds=2):
    """A body in all these ways, each time a little stronger or weaker. As many readings as the board can keep."""
    random_ = random.Random(f"motions {seed}")
    at, readings, last = 0, [], {}
    for lasts, acceleration in itertools.chain(*random_.sample(rounds * MOTIONS, rounds * len(MOTIONS)), [REST]):
        strength = random_.uniform(0.95, 1.1)
        for axis, value in zip("XYZ", acceleration):
            new = round(value * strength, 3) if (lasts, acceleration) != REST else value
            if last.get(axis) != new:
                readings.append(Reading(at, f"imu.{axis}", new))
            last[axis] = new
        at += lasts
    return readings


# What is heard: (for how long, (loudness, high tones, pitch, clarity)).
QUIET = (500, (32, 29, 0, 0))
SOUNDS = [
    [QUIET, (40, (78, 80, 0, 20)), (60, (62, 64, 0, 10))],  # a clap
    [QUIET, *3 * [(160, (58, 44, 140, 84)), (60, (44, 47, 0, 5))]],  # speech
    [QUIET, (300, (55, 57, 0, 20))],  # a hiss
    [QUIET, (40, (80, 62, 0, 30)), (80, (50, 40, 0, 0))],  # a thud
]


def sounds(seed):
    """A room with all these sounds, each time a little louder or softer."""
    return heard(random.Random(f"sounds {seed}"), SOUNDS)


# What is sung, likewise.
NOTES = [
    [QUIET, (600, (62, 50, 440.2, 95))],
    [QUIET, (200, (60, 47, 261.6, 92)), (40, (60, 48, 130.8, 90)), (300, (61, 47, 263.1, 93))],  # an octave misheard
    [QUIET, *((100, (64, 62, 800 * 2 ** (i / 8), 96)) for i in range(8)), (400, (64, 62, 1600, 96))],  # a whistle that rises
    [QUIET, *((100, (60, 45, 200 - 16 * i, 90)) for i in range(6)), (200, (58, 43, 100, 90))],
    [QUIET, (200, (60, 47, 330, 95)), (200, (60, 47, 392, 95)), (200, (60, 47, 523.3, 95))],  # a melody
    [QUIET, (300, (60, 45, 103.8, 93))],  # the note that takes longest to find
    [QUIET, (300, (60, 55, 350, 45)), (300, (35, 25, 350, 95))],  # hoarse, then too soft
]


def songs(seed):
    """All these tones, each time a little louder or softer."""
    return heard(random.Random(f"songs {seed}"), NOTES)


def heard(random_, sounds_):
    at, readings, last = 0, [], {}
    for lasts, levels in itertools.chain(*random_.sample(sounds_, len(sounds_)), [QUIET]):
        louder = random_.choice([-1, 0, 1, 2])
        for channel, value in zip(HEARING_UNITS, levels):
            new = value + louder if channel.endswith(("LOUDNESS", "HIGHS")) else round(value, 1)
            if last.get(channel) != new:
                readings.append(Reading(at, channel, new))
            last[channel] = new
        at += lasts
    return readings


# What is said, as own_words hears it: levels of 20 bands in steps of 1.5 dB (runtime-m4/drivers/spectrum.hpp). A word is where two
# loud bands go, from its beginning to its end.
LISTENING_UNITS = {f"microphone.BANDS_{i}": "" for i in range(1, 5)}  # of tests/e2e/programs/listening.json
BANDS, IN_VALUE, MOST_LEVEL, LOUD, ROOM, FRAME_MS = 20, 5, 63, 45, 6, 20
SPOKEN = {"hello": ((2, 4, 6, 5), (11, 12, 16, 10)), "dance": ((7, 6, 3, 3), (18, 17, 12, 9)),
          "abracadabra": ((3, 6, 3, 7), (9, 15, 16, 8)), "sleep": ((5, 3, 2, 6), (14, 14, 18, 12))}
UNTAUGHT = ((3, 3, 9, 4), (15, 9, 14, 18))
SAMPLES, LONG_SAMPLES = (28, 33, 39), (80, 86, 92)  # frames


def along(way, part):
    i = min(int(part * 3), 2)
    return way[i] + (way[i + 1] - way[i]) * (part * 3 - i)


def together(a, b):
    return 2 * math.log2(2 ** (a / 2) + 2 ** (b / 2))


def levels(word, part, loud, noise):
    tones = (loud - min(2 * (band - along(word[0], part)) ** 2, 2 * (band - along(word[1], part)) ** 2 + 6) for band in range(BANDS))
    return [min(MOST_LEVEL, max(0, round(together(tone, noise)))) for tone in tones]


def said(word, frames, loud=LOUD, noise=ROOM, hold=1):
    """`hold`: so many frames in a row are the same, for a line that takes no more."""
    return [levels(word, i // hold * hold / (frames - 1), loud, noise) for i in range(frames)]


def samples_of(name):
    return LONG_SAMPLES if name == "abracadabra" else SAMPLES


def words_file():
    """tests/e2e/programs/listening.words: as `rsc teach` would write it (docs/algorithms.md#the-file-of-words)."""
    lines = ["robosync words 2"]
    for name, word in SPOKEN.items():
        lines.append(f"word {name} 400")
        for frames in samples_of(name):
            sample = said(word, frames, noise=0)
            loudest = max(map(max, sample))
            lines += [f"sample {frames}", *("".join(chr(ord("0") + loudest - level) for level in frame) for frame in sample)]
    text = "".join(f"{line}\n" for line in lines)
    return f"{text}sum {zlib.crc32(text.encode()):08x}\n"


def words(seed):
    """All these words, and one that was not taught, each a little faster or slower, louder or softer."""
    random_ = random.Random(f"words {seed}")
    quiet = levels(UNTAUGHT, 0, 0, ROOM)
    frames = 60 * [quiet]
    for name in random_.sample([*SPOKEN, None], len(SPOKEN) + 1):
        count = random_.choice(samples_of(name)[:2])
        frames += said(SPOKEN.get(name, UNTAUGHT), count, random_.choice((38, 42, 46)), hold=5) + 150 * [quiet]
    readings, last = [], {}
    for i, frame in enumerate(frames):
        for value, channel in enumerate(LISTENING_UNITS):
            new = sum(level << 6 * band for band, level in enumerate(frame[value * IN_VALUE:(value + 1) * IN_VALUE])) / 1000
            if last.get(channel) != new:
                readings.append(Reading(i * FRAME_MS, channel, new))
            last[channel] = new
    return readings

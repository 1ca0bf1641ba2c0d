"""Measures how often `objects` is right (scripts/rates), as a table: on pictures that tests/companion/draw.cpp draws. Its
settings were chosen on pictures with other seeds (--settings)."""

import os
import random
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from typing import NamedTuple

import rates

PROGRAM = rates.ROOT / "build/companion/bin/robosync-objects"
DRAW = rates.ROOT / "build/companion/companion/robosync-draw"
PAGE = rates.ROOT / "docs/companion.md"
COLUMNS, ROWS, PICTURES = 640, 480, 50
BOXES = "boxes:12"
NOISES = (2, 15, 30, 50)  # of 255
USUAL = "--period 1 --view 60 --smallest 5 --vivid 50 --hue_from 0 --hue_to 360 --no-pace".split()
HUES = {"orange": (18, 42), "yellow": (48, 67), "green": (73, 162), "blue": (168, 257), "purple": (263, 342), "red": (348, 372)}


class Kind(NamedTuple):
    name: str
    output: str  # the output that reports it
    quiet: str  # the output's value when there is nothing
    draw: object  # function of a random generator: (what it is, how it is drawn)


def place(chance, size):
    return f"{chance.randint(size, COLUMNS - size)}:{chance.randint(size, ROWS - size)}:{size}"


def code(kind, most, size, tilt):
    def drawn(chance):
        number, side = chance.randrange(most), chance.randint(*size)
        return f"{number}.000", f"{kind}:{number}:{place(chance, side)}:{chance.randrange(360)}:{chance.randint(-tilt, tilt)}"
    return drawn


def ball(size, vivid):
    def drawn(chance):
        color = chance.choice(list(HUES))
        return color, f"ball:{chance.randint(*HUES[color]) % 360}:{place(chance, chance.randint(*size))}:{chance.randint(*vivid)}"
    return drawn


KINDS = [
    Kind("a marker, 60 to 160 pixels, turned anyhow", "MARKER", "-1.000", code("marker", 50, (60, 160), 0)),
    Kind("…, and tilted by up to 60 degrees", "MARKER", "-1.000", code("marker", 50, (60, 160), 60)),
    Kind("…, 25 to 40 pixels, tilted by up to 30 degrees", "MARKER", "-1.000", code("marker", 50, (25, 40), 30)),
    Kind("a QR code with a number, 100 to 200 pixels, turned anyhow, tilted by up to 30 degrees", "MARKER", "-1.000",
         code("qr", 1000, (100, 200), 30)),
    Kind("a ball, 40 to 160 pixels, 60 to 100 % vivid, of one of six colours", "COLOR", "none", ball((40, 160), (60, 100))),
    Kind("…, 50 to 60 % vivid", "COLOR", "none", ball((40, 160), (50, 60))),
]


def said(pictures, noise, first_seed):
    """The program's output for each of the pictures: {output: value}."""
    with tempfile.TemporaryDirectory() as folder:
        lines = (f"{folder}/p{i:03}.png {first_seed + i} {noise} {BOXES} {things}" for i, things in enumerate(pictures))
        subprocess.run([DRAW], input="\n".join(lines), check=True, text=True)
        # Numbered pictures are read like a camera's; at their end the camera gives no more, and the program fails.
        done = subprocess.run([PROGRAM, "--source", f"{folder}/p%03d.png", *USUAL], check=False, text=True, stdout=subprocess.PIPE,
                              stderr=subprocess.PIPE)
    answers = []
    for line in done.stdout.splitlines():
        output, value = line.split()
        if output == "COUNT":
            answers.append({})
        answers[-1][output] = value
    if len(answers) != len(pictures):
        raise ValueError(f"{len(answers)} answers to {len(pictures)} pictures: {done.stderr}")
    return answers


def row(kind, first_seed):
    drawn = [kind.draw(random.Random(first_seed + i)) for i in range(PICTURES)]
    cells = []
    for noise in NOISES:
        seen = [answer[kind.output] for answer in said([things for _, things in drawn], noise, first_seed)]
        right = sum(one == what for one, (what, _) in zip(seen, drawn))
        wrong = sum(one not in (what, kind.quiet) for one, (what, _) in zip(seen, drawn))
        cells.append(f"{right} of {PICTURES} · {wrong}")
    return f"| {kind.name} | " + " | ".join(cells) + " |"


def row_of_nothing(first_seed):
    cells = []
    for noise in NOISES:
        answers = said([""] * PICTURES, noise, first_seed)
        alarms = [sum(answer[output] != quiet for answer in answers) for output, quiet in (("MARKER", "-1.000"), ("COLOR", "none"))]
        cells.append(f"{alarms[0]} markers, {alarms[1]} colours")
    return f"| {PICTURES} pictures of neither: what is seen | " + " | ".join(cells) + " |"


def table(first_seed):
    head = ["| drawn | " + " | ".join(f"noise of {noise}" for noise in NOISES) + " |", "|---" + "|---" * len(NOISES) + "|"]
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        rows = list(pool.map(lambda kind: row(kind, first_seed), KINDS))
    return "\n".join([*head, *rows, row_of_nothing(first_seed)])


def main():
    rates.show(table(1 if "--settings" in sys.argv else 1001), "<!-- scripts/rates: objects -->", PAGE)


if __name__ == "__main__":
    main()

"""What the reference is compared on: the programs of tests/generators/programs/generator.py, with more of the language.

What is in a program is drawn with a seed; so are the readings. RANDOM stands in responses and periods
only: how often a condition is looked at is no matter of the language.
"""

import random
import sys
from pathlib import Path
from typing import NamedTuple

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "generators/programs"))

import generator  # noqa: E402
import stimuli  # noqa: E402

CONFIG = HERE / "robot.json"
CHANNELS = stimuli.CHANNELS | {"wind.SPEED": [0, 4.999, 5, 5.001, 20]}  # goes stale
UNITS = stimuli.UNITS | {"wind.SPEED": ""}
GAPS_MS = [0, 0, 1, 2, 17, 50, 100, 300, 900]

MORE_COMMANDS = ["MOVE left_arm TO (RANDOM(-20deg, 150deg)) OVER 40ms", "STOP ALL", "STOP arms",
                 "MOVE right_arm TO 30deg AT (last * 50deg/s)", "LIGHT lamp TO (wind SPEED * 1%)",
                 "LIGHT lamp OFF", 'SAY "well"', 'PLAY sound "greeting.wav" FOR 50ms']

MORE_SAFETY = """\
LIMIT left_arm SPEED TO 60deg/s

SAFETY gale
  WHEN wind SPEED > 5 FOR 20ms
  DO
    STOP arms
    SET mood TO wary
    SIGNAL knock
    LOG "gale", wind SPEED
  RESUME WHEN wind SPEED < 5
END

"""


class Reading(NamedTuple):
    at_ms: int
    channel: str
    value: float


class Generator(generator.Generator):
    """More statements, conditions and modifiers; rules outside of behaviours; a sensor that goes stale."""

    def __init__(self, seed):
        super().__init__(seed)
        self._behaviors = 0

    def program(self):
        text = super().program()
        if self._random.random() < 0.2:
            text = text.replace("BEHAVIOR", MORE_SAFETY + "BEHAVIOR", 1)
        return text + "".join(self._rule() for _ in range(self._random.randint(0, 2)))

    def _behavior(self, index, priority):
        self._own = f"own{index}"
        text = super()._behavior(index, priority)
        first, rest = text.split("\n", 1)
        del self._own
        return f"{first}\n  REMEMBER own{index} = 2\n{rest}"

    def _margin(self, condition):
        orders = any(f"LEVEL {relation} " in condition for relation in "<>")
        return " MARGIN 1" if orders and self._random.random() < 0.5 else ""

    def _when(self):
        text = super()._when()
        head, _, rest = text.partition("\n")
        return head + self._margin(head) + "\n" + rest

    def _while(self):
        text = super()._while()
        head, _, rest = text.partition("\n")
        return head + self._modifiers(["COOLDOWN"]) + self._margin(head) + "\n" + rest

    def _timed(self):
        condition = self._condition(1)
        more = [f"(({condition}) FOR {self._duration()}) AND ({self._condition(0)})",
                f"knock {self._random.randint(1, 3)} TIMES WITHIN 1s", "knock OR touch LEVEL > 3",
                f"knock THEN ({condition}) WITHIN 600ms", "touch LEVEL CHANGES", "last CHANGES BY 0.5",
                "wind SPEED > 4 FOR 150ms", "NOT (wind SPEED CHANGES)",
                "wind SPEED > 4 2 TIMES WITHIN 1.5s", "wind SPEED < 5 THEN wind SPEED > 5 WITHIN 600ms"]
        return self._one(super()._timed, super()._timed, lambda: self._random.choice(more))()

    def _comparison(self):
        if self._random.random() < 0.2:
            return f"wind SPEED {self._random.choice(generator.RELATIONS)} 5"
        return super()._comparison()

    def _variable(self):
        more = ["last / count > 0.7", "(touch LEVEL - 5) MOD 3 <> 1", "last * last > wind SPEED",
                "touch LEVEL IS BETWEEN 2 AND 4", "mood IS NOT wary AND joy < 99%"]
        return self._one(super()._variable, lambda: self._random.choice(more))()

    def _set(self):
        own = getattr(self, "_own", "count")
        more = [f"RAISE {own} BY 1", f"SET {own} TO {own} * 2 MOD 7", "SET last TO count / 3",
                "SET last TO (last * 1.5) MOD -7", "RAISE count BY touch LEVEL", "LOWER count BY 2",
                "SET last TO 0 - wind SPEED", f'LOG "own", {own}, "wind", wind SPEED',
                "SET count TO RANDOM(-3, 3)", "RAISE last BY 2147483", *MORE_COMMANDS]
        return self._one(super()._set, lambda: self._random.choice(more))()

    def _blocks(self, depth):
        return super()._blocks(depth) + [
            f"IF {self._condition(0)} FOR 40ms DO\n{self._block(depth)}    END",
            f"REPEAT count MOD 4 TIMES\n{self._block(depth)}    WAIT {self._pause()}\n    END",
            f"REPEAT (last) TIMES\n{self._block(depth)}    THEN\n    END",
            "WAIT count * 10ms", "WAIT RANDOM(0s, 0.1s)",
            f"WAIT UNTIL ({self._condition(0)} FOR 40ms) WITHIN 600ms",
            f"PICK ONE\n    OPTION\n{self._block(depth)}    OPTION\n{self._block(depth)}"
            f"    OPTION\n{self._block(depth)}    END"]


def program(seed):
    return Generator(seed).program()


def readings(seed, text, count=40):
    """`count` readings of what the program reads: the image has no other channels."""
    random_ = random.Random(f"readings {seed}")
    channels = [c for c in CHANNELS if c.replace(".", " ") in text]
    at, result = 0, []
    for _ in range(count):
        channel = random_.choice(channels)
        result.append(Reading(at, channel, random_.choice(CHANNELS[channel])))
        at += random_.choice(GAPS_MS)
    return result

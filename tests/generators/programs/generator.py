"""Programs that are right by construction, drawn with a seed: every construct of the language.

Generator draws for robots that have what tests/e2e/programs/robot.json has, WideGenerator for the robot.json
of this folder. What a program means is of no matter here: what one robot does is compared with what
another does.

    generator.py COUNT FILE    writes COUNT programs of WideGenerator, each ended by a line with a form feed
"""

import random
import sys
from pathlib import Path

from stimuli import CHANNELS, UNITS

TOO_LARGE = "E0407"  # what rsc calls a program that no robot has room for: some that are drawn are

RELATIONS = ["<", ">", "<=", ">=", "=", "<>"]
COMMANDS = ["MOVE arms SLOWLY", "MOVE left_arm TO 90deg OVER 300ms", "MOVE right_arm TO 20deg",
            "MOVE left_arm BY 15deg OVER 50ms", 'PLAY sound "greeting.wav"',
            'PLAY sound "warning.wav"', "LIGHT lamp ON", "LIGHT lamp TO 40% OVER 250ms",
            "BLINK lamp 3 TIMES", "STOP lamp", "MOVE arms QUICKLY",
            "PERFORM wave", "PERFORM wave AT 150% 2 TIMES", "PERFORM bow AT (joy)",
            "PERFORM bow (count MOD 3) TIMES",
            "LIGHT lamp TO (joy) OVER 100ms", "MOVE left_arm TO (count * 3deg) OVER 80ms"]
FOLLOWS = ["FOLLOW left_arm TO (touch LEVEL * 12deg)", "FOLLOW arms TO (count * 3deg) AT 50deg/s MARGIN 2deg",
           "FOLLOW lamp TO (joy)", "FOLLOW lamp TO (room NOISE) MARGIN 10%",
           "FOLLOW right_arm TO (touch LEVEL * 30deg - 20deg) MARGIN 15deg",
           "FOLLOW left_arm TO 35deg AT (last * 20deg/s)"]
# The same by way of a parameter, where no FOR stands behind it.
TRACKS = {"FOLLOW left_arm TO (touch LEVEL * 12deg)": "track WITH left_arm, touch LEVEL * 12deg",
          "FOLLOW lamp TO (joy)": "track WITH lamp, joy"}
DURATIONS = ["1ms", "7ms", "40msec", "150milliseconds", "600ms", "1.5seconds"]

DECLARATIONS = """\
LET calm = 40%
LIST songs: "greeting.wav", "warning.wav", "greeting.wav"
LIST words: "one", "two", "three", "four", "five"
LIST numbers: 3, -1, 0.5, 4, 2
LIST places: 10deg, 45deg, 90deg
REMEMBER count = 0
REMEMBER last = 1.5 KEPT
TIMER idle
TIMER busy
STATE mood: calm_down, very happy, wary
FEELING joy FROM 0% TO 100% START 50% FADES TO 30% OVER 2s
FEELING fear FROM -10% TO 100% START 0%

CHECK space OF proximity DISTANCE
  very close BELOW 30cm
  near BELOW 100cm
  far OTHERWISE
  MARGIN 5cm
END

CHECK noise OF room NOISE
  silent BELOW 20%
  normal BETWEEN 20% AND 60%
  loud OTHERWISE
  SMOOTH OVER 300ms
END

DEFINE point WITH arm, angle, item
  MOVE arm TO angle OVER 80ms
  PLAY sound item
END

DEFINE track WITH follower, goal
  FOLLOW follower TO goal
END

DEFINE twice WITH action, arm
  action WITH arm, 20deg, "warning.wav"
  THEN
  action WITH arm, 90deg, "greeting.wav"
END

MOTION wave OF left_arm, lamp
  AT 0s    10deg  0%
  AT 250ms 60deg  -
  AT 333ms -      80%
END

MOTION bow OF arms
  AT 300ms 45deg
  AT 500ms 0deg
END

DEFINE greet_twice WITH pause, level
  LIGHT lamp TO level OVER pause
  WAIT pause
  PLAY sound "greeting.wav"
END

"""

SAFETY = """\
SAFETY heat
  WHEN room WARMTH > 25C MARGIN 1C
  DO
    STOP left_arm
    ALERT "too warm"
  RESUME WHEN room WARMTH < 20C FOR 100ms
END

"""


# So that the signal exists in every program.
KNOCK = """\
WHEN touch LEVEL > 9 DO
  SIGNAL knock
END
"""


class Generator:
    """`program()` gives the text; the same seed, the same text."""

    def __init__(self, seed):
        self._random = random.Random(seed)

    def program(self):
        count = self._random.randint(2, 5)
        priorities = self._random.sample(range(1, 100), count)
        safety = SAFETY if self._random.random() < 0.3 else ""
        behaviors = "\n".join(self._behavior(i, p) for i, p in enumerate(priorities))
        return DECLARATIONS + safety + behaviors + KNOCK

    def _one(self, *choices):
        return self._random.choice(choices)

    def _duration(self):
        return self._random.choice(DURATIONS)

    def _pause(self):
        """Long enough that what repeats for ever does not fill the line with its trace."""
        return self._one("40ms", "150ms", "600ms")

    # --- rules

    def _behavior(self, index, priority):
        rules = "".join(self._rule() for _ in range(self._random.randint(1, 3)))
        return f"BEHAVIOR b{index} PRIORITY {priority}\n{rules}END\n"

    def _rule(self):
        head = self._one(self._when, self._when, self._when, self._while, self._every, self._start)()
        return f"  {head}  END\n"

    def _when(self):
        other = f"  ELSE\n{self._block(2)}" if self._random.random() < 0.4 else ""
        modifiers = self._modifiers(["COOLDOWN", "WAITING"])
        if self._random.random() < 0.2:
            modifiers += " RESTARTING"
        return f"WHEN {self._timed()}{modifiers}\n  DO\n{self._block(2)}{other}"

    def _while(self):
        end = f"    WAIT {self._pause()}\n" if self._random.random() < 0.7 else self._following()
        return f"WHILE {self._condition(1)}\n  DO\n{self._block(2)}{end}"

    def _following(self):
        """FOLLOWs that go on together until something else ends them."""
        lines = self._random.sample(FOLLOWS, self._random.randint(1, 2))
        return "".join(f"    {TRACKS.get(line, line)}\n" for line in lines)

    def _every(self):
        to = f" TO {self._one('700ms', '2s')}" if self._random.random() < 0.5 else ""
        return f"EVERY {self._one('90ms', '400ms')}{to}\n  DO\n{self._block(1)}"

    def _start(self):
        if self._random.random() < 0.3:
            return (f"AT START DO\n{self._block(1)}    REPEAT FOREVER\n{self._block(1)}"
                    f"    WAIT {self._pause()}\n    END\n")
        return f"AT START DO\n{self._block(2)}"

    def _modifiers(self, words):
        return "".join(f" {word} {self._duration()}" for word in words
                       if self._random.random() < 0.25)

    # --- conditions

    def _timed(self):
        condition = self._condition(1)
        return self._one(
            condition, condition,
            f"({condition}) FOR {self._duration()}",
            f"({condition}) {self._random.randint(1, 4)} TIMES WITHIN {self._duration()}",
            f"({condition}) THEN ({self._condition(1)}) WITHIN {self._duration()}",
            f"space BECOMES {self._one('very close', 'near', 'far')}",
            f"mood BECOMES {self._one('calm_down', 'very happy', 'wary')}",
            f"idle > {self._duration()}", f"busy >= {self._duration()} AND ({condition})",
            "idle IS BETWEEN 40ms AND last * 100ms", f"busy < count * 100ms OR ({condition})",
            "touch LEVEL CHANGES BY 2", "count CHANGES", "knock", "noise IS NOT normal")

    def _condition(self, depth):
        if depth == 0 or self._random.random() < 0.3:
            return self._one(self._comparison, self._comparison, self._label, self._variable)()
        if self._random.random() < 0.2:
            return f"NOT ({self._condition(depth - 1)})"
        return f"({self._condition(depth - 1)}) {self._one('AND', 'OR')} ({self._condition(depth - 1)})"

    def _comparison(self):
        channel = self._random.choice(list(CHANNELS))
        value = self._random.choice(CHANNELS[channel])
        left = channel.replace(".", " ")
        if channel == "touch.LEVEL" and self._random.random() < 0.5:
            left = f"({left} * {self._one(2, 0.5, 3)} - {self._one(1, 2.5)})"
        return f"{left} {self._random.choice(RELATIONS)} {value}{UNITS[channel]}"

    def _label(self):
        return self._one("space IS far", "space IS NOT very close", "mood IS wary",
                         "noise IS loud", "mood IS NOT calm_down")

    def _variable(self):
        return self._one("joy > calm", "fear >= 30%", "count MOD 3 = 0", "last IS NOT BETWEEN 2 AND 3",
                         "count + last > touch LEVEL",
                         f"{self._number(2)} {self._random.choice(RELATIONS)} {self._number(1)}")

    def _number(self, depth):
        """A plain number that is worked out, of every operator, by zero and out of range included."""
        if depth == 0 or self._random.random() < 0.2:
            return self._one("count", "last", "touch LEVEL", "0", "7", "-3", "2.5")
        if self._random.random() < 0.2:
            return self._one(f"ABS({self._number(depth - 1)})", f"ROUND({self._number(depth - 1)})",
                             f"{self._one('MIN', 'MAX')}({self._number(depth - 1)}, {self._number(0)})")
        operator = self._one("+", "-", "*", "/", "MOD", "+ -")
        return f"({self._number(depth - 1)} {operator} {self._number(depth - 1)})"

    # --- statements

    def _block(self, depth):
        lines = [self._statement(depth) for _ in range(self._random.randint(1, 3))]
        return "".join(f"    {line}\n" for line in lines)

    def _statement(self, depth):
        simple = [lambda: self._random.choice(COMMANDS), lambda: self._random.choice(COMMANDS), self._set]
        if depth == 0:
            return self._one(*simple)()
        return self._one(*simple, lambda: "THEN", lambda: f"WAIT {self._duration()}", *self._blocks(depth - 1),
                         lambda: f"WAIT UNTIL {self._condition(1)} WITHIN {self._duration()}",
                         lambda: f"{self._following()}    {self._one(*FOLLOWS)} FOR {self._duration()}",
                         lambda: f"{self._one(*FOLLOWS)} FOR {self._duration()}",
                         lambda: f"greet_twice WITH {self._duration()}, {self._one('10%', 'joy', 'calm')}",
                         lambda: f"point WITH {self._one('arms', 'left_arm')}, {self._one('30deg', 'count * 9deg')},"
                         " " + self._one('"greeting.wav"', '"warning.wav"'),
                         lambda: f"twice WITH point, {self._one('right_arm', 'arms')}")()

    def _blocks(self, depth):
        """Functions: the blocks that are not drawn would hold many others."""
        def block():
            return self._block(depth)
        return [
            lambda: f"IF {self._condition(1)} DO\n{block()}    ELSE\n{block()}    END",
            lambda: f"IF\n{self._condition(1)} DO\n{block()}    ELSE IF {self._condition(0)} DO\n"
            f"{block()}    ELSE\n{block()}    END",
            lambda: f"REPEAT {self._random.randint(1, 3)} TIMES\n{block()}    END",
            lambda: f"REPEAT count MOD 4 TIMES\n{block()}    WAIT {self._pause()}\n    END",
            lambda: f"REPEAT WHILE {self._condition(0)}\n{block()}    WAIT {self._pause()}\n    END",
            lambda: f"PICK ONE\n    OPTION 30%\n{block()}    OPTION 70%\n{block()}    END",
        ]

    def _set(self):
        return self._one("SET count TO count + 1", f"SET last TO {self._number(2)}",
                         f"SET count TO {self._number(3)}", "SET last TO RANDOM(0, 5)", "SIGNAL knock",
                         "RAISE joy BY 15%", "LOWER joy BY 40%", "RAISE fear BY 25%",
                         "SET fear TO 0%", "SET mood TO very happy", "SET mood TO wary",
                         "SET mood TO calm_down", "PLAY sound ANY songs", "LOG NEXT words, count", "ALERT ITEM count OF words",
                         "RESTART idle", "RESTART busy", 'LOG "idle", idle', "SET last TO idle / 1s",
                         "PLAY sound NEXT songs", "SET count TO COUNT OF words - 2", "SET last TO ITEM count OF numbers",
                         "MOVE left_arm TO (ITEM last OF places)", "LOG ITEM (count + 1) OF numbers", "LOG ANY words",
                         'LOG "count", count, mood, joy',
                         'ALERT "look here"', 'ALERT "joy", joy', "SET last TO touch LEVEL")


MORE_COMMANDS = ["MOVE left_arm TO (RANDOM(-20deg, 150deg)) OVER 40ms", "STOP ALL", "STOP arms",
                 "MOVE right_arm TO 30deg AT (last * 50deg/s)", "LIGHT lamp TO (wind SPEED * 1%)",
                 "LIGHT lamp OFF", 'SAY "well"', 'SAY "count", count, "wind", wind SPEED', "SAY NEXT words, last", "SAY idle",
                 'PLAY sound "greeting.wav" FOR 50ms']

MORE_SAFETY = """\
LIMIT left_arm SPEED TO 60deg/s

SAFETY gale
  WHEN wind SPEED > 5 FOR 20ms
  DO
    STOP arms
    SET mood TO wary
    SIGNAL knock
    LOG "gale", wind SPEED
    RESTART busy
  RESUME WHEN wind SPEED < 5
END

"""


class WideGenerator(Generator):
    """More statements, conditions and modifiers; rules outside of behaviours; a sensor that goes stale.

    RANDOM stands in responses and periods only: how often a condition is looked at is no matter of
    the language.
    """

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
            return f"wind SPEED {self._random.choice(RELATIONS)} 5"
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
        def block():
            return self._block(depth)
        return super()._blocks(depth) + [
            lambda: f"IF {self._condition(0)} FOR 40ms DO\n{block()}    END",
            lambda: f"REPEAT count MOD 4 TIMES\n{block()}    WAIT {self._pause()}\n    END",
            lambda: f"REPEAT (last) TIMES\n{block()}    THEN\n    END",
            lambda: "WAIT count * 10ms", lambda: "WAIT RANDOM(0s, 0.1s)",
            lambda: f"WAIT UNTIL ({self._condition(0)} FOR 40ms) WITHIN 600ms",
            lambda: f"PICK ONE\n    OPTION\n{block()}    OPTION\n{block()}    OPTION\n{block()}    END"]


def main():
    count, file = int(sys.argv[1]), Path(sys.argv[2])
    file.write_text("".join(WideGenerator(seed).program() + "\f\n" for seed in range(count)))


if __name__ == "__main__":
    main()

"""The programs that scripts/bench compiles: a large one such as people write, and ones that repeat one thing n times,
right or wrong, which must not take more than n times as long."""

import copy
import json
from dataclasses import dataclass, field
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]


@dataclass
class Source:
    """The input of `rsc check`: the program, robot.json as an object or a text, and the modules."""
    lines: list
    robot: object = None
    modules: dict = field(default_factory=dict)


def the_robot():
    """The robot.json of docs/language.md, which uses a bit of everything."""
    return json.loads((ROOT / "docs/robot.json").read_text())


def word(number):
    """A name of letters, different for each number; the names differ in the middle."""
    letters = ""
    for _ in range(4):
        number, last = divmod(number, 26)
        letters = "abcdefghijklmnopqrstuvwxyz"[last] + letters
    return f"nr_{letters}_of_many"


RULE = ["WHEN touch LEVEL > 4", "DO MOVE arms SLOWLY", "END"]


# ---- a large program

DECLARED = """\
REMEMBER visitors = 0
STATE mood: calm, happy, scared
FEELING joy FROM 0% TO 100% START 50%
  FADES TO 50% OVER 60s
CHECK space OF proximity DISTANCE
  near BELOW 80cm
  far OTHERWISE
  MARGIN 5cm
END
SAFETY pinched
  WHEN arms FORCE > 15N
  DO STOP arms
  RESUME WHEN arms FORCE < 5N FOR 2s
END
DEFINE wave_to_people
  MOVE right_arm TO 90deg QUICKLY
  MOVE right_arm TO 30deg QUICKLY
END
DEFINE nod WITH how_often, beat
  REPEAT how_often TIMES
    MOVE head TO -20deg OVER beat
    MOVE head TO 0deg OVER beat
    THEN
  END
END
AT START
DO SET mood TO calm
END
EVERY 1min
DO SET mood TO scared
END
""".splitlines()

# One of each kind of rule in docs/language.md; {a} to {c} get other numbers in each copy.
RULES = [part.splitlines() for part in """\
  # somebody comes near, {a}
  WHEN proximity DISTANCE < {a}cm FOR 1s
  MARGIN 3cm
  COOLDOWN 20s
  DO
    MOVE right_arm TO {b}deg QUICKLY
    SAY "Hello!"
    THEN
    SHOW face happy FOR 2s
  END

  WHEN touch LEVEL > {c} AND mood IS NOT scared
  DO
    MOVE arms SLOWLY
    PLAY sound "greeting.wav"
    RAISE joy BY {c}%
  END

  WHILE touch LEVEL > {c}
  DO
    MOVE arms TO {b}deg SLOWLY
    MOVE arms TO {a}deg SLOWLY
  END

  WHEN voice DIRECTION CHANGES BY {a}deg
  RESTARTING
  DO
    TURN head TO (voice DIRECTION / 2) OVER 500ms
    WAIT {c}s
    TURN head TO 0deg OVER 1s
  END

  WHEN touch LEVEL > {c}
  DO
    PICK ONE
      OPTION 60%
        SAY "That feels nice."
      OPTION 40%
        SHOW face smile
    END
  END

  WHEN touch LEVEL > {c}
  DO
    IF proximity DISTANCE < {a}cm
    DO SAY "Hello!"
    ELSE
      MOVE right_arm TO {b}deg QUICKLY
    END
  END

  # what everybody likes
  WHEN space BECOMES near
  DO
    wave_to_people
    nod WITH {c}, {a}ms
    SET mood TO happy
  END

  WHEN visitors > {a} AND joy < {b}%
  DO
    LOG "visitors", visitors
    SET visitors TO visitors - {c}
    SHOW face curious
  END
""".split("\n\n")]

TEST = """\

# what a touch does, {a}
TEST "number {n}: a touch is answered"
  AT 0s touch LEVEL = 0
  AT 1s touch LEVEL = {c}
  EXPECT MOVE arms SLOWLY WITHIN {b}ms
  EXPECT THAT mood IS calm WITHIN 1s
  AT 2s proximity DISTANCE = {a}cm
  EXPECT SAY "Hello!" WITHIN {b}ms
  WAIT 2s
  AT 4s touch LEVEL = 0
  EXPECT NOTHING FOR 5s
END""".splitlines()


def numbered(lines, number):
    """The lines, with other numbers in each copy."""
    return [line.format(a=20 + number * 7 % 60, b=10 + number * 11 % 90, c=1 + number % 8, n=number)
            for line in lines]


def large_rules(lines, behaviors=60):
    """A program of rules, spread evenly over its behaviours."""
    program, rule = list(DECLARED), 0
    room = (lines - len(program)) // behaviors
    for behavior in range(behaviors):
        end = len(program) + room
        program.append(f"BEHAVIOR b{behavior} PRIORITY {behavior + 1}")
        while len(program) < end - 10:
            program += numbered(RULES[rule % len(RULES)], rule) + [""]
            rule += 1
        program.append("END")
    return program


RULE_LINES = 2500  # rules of every kind; an image can hold a few more


def large_program(lines):
    """About as many rules as an image can hold, then TEST blocks up to that many lines. Its one error is
    that a board could not run all these rules in time."""
    program, test = large_rules(RULE_LINES), 0
    while len(program) < lines:
        program += numbered(TEST, test)
        test += 1
    return Source(program, the_robot())


# ---- one thing n times

def misspelt_names(n):
    return Source([f"REMEMBER {word(i)} = {i}" for i in range(n)]
                  + ["WHEN touch LEVEL > 4", "DO"] + [f"  LOG {word(i)}x" for i in range(n)] + ["END"])


def misspelt_defines(n):
    lines = sum((["DEFINE " + word(i), "  MOVE arms SLOWLY", "END"] for i in range(n)), [])
    return Source(lines + ["WHEN touch LEVEL > 4", "DO"] + [f"  {word(i)}x" for i in range(n)] + ["END"])


def unknown_verbs(n):
    return Source(["WHEN touch LEVEL > 4", "DO"] + [f"  {word(i)} arms" for i in range(n)] + ["END"])


def names_twice(n):
    return Source([f"LET {word(i // 2)} = 1" for i in range(n)] + RULE)


def syntax_errors(n):
    return Source(["WHEN touch LEVEL >", "DO MOVE arms TO TO", "END"] * n)


def lines_of_other_languages(n):
    """Habits that are mended in the tokens, before anything is parsed."""
    lines = sum(([f"REMEMBER my-{word(i)} = 0", "if (touch LEVEL > 3) { x = 5; }", "GIVEN touch LEVEL = 5",
                  "WHEN touch LEVEL > 4 DO", "  STOP arms WHEN touch LEVEL > 5", "END"] for i in range(n)), [])
    return Source(lines)


def open_blocks(n):
    return Source(["WHEN touch LEVEL > 4", "DO", "  IF touch LEVEL > 5", "  DO MOVE arms SLOWLY"] * n)


def deep_nesting(n):
    lines = ["WHEN touch LEVEL > 4", "DO"] + ["IF touch LEVEL > 5", "DO"] * n + ["MOVE arms SLOWLY"]
    return Source(lines + ["END"] * (n + 1) + ["WHEN touch LEVEL > " + "(" * n + "1" + ")" * n]
                  + RULE[1:])


def long_line(n):
    return Source(["WHEN touch LEVEL > 4", "DO LOG " + ", ".join(word(i) for i in range(n)), "END"])


def state_words(n):
    rules = sum(([f"WHEN mood IS {word(i)}", f"DO SET mood TO {word(n - 1 - i)}", "END"]
                 for i in range(n)), [])
    return Source(["STATE mood: " + ", ".join(map(word, range(n)))] + rules)


def misspelt_state_words(n):
    rules = sum(([f"WHEN mood IS {word(i)}x", "DO MOVE arms SLOWLY", "END"] for i in range(n)), [])
    return Source(["STATE mood: " + ", ".join(map(word, range(n)))] + rules)


def check_bands(n):
    bands = [f"  {word(i)} BETWEEN {i * 37 % 397}cm AND {i * 37 % 397 + 1}cm" for i in range(n)]
    rules = sum(([f"WHEN space IS {word(i)}", "DO MOVE arms SLOWLY", "END"] for i in range(n)), [])
    return Source(["CHECK space OF proximity DISTANCE", *bands, "END", *rules])


def variables(n):
    rules = sum(([f"WHEN {word(i)} > 4", f"DO SET {word(i)} TO {word(n - 1 - i)}", "END"]
                 for i in range(n)), [])
    return Source([f"REMEMBER {word(i)} = {i}" for i in range(n)] + rules)


def defines(n):
    lines = sum((["DEFINE " + word(i), f"  MOVE arms TO {i % 90}deg", "END"] for i in range(n)), [])
    return Source(lines + sum((["WHEN touch LEVEL > 4", f"DO {word(i)}", "END"] for i in range(n)), []))


def behaviors(n):
    return Source(sum(([f"BEHAVIOR {word(i)} PRIORITY {1 + i % 99}", f"WHEN touch LEVEL > {i % 9}",
                        *RULE[1:], "END"] for i in range(n)), []))


def rules(n):
    return Source(large_rules(10 * n), the_robot())


def different_rules(n):
    return Source(["BEHAVIOR b PRIORITY 5"] + sum((
        [f"WHEN proximity DISTANCE > {20 + i % 370}.{i % 1000:03}cm FOR {i + 1}ms",
         f"COOLDOWN {i + 1}s", f"DO MOVE arms TO {i % 90}.{i * 7 % 1000:03}deg", "END"]
        for i in range(n)), []) + ["END"])


def commands(n):
    return Source(["WHEN touch LEVEL > 4", "DO"] + [f"  MOVE arms TO {i % 90}deg" for i in range(n)]
                  + ["END"])


def tests(n):
    return Source(RULE + ["STATE mood: calm, happy"] + sum((numbered(TEST, i) for i in range(n)), []))


def long_chain_of_modules(n):
    """Each module USEs the next. 64 is the limit, and the last of these modules are large."""
    modules = {f"m{i}.rsl": f'USE "m{i + 1}.rsl"\nLET x{i} = 1\n' for i in range(n)}
    return Source(['USE "m0.rsl"'] + RULE, the_robot(), modules)


def modules(n):
    """As many modules as allowed, growing with n."""
    texts = {f"m{i}.rsl": "".join(f"DEFINE d_{i}_{k}\n  MOVE arms SLOWLY\nEND\n"
                                  for k in range(n // 50)) for i in range(50)}
    return Source([f'USE "{name}"' for name in texts] + RULE, the_robot(), texts)


def too_many_modules(n):
    return Source([f'USE "m{i}.rsl"' for i in range(n)] + RULE, the_robot(),
                  {f"m{i}.rsl": f"LET x{i} = 1\n" for i in range(n)})


def missing_modules(n):
    return Source([f'USE "{word(i)}.rsl"' for i in range(n)] + RULE)


def with_robot(change):
    """Returns the program, and a robot.json that `change` has modified."""
    def make(n):
        robot = copy.deepcopy(the_robot())
        lines = change(robot, n)
        return Source(lines or RULE, robot)
    make.__name__ = change.__name__
    return make


@with_robot
def unknown_keys(robot, n):
    robot |= {word(i): 1 for i in range(n)}


@with_robot
def sensors(robot, n):
    robot["sensors"] += [{"name": word(i), "type": "VIRTUAL", "channels": {"LEVEL": {"range": [0, 9]}}}
                         for i in range(n)]
    return sum(([f"WHEN {word(i)} LEVEL > 3", *RULE[1:]] for i in range(n)), [])


@with_robot
def misspelt_sensors(robot, n):
    robot["sensors"] += [{"name": word(i), "type": "GPIO", "pin": i % 200} for i in range(n)]
    return sum(([f"WHEN {word(i)}x LEVEL > 3", *RULE[1:]] for i in range(n)), [])


@with_robot
def actuators(robot, n):
    robot["actuators"] += [{"name": word(i), "type": "VIRTUAL", "device": "joint"} for i in range(n)]
    return (["WHEN touch LEVEL > 3", "DO"]
            + sum(([f"  MOVE {word(i)} TO 3deg", f"  MOVE {word(i)}x TO 3deg"] for i in range(n)), [])
            + ["END"])


@with_robot
def groups_and_behaviors(robot, n):
    robot["groups"] |= {word(i): ["left_arm", "right_arm", word(i)] for i in range(n)}
    robot["behaviors"] = [{"name": word(i // 2), "priority": 1 + i % 99, "action": word(i)}
                          for i in range(n)]


def repeated_keys(n):
    text = json.dumps(the_robot())
    members = ", ".join(f'"{word(i // 2)}": 1' for i in range(n))
    return Source(RULE, f"{text[:-1]}, {members}}}")


# Each with an n that takes long enough to be measured.
REPEATED = {
    misspelt_names: 4000, misspelt_defines: 4000, unknown_verbs: 4000, names_twice: 8000,
    syntax_errors: 24000, lines_of_other_languages: 4000, open_blocks: 16000, deep_nesting: 20000, long_line: 4000,
    state_words: 4000, misspelt_state_words: 4000, check_bands: 4000, variables: 4000, defines: 4000,
    behaviors: 4000, rules: 1000, different_rules: 4000, commands: 8000, tests: 2000,
    long_chain_of_modules: 1000, modules: 10000, too_many_modules: 4000, missing_modules: 6000,
    unknown_keys: 4000, repeated_keys: 4000, sensors: 4000, misspelt_sensors: 4000, actuators: 4000,
    groups_and_behaviors: 4000,
}

"""Texts for the tests of the language server, and for what it costs."""

ROBOT = """{
  "sensors": [
    {"name": "touch", "type": "VIRTUAL", "channels": {"LEVEL": {"range": [0, 10]}}},
    {"name": "proximity", "type": "VIRTUAL", "channels": {"DISTANCE": {"unit": "cm", "range": [2, 400]}}}
  ],
  "actuators": [
    {"name": "left_arm", "type": "PWM", "pin": "10", "device": "servo", "range": ["0deg", "120deg"]},
    {"name": "right_arm", "type": "PWM", "pin": "11", "device": "servo", "range": ["0deg", "120deg"]}
  ],
  "groups": {"arms": ["left_arm", "right_arm"]}
}
"""


RULES = 8  # of each of the 20 behaviours


def large(lines=10_000):
    """A program of so many lines without a mistake: about as many rules as the board can keep up with, and TESTs of them."""
    text = ["% A large program. \U0001F916", "REMEMBER total = 0"]
    for number in range(1, 21):
        text += [f"BEHAVIOR b{number} PRIORITY {number}"]
        for rule in range(RULES):
            text += [f"  WHEN touch LEVEL > {rule % 9} AND total > {number} COOLDOWN 2s",
                     "  DO",
                     "    IF proximity DISTANCE < 80cm",
                     "    DO MOVE arms TO 90deg OVER 400ms",
                     "    ELSE",
                     "      MOVE right_arm TO 10deg OVER 1s",
                     "    END",
                     "    SET total TO total + 1",
                     "  END"]
        text += ["END", ""]
    number = 0
    while len(text) < lines - 8:
        number += 1
        text += [f'TEST "number {number}"', "  AT 0s touch LEVEL = 0"]
        text += [f"  AT {at}s touch LEVEL = {at % 10}" for at in range(1, 40)]
        text += ["  EXPECT NOTHING FOR 1ms", "END", ""]
    while len(text) < lines:
        text.append("% the end")
    return "\n".join(text) + "\n"

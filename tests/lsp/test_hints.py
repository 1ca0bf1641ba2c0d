"""What an editor shows in a program that is not written there: inlay hints, signature help, the cost of a rule."""

import json
import re
import subprocess
import tempfile
import unittest
from pathlib import Path

from client import RSC, Server, position, range_of, uri

ROBOT = {
    "sensors": [{"name": "touch", "type": "VIRTUAL", "channels": {"LEVEL": {"range": [0, 10]}}}],
    "actuators": [{"name": "left_arm", "type": "PWM", "pin": "10", "device": "servo", "range": ["0deg", "120deg"]},
                  {"name": "sound", "type": "VIRTUAL", "device": "speaker"}],
    "behaviors": [{"name": "greet", "priority": 40}],
}
PROGRAM = """BEHAVIOR greet
  WHEN touch LEVEL > 3  # now
  DO
    MOVE left_arm TO 30deg
  END
END
BEHAVIOR rest PRIORITY 10
  WHEN touch LEVEL < 1 DO SAY "hm" END
END
"""


class Hints(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.program = Path(folder.name) / "robot.rsl"
        (Path(folder.name) / "robot.json").write_text(json.dumps(ROBOT))
        self.server = Server()
        self.addCleanup(self.server.__exit__)

    def hints(self, text, begin=0, end=None):
        self.server.open(self.program, text)
        found = self.server.ask("textDocument/inlayHint", textDocument={"uri": uri(self.program)},
                                range=range_of(text, begin, len(text) if end is None else end))
        return {(one["position"]["line"], one["position"]["character"]): one["label"] for one in found}

    def costs(self):
        """Of each line, what rsc check --timing says."""
        self.program.write_text(PROGRAM)
        said = subprocess.run([RSC, "check", "--timing", "--format", "json", self.program], check=True, capture_output=True, text=True)
        (timing,) = json.loads(said.stdout)["timing"]
        return {rule["line"]: rule["step"] for behavior in timing["behaviors"] for rule in behavior["rules"]}

    def test_the_priority_of_robot_json_stands_behind_the_name(self):
        hints = self.hints(PROGRAM)
        self.assertEqual(hints.pop((0, len("BEHAVIOR greet"))), "PRIORITY 40")
        self.assertNotIn("PRIORITY", " ".join(hints.values()))

    def test_what_a_rule_costs_stands_behind_its_first_line(self):
        hints = self.hints(PROGRAM)
        lines = PROGRAM.split("\n")
        costs = self.costs()
        self.assertEqual(set(costs), {2, 8})
        for line, cost in costs.items():
            self.assertEqual(hints[(line - 1, len(lines[line - 1]))], f"at most {cost} instructions")

    def test_only_what_is_asked_for_is_said(self):
        self.assertEqual(set(self.hints(PROGRAM, end=PROGRAM.index("  WHEN"))), {(0, len("BEHAVIOR greet"))})

    def test_a_wrong_program_has_its_priorities_and_no_costs(self):
        hints = self.hints(PROGRAM.replace("30deg", "30cm"))
        self.assertEqual(list(hints.values()), ["PRIORITY 40"])

    def test_the_cost_is_in_the_hover_of_a_rule(self):
        self.server.open(self.program, PROGRAM)
        said = self.server.ask("textDocument/hover", textDocument={"uri": uri(self.program)},
                               position=position(PROGRAM, PROGRAM.index("WHEN") + 1))["contents"]["value"]
        cost = re.search(r"It costs at most (\d+) instructions in a step\.", said)
        self.assertEqual(int(cost[1]), self.costs()[2])

    def signatures(self, line):
        text = PROGRAM.replace("    MOVE left_arm TO 30deg", line)
        self.server.open(self.program, text)
        said = self.server.ask("textDocument/signatureHelp", textDocument={"uri": uri(self.program)},
                               position=position(text, text.index(line) + len(line)))
        return [one["label"] for one in said["signatures"]] if said else []

    def test_signatures_of_the_actuator_that_is_named_else_of_all(self):
        (said,) = self.signatures("    MOVE left_arm ")
        self.assertIn("MOVE left_arm takes TO", said)
        self.assertEqual(self.signatures("    MOVE "), [said])
        self.assertEqual(self.signatures("    IF touch LEVEL > 3 DO move left_arm TO "), [said])
        (said,) = self.signatures("    SAY ")
        self.assertIn("SAY sound takes a text", said)
        for nothing in ("    ", "    WAIT ", "    # "):
            self.assertEqual(self.signatures(nothing), [])


if __name__ == "__main__":
    unittest.main()

"""bench/growth.py: in its programs one rule, and no other, has to do with the reading that is fed."""

import re
import sys
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "bench"), str(ROOT / "scripts/python")]

import growth


class Programs(unittest.TestCase):
    SIZES = ((10, 10, 8), (40, 10, 8), (1000, 64, 32))

    def test_one_rule_reads_the_first_channel(self):
        for rules, behaviors, channels in self.SIZES:
            text = growth.program(rules, behaviors, channels, 2, rules)
            read = re.findall(r"WHEN s (c\d+) ", text)
            self.assertEqual((len(read), read.count("c0")), (rules, 1))
            self.assertLessEqual(len(set(read)), channels)

    def test_rules_stand_evenly_in_the_behaviors(self):
        for rules, behaviors, channels in self.SIZES:
            text = growth.program(rules, behaviors, channels, 2, rules)
            counts = [part.count("WHEN") for part in text.split("BEHAVIOR")[1:]]
            self.assertEqual(len(counts), behaviors)
            self.assertLessEqual(max(counts) - min(counts), 1)

    def test_no_two_responses_are_the_same(self):
        text = growth.program(1000, 64, 32, 2, 2000)
        bodies = re.findall(r"DO\n(.*?)  END", text, re.S)
        self.assertEqual(len(set(bodies)), 1000)
        self.assertEqual(text.count("MOVE"), 2000)


if __name__ == "__main__":
    unittest.main()

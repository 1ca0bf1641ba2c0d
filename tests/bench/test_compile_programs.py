"""bench/compile_programs.py: its programs are what they are said to be; compile_figures.py: how they are
measured."""

import json
import sys
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "bench"), str(ROOT / "scripts/python")]

import compile_figures
import compile_programs
import page


class Programs(unittest.TestCase):
    def test_the_large_program_has_every_kind_of_rule_and_statement(self):
        lines = compile_programs.large_program(100_000).lines
        self.assertTrue(100_000 <= len(lines) < 100_020)
        first = {line.split()[0] for line in lines if line.strip()}
        self.assertLessEqual({"BEHAVIOR", "SAFETY", "CHECK", "STATE", "FEELING", "REMEMBER", "DEFINE", "WHEN",
                              "WHILE", "EVERY", "IF", "REPEAT", "PICK", "TEST", "EXPECT", "SET", "RAISE",
                              "MOVE", "SAY", "SHOW", "PLAY", "LOG", "WAIT", "THEN", "#"}, first)

    def test_twice_n_is_twice_as_much(self):
        for make in compile_programs.REPEATED:
            few, many = (make(n) for n in (200, 400))
            sizes = [sum(map(len, each.lines)) + sum(map(len, each.modules.values()))
                     + len(str(each.robot)) for each in (few, many)]
            self.assertTrue(1.5 < sizes[1] / sizes[0] < 2.2, (make.__name__, sizes))

    def test_names_are_different_and_names_for_rsl(self):
        names = {compile_programs.word(i) for i in range(20_000)}
        self.assertEqual(len(names), 20_000)
        self.assertTrue(all(name.replace("_", "").isalpha() for name in names))

    def test_every_program_has_its_figure_and_its_bar(self):
        bars = json.loads((ROOT / "bench/bars.json").read_text())
        for make in compile_programs.REPEATED:
            self.assertEqual(bars[f"compile/growth_{make.__name__}"], compile_figures.GROWTH_BAR)


class Verdicts(unittest.TestCase):
    def test_more_lines_a_second_are_better(self):
        figure = {"name": "compile/lines_per_second", "unit": "lines/s", "bar": 500}
        self.assertEqual(page.verdict({**figure, "value": 501}), "ok")
        self.assertEqual(page.verdict({**figure, "value": 499}), page.MISSED)

    def test_more_milliseconds_are_not(self):
        figure = {"name": "compile/paper", "unit": "ms", "bar": 5}
        self.assertEqual(page.verdict({**figure, "value": 5}), "ok")
        self.assertEqual(page.verdict({**figure, "value": 5.1}), page.MISSED)


if __name__ == "__main__":
    unittest.main()

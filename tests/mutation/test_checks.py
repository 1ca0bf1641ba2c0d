"""checks.py finds what there is to remove in small samples, and removes it in the right direction."""

import unittest

import changes
import checks
import modules
import safety


def found(source):
    return [(check.kind, check.text) for check in checks.find_checks("a.cpp", source)]


class Find(unittest.TestCase):
    def test_a_condition_that_refuses_and_each_of_its_alternatives(self):
        self.assertEqual(found("Refusal f(int a, int b) {\n"
                               "  if (a == 0 || b > 1) return Refusal::bad_value;\n"
                               "  return Refusal::none;\n}\n"),
                         [("refuse", "a == 0 || b > 1"), ("refuse", "a == 0"), ("refuse", "b > 1")])

    def test_what_good_or_wants_to_hold_and_each_part_of_it(self):
        self.assertEqual(found("Refusal f(int a, int b) {\n"
                               "  return good_or(Refusal::bad_value, a == 0 && (b > 1 || b < 0));\n}\n"),
                         [("accept", "a == 0 && (b > 1 || b < 0)"), ("accept", "a == 0"),
                          ("accept", "(b > 1 || b < 0)")])

    def test_not_turns_the_direction(self):
        self.assertIn(("accept", "a"), found("Refusal f(bool a, bool b) {\n"
                                             "  if (!(a && b)) return Refusal::bad_value;\n"
                                             "  return Refusal::none;\n}\n"))

    def test_predicates_flags_plain_reasons_and_calls(self):
        self.assertEqual(found("bool is_small(int a) {\n  return a < 3;\n}\n"), [("accept", "a < 3")])
        self.assertEqual(found("Refusal f(int a) {\n  const bool good = a < 3;\n"
                               "  if (!good) return Refusal::bad_value;\n  return g(a);\n}\n"),
                         [("accept", "a < 3"), ("refuse", "!good"), ("call", "g(a)")])
        self.assertEqual(found("Refusal f(int a) {\n  g(a);\n  return Refusal::bad_jump;\n}\n"),
                         [("return", "Refusal::bad_jump")])

    def test_comments_and_what_does_not_refuse_are_left_alone(self):
        self.assertEqual(found("Refusal f(int a) {\n  // if (a) return Refusal::bad_value;\n"
                               "  if (a > 3) a = 3;\n  return Refusal::none;\n}\n"), [])


class Instrument(unittest.TestCase):
    def test_switches_stand_inside_each_other(self):
        source = "bool f(int a, int b) {\n  return a < 3 && b < 4;\n}\n"
        text = checks.instrument(source, checks.find_checks("a.cpp", source), 7)
        self.assertIn("return (mutant(7) || ((mutant(8) || (a < 3)) && (mutant(9) || (b < 4))));", text)


class Changes(unittest.TestCase):
    def test_what_a_mutant_changes_is_there_once(self):
        for mutant in (*safety.MUTANTS, *modules.MUTANTS):
            with self.subTest(mutant.what):
                self.assertEqual((changes.ROOT / mutant.file).read_text().count(mutant.is_there), 1)


if __name__ == "__main__":
    unittest.main()

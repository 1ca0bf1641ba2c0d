"""bench/recorded.py: which change of a figure fails scripts/bench, and what it says then."""

import json
import re
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "bench"), str(ROOT / "scripts/python")]

import recorded
from board import REFERENCE
from boards import BARS, others


def figure(name, value, unit="insn"):
    return {"name": name, "value": value, "unit": unit, "bar": None}


def compared(before, *figures):
    comparison = recorded.Comparison(before)
    return comparison, [comparison.add(one) for one in figures]


class Pages(unittest.TestCase):
    """What they say is what is recorded, to the digits that they say."""

    def check(self, page, row):
        known = json.loads((ROOT / "bench/recorded.json").read_text())
        said = {found["name"]: found["value"].replace(",", "")
                for found in re.finditer(row, (ROOT / page).read_text(), re.MULTILINE) if found["name"] in known}
        self.assertGreater(len(said), 12)
        for name, value in said.items():
            with self.subTest(name):
                last_digit = 10 ** -len(value.partition(".")[2])
                self.assertLessEqual(abs(float(value) - known[name]), 0.5001 * last_digit)

    def test_readme(self):
        """A row of several figures names only their group, and is left out."""
        self.check("README.md", r"^\| .* \| (?P<value>[\d,.]+) [^|]* \| [^|]* \| `(?P<name>[a-z0-9_]+/\w+)` \|$")

    def test_measurements(self):
        self.check("docs/measurements.md", r"^\| `(?P<name>[a-z0-9_-]+/\w+)` \| (?P<value>[\d.]+) \| ")

    def test_boards(self):
        """The reference board's figures stand under other names."""
        known, bars = (json.loads((ROOT / f"bench/{name}.json").read_text()) for name in ("recorded", "bars"))
        text = (ROOT / "docs/boards.md").read_text()
        names = re.search(r"^\| figure \|(.*)\| bar \|$", text, re.MULTILINE)[1]
        boards = re.findall(r"`([\w-]+)`", names)
        self.assertEqual(boards, [REFERENCE, *others()])
        rows = re.findall(r"^\| `(\w+)`[^|]*\|((?: [\d,]+ \|)+) ([\d,]+)[^|]*\|$", text, re.MULTILINE)
        said = {row: [int(number.replace(",", "")) for number in (*values.split("|")[:-1], bar)] for row, values, bar in rows}
        figures = {name.split("/")[1] for name in known if name.startswith(f"{boards[1]}/")}
        self.assertEqual(set(said), figures)
        for row, values in said.items():
            of_reference = BARS.get(row, f"firmware/{row}")
            with self.subTest(row):
                self.assertEqual(values, [known[name] for name in (of_reference, *(f"{board}/{row}" for board in boards[1:]))]
                                 + [bars[of_reference]])


class Growth(unittest.TestCase):
    def test_what_stays_passes_without_a_word(self):
        comparison, passed = compared({"vm/W2": 50}, figure("vm/W2", 50))
        self.assertEqual((passed, comparison.grown, comparison.shrunk), ([True], [], []))

    def test_two_percent_are_tolerated_and_no_more(self):
        for now, passes in ((101.9, True), (102, True), (102.1, False)):
            self.assertEqual(compared({"vm/W2": 100}, figure("vm/W2", now))[1], [passes], now)

    def test_what_interrupts_come_between_may_differ_by_half(self):
        before = {"safety/stop_frame_to_safe_loaded": 400, "safety/guard_per_command": 400}
        self.assertEqual(compared(before, figure("safety/stop_frame_to_safe_loaded", 600),
                                  figure("safety/guard_per_command", 600))[1], [True, False])
        self.assertEqual(compared(before, figure("safety/stop_frame_to_safe_loaded", 601))[1], [False])

    def test_the_message_says_which_figure_recorded_now_and_what_to_do(self):
        comparison, _ = compared({"vm/W2": 100}, figure("vm/W2", 110))
        self.assertEqual(comparison.grown,
                         ["vm/W2: 100 insn recorded, 110 insn now, more than 2% above. Find out why; "
                          "if it is worth it: scripts/bench --record, and say so in the commit"])

    def test_nothing_may_become_something(self):
        self.assertEqual(compared({"vm/over": 0}, figure("vm/over", 1, ""))[1], [False])
        self.assertEqual(compared({"vm/over": 0}, figure("vm/over", 0, ""))[1], [True])

    def test_each_figure_is_compared_with_its_own_record(self):
        before = {"vm/W1": 10, "vm/W2": 1000}
        self.assertEqual(compared(before, figure("vm/W1", 1000), figure("vm/W2", 10))[1],
                         [False, True])


class Shrinking(unittest.TestCase):
    def test_it_passes_with_a_hint_to_record(self):
        comparison, passed = compared({"vm/W2": 100}, figure("vm/W2", 97))
        self.assertEqual((passed, comparison.grown), ([True], []))
        self.assertEqual(comparison.shrunk, ["vm/W2: 100 insn recorded, 97 insn now. So that it stays "
                                             "there: scripts/bench --record"])

    def test_within_the_tolerance_there_is_no_hint(self):
        self.assertEqual(compared({"vm/W2": 100}, figure("vm/W2", 98))[0].shrunk, [])


class Lists(unittest.TestCase):
    def test_a_figure_that_was_never_recorded_fails(self):
        comparison, passed = compared({}, figure("vm/new", 5))
        self.assertEqual(passed, [False])
        self.assertIn("vm/new (5 insn) was never recorded", comparison.grown[0])

    def test_one_group_leaves_what_is_recorded_of_others(self):
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "recorded.json"
            recorded.save([figure("vm/W1", 69), figure("vm/W2", 59)], path)
            recorded.save([figure("vm/W2", 60)], path, before=recorded.load(path))
            self.assertEqual(recorded.load(path), {"vm/W1": 69, "vm/W2": 60})

    def test_a_record_that_nothing_measures_is_told(self):
        comparison, _ = compared({"vm/W1": 1, "vm/gone": 2}, figure("vm/W1", 1))
        self.assertEqual(comparison.missing(), ["vm/gone"])

    def test_while_recording_nothing_is_compared(self):
        comparison, passed = compared(None, figure("vm/new", 5))
        self.assertEqual((passed, comparison.grown, comparison.missing()), ([True], [], []))

    def test_times_are_neither_recorded_nor_compared(self):
        figures = [figure("link/upload_time", 80, "ms"), figure("compile/speed", 9, "lines/s"),
                   figure("link/over", 2.0, "x"), figure("vm/W1", 69), figure("vm/flash", 8, "B")]
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "recorded.json"
            self.assertEqual(recorded.load(path), {})
            recorded.save(figures, path)
            kept = recorded.load(path)
        self.assertEqual(kept, {"vm/W1": 69, "vm/flash": 8})
        slower = [dict(one, value=one["value"] * 10) for one in figures[:3]]
        self.assertEqual(compared(kept, *slower)[1], [True, True, True])


if __name__ == "__main__":
    unittest.main()

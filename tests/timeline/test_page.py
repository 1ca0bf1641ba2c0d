"""The page of rsc run --html in a browser, with every example."""

import json
import re
import tempfile
import unittest
from pathlib import Path

import rsc
from browser import Browser

EXAMPLES = rsc.ROOT / "examples"
MARKS = {"lose": "denied"} | {kind: kind for kind in (
    "log", "alert", "fault", "deadline", "lowered", "overrun", "zero_divide", "silent", "answers", "blocked")}
# Two SAFETY rules that are tripped at once, the second for shorter; and a message that is neither LOG nor ALERT.
TRIPPED_TWICE = """SAFETY long
  WHEN touch LEVEL > 5 DO STOP arm
  RESUME WHEN touch LEVEL < 2
END
SAFETY short
  WHEN touch LEVEL > 7 DO STOP arm
  RESUME WHEN touch LEVEL < 7
END
WHEN 6 / touch LEVEL > 3 DO MOVE arm TO 10deg END
"""
TRIPPED_ROBOT = {"sensors": [{"name": "touch", "type": "VIRTUAL", "channels": {"LEVEL": {"range": [0, 10]}}}],
                 "actuators": [{"name": "arm", "device": "joint", "type": "VIRTUAL"}]}
TOUCHES = {"0s": 1, "1s": 6, "3s": 9, "4s": 6, "8s": 0}
PICTURES = dict(re.findall(r'^PICTURE\((\w+),\s*"(.*)"\)$', (rsc.ROOT / "runtime-m4/drivers/pictures.def").read_text(), re.M))
LIGHTS = 5


# So wide that no two commands fall into one pixel.
WIDE = {"width": 16000, "height": 2000}

# How many shapes there are of each class.
COUNTED = """Object.fromEntries(%s.map(kind => [kind, document.getElementsByClassName(kind).length]))"""
LANES = """[...document.querySelectorAll(".lane > svg")].map(lane => lane.getAttribute("aria-label"))"""
SHAPES = """[...document.querySelectorAll(".lane")].map(lane => lane.querySelectorAll("rect, text").length)"""
# The command that is nearest to the middle of the window, and what of it can be pointed at.
NEAREST = """(() => {
  const middle = shape => Math.abs(shape.getBoundingClientRect().left - innerWidth / 2);
  const bars = [...document.querySelectorAll(".bar")].filter(bar => %s);
  const box = bars.sort((a, b) => middle(a) - middle(b))[0].getBoundingClientRect();
  return [box.left + 1, box.top + 1, box.width];
})()"""
TIP = """document.getElementById("tip").textContent"""


def rows_of(path):
    """The picture whose lights a path draws, each in a square of its own."""
    lit = [tuple(map(float, at)) for at in re.findall(r"M([\d.]+),([\d.]+)", path)]
    left, top = (min(at[axis] for at in lit) for axis in (0, 1))
    size = float(re.search(r"h([\d.]+)", path)[1]) + 1
    found = {(round((y - top) / size), round((x - left) / size)) for x, y in lit}
    return trimmed(["".join("#" if (row, column) in found else "." for column in range(LIGHTS)) for row in range(LIGHTS)])


def trimmed(rows):
    """Moved to the top left: a path does not tell where the dark lights at its edges are."""
    lit = [(row, column) for row, lights in enumerate(rows) for column, light in enumerate(lights) if light == "#"]
    top, left = (min(at[axis] for at in lit) for axis in (0, 1))
    return {(row - top, column - left) for row, column in lit}


def rows_named(name):
    return trimmed(PICTURES[name].split('", "'))


class Page(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.browser = cls.enterClassContext(Browser())

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def tearDown(self):
        self.assertEqual(self.browser.errors, [])

    def run_it(self, example, scenario=None):
        """The page of an example's scenario, or of another one, and its trace."""
        page, trace = self.folder / f"{example.name}.html", self.folder / "run.jsonl"
        if scenario is None:
            (scenario,) = (path for path in example.glob("*.json") if path.name != "robot.json")
        rsc.run("run", example / "robot.rsl", "--scenario", scenario, "--fresh", "--kept", self.folder / "kept.json",
                "--html", page, "--trace", trace)
        return page, [json.loads(line) for line in trace.read_text("utf-8").splitlines()]

    def counted(self, *kinds):
        return self.browser.evaluate(COUNTED % json.dumps(kinds))

    def nearest(self, such="true"):
        return self.browser.evaluate(NEAREST % such)

    def test_every_event_of_every_example_is_drawn(self):
        examples = [path.parent for path in sorted(EXAMPLES.glob("*/robot.rsl")) if len(list(path.parent.glob("*.json"))) == 2]
        self.assertGreater(len(examples), 10)
        lasting = 0
        for example in examples:
            with self.subTest(example.name):
                page, trace = self.run_it(example)
                self.browser.show(page, **WIDE)
                kinds = [event["event"] for event in trace]
                drawn = self.counted("bar", "halt", "lasting", *(f"mark {mark}" for mark in MARKS.values()))
                lasting += drawn["lasting"]
                self.assertEqual(drawn["bar"], kinds.count("command") + kinds.count("trip"))
                self.assertEqual(drawn["halt"], kinds.count("halt"))
                for kind, mark in MARKS.items():
                    self.assertEqual(drawn[f"mark {mark}"], kinds.count(kind), kind)
                lanes = self.browser.evaluate(LANES)
                for name in {f"{event['sensor']} {event['channel']}" for event in trace if event["event"] == "input"}:
                    self.assertIn(name, lanes)
        self.assertGreater(lasting, 0)

    def test_a_long_run_draws_what_there_is_room_for(self):
        scenario = self.folder / "long.json"
        touches = [{"at": f"{20 * i}ms", "sensor": "touch", "channel": "LEVEL", "value": i * 7 % 10} for i in range(20_000)]
        scenario.write_text(json.dumps({"duration": "400s", "stimuli": touches}), "utf-8")
        page, trace = self.run_it(EXAMPLES / "touch_companion", scenario)
        self.assertGreater(len(trace), 80_000)
        self.browser.show(page)
        shapes = self.browser.evaluate(SHAPES)
        self.assertGreater(max(shapes), 100)
        self.assertLess(max(shapes), 2 * 1300)

    def test_safety_rules_that_are_tripped_at_once_are_drawn_beside_each_other(self):
        example = self.folder / "twice"
        example.mkdir()
        (example / "robot.rsl").write_text(TRIPPED_TWICE, "utf-8")
        (example / "robot.json").write_text(json.dumps(TRIPPED_ROBOT), "utf-8")
        stimuli = [{"at": at, "sensor": "touch", "value": value} for at, value in TOUCHES.items()]
        (example / "touches.json").write_text(json.dumps({"stimuli": stimuli}), "utf-8")
        page, trace = self.run_it(example)
        kinds = [event["event"] for event in trace]
        self.assertEqual((kinds.count("trip"), kinds.count("zero_divide")), (2, 1))
        self.browser.show(page)
        self.assertEqual(self.counted("bar trip", "mark zero_divide"), {"bar trip": 2, "mark zero_divide": 1})
        self.browser.evaluate("show(5e6, 6e6)")
        self.assertEqual(self.counted("bar trip"), {"bar trip": 1})

    def test_pointing_tells_why_and_clicking_shows_the_rule(self):
        self.browser.show(self.run_it(EXAMPLES / "touch_companion")[0])
        x, y, _ = self.nearest()
        self.browser.point(x, y)
        tip = self.browser.evaluate(TIP)
        self.assertIn("4.000 s to 5.334 s: left_arm MOVE QUICKLY", tip)
        self.assertIn("touch LEVEL = 5", tip)
        self.assertIn("rule at line 1 triggers its ELSE side", tip)
        self.browser.click(x, y)
        self.assertIn("1  WHEN touch LEVEL < 3", self.browser.evaluate("document.querySelector('#source .here').textContent"))

    def test_lights_are_drawn_with_the_picture_that_they_show(self):
        page, trace = self.run_it(EXAMPLES / "microbit_companion")
        shown = [event["word"] for event in trace if event["event"] == "command" and event.get("verb") == "SHOW"]
        self.assertEqual(shown, ["happy", "worried", "happy", "heart", "scared", "sleepy"])
        lit = "[...document.querySelectorAll('%s .lit')].map(path => path.getAttribute('d'))"
        self.browser.show(page, **WIDE)
        drawn = self.browser.evaluate(lit % ".lane")
        self.assertEqual([rows_of(path) for path in drawn], [rows_named(name) for name in shown])
        self.browser.show(page)
        x, y, _ = self.nearest("bar.item.picture !== undefined && bar.item.text.includes('heart')")
        self.browser.point(x, y)
        (large,) = self.browser.evaluate(lit % "#tip")
        self.assertEqual(rows_of(large), rows_named("heart"))

    def test_zooming_in_and_back(self):
        self.browser.show(self.run_it(EXAMPLES / "touch_companion")[0])
        x, y, before = self.nearest()
        button = "(() => { const box = document.getElementById('in').getBoundingClientRect(); return [box.x + 5, box.y + 5]; })()"
        for _ in range(2):
            self.browser.click(*self.browser.evaluate(button))
        self.assertAlmostEqual(self.nearest()[2] / before, 1 / 0.8**2, 2)
        self.browser.key("0")
        self.assertAlmostEqual(self.nearest()[2] / before, 1, 3)
        self.browser.wheel(x, y, -100)
        self.assertAlmostEqual(self.nearest()[2] / before, 1 / 0.8, 2)

    def test_dragging_moves_the_lanes(self):
        self.browser.show(self.run_it(EXAMPLES / "touch_companion")[0])
        self.browser.evaluate("show(BEGIN + (END - BEGIN) / 4, BEGIN + (END - BEGIN) / 2)")
        begin, span = self.browser.evaluate("[from, to - from]")
        x, y = self.browser.evaluate("(() => { const box = lanes.at(-1).svg.getBoundingClientRect(); return [box.x + 200, box.y + 9]; })()")
        self.browser.drag(x, y, x + 100, y)
        moved, width = self.browser.evaluate("[from, widthOf(lanes[0])]")
        self.assertAlmostEqual((begin - moved) / (span * 100 / width), 1, 3)


if __name__ == "__main__":
    unittest.main()

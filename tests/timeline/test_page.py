"""The page of rsc run --html in a browser: Chromium, headless, with every example."""

import html
import json
import re
import subprocess
import tempfile
import unittest
from pathlib import Path

import rsc

EXAMPLES = rsc.ROOT / "examples"
MARKS = {"lose": "denied"} | {kind: kind for kind in (
    "log", "alert", "fault", "deadline", "lowered", "overrun", "zero_divide", "silent", "answers", "blocked")}
PROFILE = tempfile.TemporaryDirectory()  # of the browser, which takes longer to make one than to show a page
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
# Appended to a page: does what a person does, and writes what is to be seen then into the title.
HANDS = """<script>
const seen = {};
const middle = shape => Math.abs(shape.getBoundingClientRect().left - innerWidth / 2);
const bar = [...document.querySelectorAll(".bar")].sort((a, b) => middle(a) - middle(b))[0];
const box = bar.getBoundingClientRect();
const at = kind => bar.dispatchEvent(new PointerEvent(kind, {bubbles: true, clientX: box.left + 1, clientY: box.top + 1}));
at("pointermove");
seen.tip = document.getElementById("tip").textContent;
at("pointerdown");
at("pointerup");
seen.source = document.querySelector("#source .here").textContent;
const width = () => Number([...document.querySelectorAll(".bar")].find(shape => shape.item === bar.item).getAttribute("width"));
const before = width();
document.getElementById("in").click();
document.getElementById("in").click();
seen.wider = width() / before;
dispatchEvent(new KeyboardEvent("keydown", {key: "0"}));
seen.back = width() / before;
document.title = JSON.stringify(seen);
</script>"""


# Appended to a page: points at the first command that shows a picture, and writes the picture beside its words into the title.
POINTS = """<script>
const bar = [...document.querySelectorAll(".bar")].find(shape => shape.item.picture !== undefined);
bar.dispatchEvent(new PointerEvent("pointermove", {bubbles: true}));
document.title = JSON.stringify(document.querySelector("#tip .lit").getAttribute("d"));
</script>"""
PICTURES = dict(re.findall(r'^PICTURE\((\w+),\s*"(.*)"\)$', (rsc.ROOT / "runtime-m4/drivers/pictures.def").read_text(), re.M))
LIGHTS = 5


# Pages beside each other, for a browser takes longer to start than to show one: their documents, when all scripts have run,
# stand in its title.
FRAMES = """{}<script>
const documents = () => [...document.querySelectorAll("iframe")].map(frame => frame.contentDocument.documentElement.outerHTML);
onload = () => document.title = JSON.stringify(documents());
</script>"""
FRAME = '<iframe src="{}" width="16000" height="2000"></iframe>'  # so wide that no two commands fall into one pixel


def dom(page):
    """The document as it is when its script has run."""
    done = subprocess.run(
        ["chromium", "--headless", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage", f"--user-data-dir={PROFILE.name}",
         "--allow-file-access-from-files", "--window-size=1300,1200", "--dump-dom", page.as_uri()],
        check=True, text=True, timeout=120, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)
    return done.stdout


def title_of(page):
    return json.loads(html.unescape(re.search(r"<title>(.*?)</title>", dom(page), re.DOTALL)[1]))


def wide_doms(pages, folder):
    together = folder / "together.html"
    together.write_text(FRAMES.format("".join(FRAME.format(page.as_uri()) for page in pages)), "utf-8")
    return title_of(together)


def count(document, kind):
    return len(re.findall(rf'class="{kind}[ "]', document))


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
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def show(self, example, scenario=None):
        """The page of an example's scenario, or of another one, and its trace."""
        page, trace = self.folder / f"{example.name}.html", self.folder / "run.jsonl"
        if scenario is None:
            (scenario,) = (path for path in example.glob("*.json") if path.name != "robot.json")
        rsc.run("run", example / "robot.rsl", "--scenario", scenario, "--fresh", "--kept", self.folder / "kept.json",
                "--html", page, "--trace", trace)
        return page, [json.loads(line) for line in trace.read_text("utf-8").splitlines()]

    def test_every_event_of_every_example_is_drawn(self):
        examples = [path.parent for path in sorted(EXAMPLES.glob("*/robot.rsl")) if len(list(path.parent.glob("*.json"))) == 2]
        self.assertGreater(len(examples), 10)
        shown = [self.show(example) for example in examples]
        documents = wide_doms([page for page, _ in shown], self.folder)
        self.assertTrue(any(count(document, "lasting") for document in documents))
        for example, (_, trace), document in zip(examples, shown, documents, strict=True):
            with self.subTest(example.name):
                kinds = [event["event"] for event in trace]
                self.assertEqual(count(document, "bar"), kinds.count("command") + kinds.count("trip"))
                self.assertEqual(count(document, "halt"), kinds.count("halt"))
                for kind, mark in MARKS.items():
                    self.assertEqual(count(document, f"mark {mark}"), kinds.count(kind), kind)
                for name in {f"{event['sensor']} {event['channel']}" for event in trace if event["event"] == "input"}:
                    self.assertIn(f'aria-label="{name}"', document)

    def test_a_long_run_draws_what_there_is_room_for(self):
        scenario = self.folder / "long.json"
        touches = [{"at": f"{20 * i}ms", "sensor": "touch", "channel": "LEVEL", "value": i * 7 % 10} for i in range(20_000)]
        scenario.write_text(json.dumps({"duration": "400s", "stimuli": touches}), "utf-8")
        page, trace = self.show(EXAMPLES / "touch_companion", scenario)
        self.assertGreater(len(trace), 80_000)
        document = dom(page)
        for lane in document.split('class="lane"')[1:]:
            self.assertLess(lane.count("<rect") + lane.count("<text"), 2 * 1300)

    def test_safety_rules_that_are_tripped_at_once_are_drawn_beside_each_other(self):
        example = self.folder / "twice"
        example.mkdir()
        (example / "robot.rsl").write_text(TRIPPED_TWICE, "utf-8")
        (example / "robot.json").write_text(json.dumps(TRIPPED_ROBOT), "utf-8")
        stimuli = [{"at": at, "sensor": "touch", "value": value} for at, value in TOUCHES.items()]
        (example / "touches.json").write_text(json.dumps({"stimuli": stimuli}), "utf-8")
        page, trace = self.show(example)
        kinds = [event["event"] for event in trace]
        self.assertEqual((kinds.count("trip"), kinds.count("zero_divide")), (2, 1))
        document = dom(page)
        self.assertEqual(count(document, "bar trip"), 2)
        self.assertEqual(count(document, "mark zero_divide"), 1)
        self.append(page, "<script>show(5e6, 6e6);</script>")
        self.assertEqual(count(dom(page), "bar trip"), 1)

    @staticmethod
    def append(page, script):
        page.write_text(page.read_text("utf-8").replace("</body>", script + "</body>"), "utf-8")

    def hands(self, page):
        self.append(page, HANDS)
        return title_of(page)

    def test_pointing_tells_why_and_clicking_shows_the_rule(self):
        seen = self.hands(self.show(EXAMPLES / "touch_companion")[0])
        self.assertIn("4.000 s to 5.334 s: left_arm MOVE QUICKLY", seen["tip"])
        self.assertIn("touch LEVEL = 5", seen["tip"])
        self.assertIn("rule at line 1 triggers its ELSE side", seen["tip"])
        self.assertIn("1  WHEN touch LEVEL < 3", seen["source"])

    def test_lights_are_drawn_with_the_picture_that_they_show(self):
        page, trace = self.show(EXAMPLES / "microbit_companion")
        shown = [event["word"] for event in trace if event["event"] == "command" and event.get("verb") == "SHOW"]
        self.assertEqual(shown, ["happy", "worried", "happy", "heart", "scared", "sleepy"])
        drawn = re.findall(r'<path d="([^"]*)" class="lit"', *wide_doms([page], self.folder))
        self.assertEqual([rows_of(path) for path in drawn], [rows_named(name) for name in shown])
        self.append(page, POINTS)
        self.assertEqual(rows_of(title_of(page)), rows_named("happy"))

    def test_zooming_in_and_back(self):
        seen = self.hands(self.show(EXAMPLES / "touch_companion")[0])
        self.assertAlmostEqual(seen["wider"], 1 / 0.8**2, 2)
        self.assertAlmostEqual(seen["back"], 1, 3)


if __name__ == "__main__":
    unittest.main()

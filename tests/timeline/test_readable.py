"""The page of rsc run --html as people see it who see other colours, who print it, or whose window is narrow."""

import base64
import itertools
import json
import tempfile
import unittest
from pathlib import Path

import rsc
from browser import Browser

EXAMPLES = ("touch_companion", "housemate", "moody_robot", "museum_guide", "safe_arms", "microbit_companion", "gaze", "pocket_pet")
VISIONS = ("none", "protanopia", "deuteranopia", "tritanopia", "achromatopsia")
KINDS = 16  # behaviours that look different
A4 = 718  # pixels between the margins
CONTRAST = 4.5  # of texts, as WCAG asks for

# Many behaviours, each of which moves its arm; and readings with many thresholds, that are unknown at first.
CROWD = "\n".join(f"""BEHAVIOR b{i} PRIORITY {50 - i}
  WHEN touch LEVEL > {i % 8 + 1} DO
    MOVE arm{i} TO {i + 1}deg
    LOG "{i}"
  END
END""" for i in range(KINDS))
CROWDED_ROBOT = {"sensors": [{"name": "touch", "type": "VIRTUAL", "channels": {"LEVEL": {"range": [0, 10]}}}],
                 "actuators": [{"name": f"arm{i}", "device": "joint", "type": "VIRTUAL"} for i in range(KINDS)]}
TOUCHES = {"1s": 0, "2s": 9, "3s": 1, "3.2s": 9, "5s": 2, "9s": 1}

# What is wrong with the texts of the lanes: [what, text].
MISPLACED = """(() => {
  const wrong = [], inside = 1;
  for (const svg of document.querySelectorAll(".lane > svg")) {
    const frame = svg.getBoundingClientRect(), names = document.querySelector(".name").getBoundingClientRect();
    const texts = [...svg.querySelectorAll("text")].map(text => ({text: text.textContent, box: text.getBoundingClientRect()}));
    const bars = [...svg.querySelectorAll(".bar, .halt")].map(bar => bar.getBoundingClientRect());
    const scale = frame.width / svg.viewBox.baseVal.width, apart = 2.5 * scale;
    for (const [i, {text, box}] of texts.entries()) {
      if (box.left < names.right || box.right > frame.right + inside) wrong.push(["cut", text]);
      for (const {text: other, box: at} of texts.slice(i + 1))
        if (box.left < at.right - inside && at.left < box.right - inside && box.top < at.bottom - apart && at.top < box.bottom - apart)
          wrong.push(["overlaps " + other, text]);
      for (const bar of bars)
        if ([bar.left, bar.right].some(edge => box.left + inside < edge && edge < box.right - inside))
          wrong.push(["crosses the end of a bar", text]);
    }
  }
  return wrong;
})()"""

# How large the lanes' texts are, as a share of their size on the screen.
SCALE = """Math.min(...[...document.querySelectorAll(".lane > svg")].map(svg => svg.clientWidth / svg.viewBox.baseVal.width))"""

# Texts with less contrast than `least`: [contrast, text]. The shapes below a text of a lane are as opaque as they say; a hatching
# counts as its ground, since texts keep it off by a white edge.
FAINT = """(() => {
  const least = %s, white = [255, 255, 255];
  const parsed = colour => (colour.match(/[\\d.]+/g) ?? []).map(Number);
  const over = (colour, opacity, below) => below.map((one, i) => colour[i] * opacity + one * (1 - opacity));
  const linear = one => one / 255 <= 0.03928 ? one / 255 / 12.92 : ((one / 255 + 0.055) / 1.055) ** 2.4;
  const light = colour => 0.2126 * linear(colour[0]) + 0.7152 * linear(colour[1]) + 0.0722 * linear(colour[2]);
  const contrast = (a, b) => (Math.max(light(a), light(b)) + 0.05) / (Math.min(light(a), light(b)) + 0.05);
  function ground(shape) {
    const hatching = /url\\("#(.*)"\\)/.exec(getComputedStyle(shape).fill);
    const style = getComputedStyle(hatching ? document.getElementById(hatching[1]).firstChild : shape);
    return over(parsed(style.fill), Number(style.fillOpacity), white);
  }
  function behind(element) {
    for (let at = element; at; at = at.parentElement) {
      const [r, g, b, opacity] = parsed(getComputedStyle(at).backgroundColor);
      if ((opacity ?? 1) > 0) return [r, g, b];
    }
    return white;
  }
  const faint = [];
  const judge = (colour, below, text) => { if (contrast(colour, below) < least) faint.push([contrast(colour, below), text]); };
  for (const text of document.querySelectorAll(".lane > svg text")) {
    const box = text.getBoundingClientRect(), colour = parsed(getComputedStyle(text).fill);
    judge(colour, behind(text.parentElement), text.textContent);
    for (const shape of text.parentElement.querySelectorAll("rect")) {
      const at = shape.getBoundingClientRect();
      if (at.left < box.right && box.left < at.right && at.top < box.bottom && box.top < at.bottom) judge(colour, ground(shape), text.textContent);
    }
  }
  for (const element of document.querySelectorAll("h1, .group, .name, .name small, #legend li, #hint, #source span"))
    judge(parsed(getComputedStyle(element).color), behind(element), element.textContent);
  return faint;
})()"""

# Where the swatches of the legend are; and the lanes' bars that do not look like their behaviour's swatch.
SWATCHES = """[...document.querySelectorAll("#legend svg")].map(one => one.getBoundingClientRect()).map(({x, y, width, height}) =>
  ({x: x + scrollX, y: y + scrollY, width, height}))"""
UNLIKE = """(() => {
  const look = shape => ["fill", "stroke", "stroke-dasharray"].map(name => shape.getAttribute(name)).join();
  const names = new Map([...document.querySelectorAll("#legend li")].map(entry => [entry.textContent, look(entry.querySelector("rect"))]));
  return [...document.querySelectorAll(".bar, .lasting")].filter(bar => names.get(behaviorName(bar.item.behavior)) !== look(bar)).length;
})()"""

# For each pair of pictures of one size, the share of their pixels that differ visibly.
COMPARED = """(async pictures => {
  const all = await Promise.all(pictures.map(async picture => {
    const image = await createImageBitmap(await (await fetch("data:image/png;base64," + picture)).blob());
    const canvas = new OffscreenCanvas(image.width, image.height).getContext("2d");
    canvas.drawImage(image, 0, 0);
    return canvas.getImageData(0, 0, image.width, image.height).data;
  }));
  return all.map(a => all.map(b => {
    let differ = 0;
    for (let i = 0; i < a.length; i += 4)
      if (Math.max(...[0, 1, 2].map(part => Math.abs(a[i + part] - b[i + part]))) > 30) ++differ;
    return differ / (a.length / 4);
  }));
})(%s)"""


class Readable(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.folder = Path(folder.name)
        crowd = cls.folder / "crowd"
        crowd.mkdir()
        (crowd / "robot.rsl").write_text(CROWD, "utf-8")
        (crowd / "robot.json").write_text(json.dumps(CROWDED_ROBOT), "utf-8")
        stimuli = [{"at": at, "sensor": "touch", "value": value} for at, value in TOUCHES.items()]
        (crowd / "touches.json").write_text(json.dumps({"stimuli": stimuli}), "utf-8")
        cls.crowd = cls.page(crowd)
        cls.pages = [cls.page(rsc.ROOT / "examples" / name) for name in EXAMPLES]
        cls.browser = cls.enterClassContext(Browser())

    @classmethod
    def page(cls, example):
        page = cls.folder / f"{example.name}.html"
        (scenario,) = (path for path in example.glob("*.json") if path.name != "robot.json")
        rsc.run("run", example / "robot.rsl", "--scenario", scenario, "--fresh", "--kept", cls.folder / "kept.json", "--html", page)
        return page

    def setUp(self):
        self.browser.media("screen")
        self.browser.vision("none")

    def test_behaviours_look_different_with_any_kind_of_colour_vision(self):
        for vision in VISIONS:
            self.browser.show(self.crowd)
            self.assertEqual(self.browser.evaluate(UNLIKE), 0)
            self.browser.vision(vision)
            places = self.browser.evaluate(SWATCHES)
            self.assertEqual(len(places), KINDS)
            pictures = [base64.b64encode(self.browser.picture(place)).decode() for place in places]
            differences = self.browser.evaluate(COMPARED % json.dumps(pictures))
            for a, b in itertools.combinations(range(KINDS), 2):
                self.assertGreater(differences[a][b], 0.05, f"{vision}: behaviours {a} and {b}")

    def test_no_text_covers_another_or_is_cut(self):
        for page, width in itertools.product([self.crowd, *self.pages], (1300, 640)):
            with self.subTest(page.stem, width=width):
                self.browser.show(page, width)
                self.assertEqual(self.browser.evaluate(MISPLACED), [])

    def test_a_printed_page_shows_all_of_the_run_in_black_on_white(self):
        self.browser.media("print")
        for page in [self.crowd, *self.pages]:
            with self.subTest(page.stem):
                self.browser.show(page)
                self.browser.resize(A4)
                self.browser.evaluate("dispatchEvent(new Event('beforeprint'))")
                self.assertEqual(self.browser.evaluate("getComputedStyle(document.body).backgroundColor"), "rgb(255, 255, 255)")
                self.assertGreater(self.browser.evaluate(SCALE), 0.9)
                self.assertEqual(self.browser.evaluate(MISPLACED), [])
                self.assertEqual(self.browser.evaluate(FAINT % CONTRAST), [])
                for place in ("document.documentElement", "document.getElementById('source')"):
                    self.assertLessEqual(self.browser.evaluate(f"{place}.scrollWidth"), A4, place)

    def test_printing_draws_for_paper_and_then_for_the_window_again(self):
        self.browser.show(self.pages[0])
        width = "document.querySelector('.lane svg').viewBox.baseVal.width"
        before = self.browser.evaluate(width)
        self.browser.evaluate(f"addEventListener('beforeprint', () => {{ window.printed = {width}; }})")
        self.browser.call("Page.printToPDF")
        self.assertLess(self.browser.evaluate("window.printed"), A4)
        self.assertEqual(self.browser.evaluate(width), before)

    def test_texts_have_contrast_on_the_screen(self):
        for page in [self.crowd, *self.pages]:
            with self.subTest(page.stem):
                self.browser.show(page)
                self.assertEqual(self.browser.evaluate(FAINT % CONTRAST), [])


if __name__ == "__main__":
    unittest.main()

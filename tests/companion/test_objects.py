"""objects: the markers and the colours that it sees in pictures that are drawn (draw.cpp), and what it refuses."""

import struct
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))
from recordings import ROOT, needs, run  # noqa: E402

DRAW = ROOT / "build/companion/companion/robosync-draw"
USUAL = {"period": 100, "view": 53.13, "smallest": 5, "vivid": 50, "hue_from": 0, "hue_to": 360}  # 640 columns, seen from so far
COLORS = {"orange": 30, "yellow": 56, "green": 120, "blue": 220, "purple": 300, "red": 0}  # hues in degrees


def draw(path, *things, noise=4, seed=1):
    subprocess.run([DRAW, path, str(seed), str(noise), *things], check=True)
    return path


@needs("objects")
class Objects(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="robosync-companion-")
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def run_on(self, source, *more, **changed):
        how = (part for name, value in {**USUAL, **changed}.items() for part in (f"--{name}", value))
        return run("objects", source, *how, *more)

    def see(self, *things, noise=4, seed=1, more=(), **changed):
        said, errors, code = self.run_on(draw(self.folder / "p.png", *things, noise=noise, seed=seed), *more, **changed)
        self.assertEqual((code, errors), (0, ""))
        return {output: value if output == "COLOR" else float(value) for output, value in said}

    def test_nothing_is_said_of_what_is_not_there(self):
        self.assertEqual(self.see("boxes:20"), {"COUNT": 0, "COLOR": "none", "MARKERS": 0, "MARKER": -1})

    # ---- markers

    def test_a_marker_and_where_it_is(self):
        seen = self.see("marker:7:480:240:96:0:0")
        self.assertEqual((seen["MARKERS"], seen["MARKER"], seen["COUNT"]), (1, 7, 0))
        self.assertAlmostEqual(seen["MARKER_ANGLE"], 14.04, delta=0.3)  # atan(160 / 640)
        self.assertAlmostEqual(seen["MARKER_SIZE"], 20, delta=0.7)
        self.assertAlmostEqual(self.see("marker:7:160:240:96:0:0")["MARKER_ANGLE"], -14.04, delta=0.3)

    def test_each_of_the_first_fifty(self):
        for number in (0, 1, 17, 38, 49):
            with self.subTest(number=number):
                self.assertEqual(self.see(f"marker:{number}:320:240:80:0:0")["MARKER"], number)

    def test_turned_tilted_small_and_in_noise(self):
        for turn in range(0, 360, 30):
            with self.subTest(turn=turn):
                seen = self.see(f"marker:3:320:240:90:{turn}:0")
                self.assertEqual(seen["MARKER"], 3)
                self.assertAlmostEqual(seen["MARKER_SIZE"], 90 / 4.8, delta=0.7)  # however it is turned
        for tilt in (-50, 50):
            with self.subTest(tilt=tilt):
                self.assertEqual(self.see(f"marker:3:320:240:90:10:{tilt}")["MARKER"], 3)
        self.assertEqual(self.see("marker:3:320:240:30:10:0")["MARKER"], 3)
        self.assertEqual(self.see("marker:3:320:240:90:20:0", noise=30)["MARKER"], 3)

    def test_the_nearest_of_several(self):
        seen = self.see("marker:1:100:240:60:0:0", "marker:2:320:240:100:0:0", "marker:3:540:240:80:0:0")
        self.assertEqual((seen["MARKERS"], seen["MARKER"]), (3, 2))
        self.assertAlmostEqual(seen["MARKER_ANGLE"], 0, delta=0.3)

    def test_a_qr_code_with_a_number_is_a_marker(self):
        seen = self.see("qr:123:480:240:120:15:0")
        self.assertEqual((seen["MARKERS"], seen["MARKER"]), (1, 123))
        self.assertAlmostEqual(seen["MARKER_ANGLE"], 14.04, delta=0.5)
        self.assertAlmostEqual(seen["MARKER_SIZE"], 25, delta=2)
        for text in ("1234", "-7", "hello", "7 ", "0x7"):
            with self.subTest(text=text):
                self.assertEqual(self.see(f"qr:{text}:320:240:150:0:0")["MARKERS"], 0)

    # ---- colours

    def test_each_colour_and_where_it_is(self):
        for color, hue in COLORS.items():
            with self.subTest(color=color):
                seen = self.see(f"ball:{hue}:160:240:96:80")
                self.assertEqual((seen["COUNT"], seen["COLOR"], seen["MARKERS"]), (1, color, 0))
                self.assertAlmostEqual(seen["ANGLE"], -14.04, delta=0.5)
                self.assertAlmostEqual(seen["SIZE"], 20, delta=1.5)

    def test_red_lies_on_both_sides_of_0_degrees(self):
        for hue in (348, 12):
            with self.subTest(hue=hue):
                self.assertEqual(self.see(f"ball:{hue}:320:240:96:80")["COLOR"], "red")

    def test_the_nearest_colour_is_the_highest_one(self):
        seen = self.see("ball:0:100:240:60:80", "ball:120:320:240:100:80", "ball:220:540:240:80:80")
        self.assertEqual((seen["COUNT"], seen["COLOR"]), (3, "green"))
        self.assertAlmostEqual(seen["ANGLE"], 0, delta=0.5)

    def test_what_is_pale_or_small_has_no_colour(self):
        self.assertEqual(self.see("ball:120:320:240:96:40")["COUNT"], 0)
        self.assertEqual(self.see("ball:120:320:240:96:40", vivid=30)["COLOR"], "green")
        self.assertEqual(self.see("ball:120:320:240:96:80", smallest=30)["COUNT"], 0)
        self.assertEqual(self.see("marker:7:320:240:96:0:0", smallest=30)["MARKERS"], 0)

    def test_only_the_hues_that_are_wanted(self):
        balls = ("ball:0:100:240:100:80", "ball:120:320:240:60:80")
        seen = self.see(*balls, hue_from=80, hue_to=160)
        self.assertEqual((seen["COUNT"], seen["COLOR"]), (1, "green"))
        seen = self.see(*balls, hue_from=340, hue_to=20)  # round the circle
        self.assertEqual((seen["COUNT"], seen["COLOR"]), (1, "red"))

    def test_a_line_is_no_thing(self):
        """A ring, which another ball leaves of the one behind it: thick enough to be seen, it fills little of its box."""
        self.assertEqual(self.see("ball:120:320:240:200:80", "ball:120:320:240:164:10")["COUNT"], 0)
        self.assertEqual(self.see("ball:120:320:240:200:80", "ball:120:320:240:100:10")["COUNT"], 1)

    def test_the_angle_is_one_of_the_cameras_view(self):
        seen = self.see("marker:7:480:240:96:0:0", "ball:0:480:400:80:80", view=90)
        self.assertAlmostEqual(seen["MARKER_ANGLE"], 26.6, delta=0.5)  # atan(1 / 2)
        self.assertAlmostEqual(seen["ANGLE"], 26.6, delta=0.7)

    # ---- what else it does

    def test_a_preview_shows_what_it_saw(self):
        preview = self.folder / "seen.png"
        self.see("marker:7:200:200:80:0:0", "ball:0:480:300:100:80", more=("--preview", preview))
        self.assertEqual(struct.unpack(">II", preview.read_bytes()[16:24]), (320, 240))
        plain = preview.read_bytes()
        self.see("ball:0:480:300:100:80", "marker:7:200:200:80:0:0", more=("--preview", preview), smallest=90)
        self.assertNotEqual(preview.read_bytes(), plain)  # nothing is marked in this one
        _, errors, code = self.run_on(self.folder / "p.png", "--preview", "/nobody/seen.png")
        self.assertEqual(code, 2)
        self.assertIn("cannot write /nobody/seen.png", errors)

    def test_what_it_refuses(self):
        for source, code, why in ((__file__, 2, "neither a picture nor a film"), ("/dev/video99", 3, "there is no camera")):
            with self.subTest(source=source):
                _, errors, exit_code = self.run_on(source)
                self.assertEqual(exit_code, code)
                self.assertIn(why, errors.splitlines()[-1])
        _, errors, code = self.run_on(draw(self.folder / "p.png"), vivid="very")
        self.assertEqual((code, errors), (2, "--vivid is no number: very\n"))


if __name__ == "__main__":
    unittest.main()

"""face_detect: how many faces it sees, and where. Its pictures are those of Debian's python3-skimage, which is unpacked in
build/faces (scripts/companion --test)."""

import shutil
import struct
import sys
import tempfile
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))
from recordings import ROOT, needs, run  # noqa: E402

PICTURES = ROOT / "build/faces/usr/lib/python3/dist-packages/skimage/data"
FACES = Path("/usr/share/opencv4/haarcascades")  # of the package opencv-data
USUAL = ("--period", 100, "--view", 60, "--smallest", 10, "--agreeing", 5)


@needs("face_detect")
class FaceDetect(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="robosync-companion-")
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def see(self, name, *arguments):
        if not PICTURES.is_dir():
            self.skipTest("there are no pictures: scripts/companion --test gets them")
        said, _, code = run("face_detect", PICTURES / name, *USUAL, *arguments)
        self.assertEqual(code, 0)
        return {output: float(value) for output, value in said}

    def test_a_face(self):
        seen = self.see("astronaut.png")
        self.assertEqual(seen["COUNT"], 1)
        # Her face is a fifth of the picture high; its middle is at 220 of 512 pixels.
        self.assertAlmostEqual(seen["ANGLE"], -4.3, delta=1)
        self.assertAlmostEqual(seen["NEARNESS"], 20, delta=2)

    def test_the_angle_is_one_of_the_cameras_view(self):
        wide, usual = self.see("astronaut.png", "--view", 120)["ANGLE"], self.see("astronaut.png")["ANGLE"]
        self.assertAlmostEqual(wide / usual, 3, delta=0.05)  # tan 60 deg / tan 30 deg

    def test_none_where_there_is_none(self):
        for name in ("coffee.png", "chelsea.png", "rocket.jpg", "motorcycle_left.png"):
            with self.subTest(name=name):
                self.assertEqual(self.see(name), {"COUNT": 0})

    def test_faces_that_are_too_small(self):
        self.assertEqual(self.see("astronaut.png", "--smallest", 40), {"COUNT": 0})

    def test_a_preview(self):
        preview = self.folder / "seen.png"
        self.see("astronaut.png", "--preview", preview)
        self.assertEqual(preview.read_bytes()[:8], b"\x89PNG\r\n\x1a\n")
        self.assertEqual(struct.unpack(">II", preview.read_bytes()[16:24]), (240, 240))
        self.assertEqual([file.name for file in self.folder.iterdir()], ["seen.png"])
        _, errors, code = run("face_detect", PICTURES / "astronaut.png", *USUAL, "--preview", "/nobody/seen.png")
        self.assertEqual(code, 2)
        self.assertIn("cannot write /nobody/seen.png", errors)

    def test_a_film(self):
        """Of pictures that are numbered, which is a film, too."""
        if not PICTURES.is_dir():
            self.skipTest("there are no pictures: scripts/companion --test gets them")
        for i in range(10):
            shutil.copy(PICTURES / ("astronaut.png" if i < 5 else "coffee.png"), self.folder / f"f{i:02}.png")
        said, _, code = run("face_detect", self.folder / "f%02d.png", *USUAL)
        self.assertEqual(code, 3)  # a camera, which gives no more pictures
        counts = [float(value) for output, value in said if output == "COUNT"]
        self.assertEqual(counts[0], 1)
        self.assertEqual(counts[-1], 0)

    def test_what_it_refuses(self):
        if not FACES.is_dir():
            self.skipTest("there is nothing to know faces by: scripts/companion --test gets it")
        for source, code, why in ((__file__, 2, "neither a picture nor a film"), ("/dev/video99", 3, "there is no camera")):
            with self.subTest(source=source):
                _, errors, exit_code = run("face_detect", source, *USUAL)
                self.assertEqual(exit_code, code)
                self.assertIn(why, errors.splitlines()[-1])


if __name__ == "__main__":
    unittest.main()

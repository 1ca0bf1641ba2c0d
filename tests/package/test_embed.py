"""The compiler in a program of somebody else's: installed, found by find_package(RoboSync), linked, called."""

import subprocess
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
ROBOT = '{"sensors": [{"name": "touch", "type": "VIRTUAL", "channels": {"LEVEL": {"range": [0, 10]}}}]}'
PROGRAM = 'WHEN touch LEVEL > 3 DO\n  LOG "a"\nEND\n'


class Embedded(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.folder = Path(folder.name)
        cls.call("cmake", "--install", ROOT / "build/host", "--prefix", cls.folder / "usr", "--component", "embed")
        cls.call("cmake", "-S", ROOT / "tests/package/embed", "-B", cls.folder / "build",
                 f"-DCMAKE_PREFIX_PATH={cls.folder / 'usr'}")
        cls.call("cmake", "--build", cls.folder / "build")

    @staticmethod
    def call(*command):
        done = subprocess.run([str(word) for word in command], check=False, capture_output=True, text=True, timeout=600)
        if done.returncode:
            raise AssertionError(f"{command[:2]}: {done.stdout[-2000:]}{done.stderr[-2000:]}")

    def embed(self, program):
        return subprocess.run([self.folder / "build/embed", program, ROBOT], check=False, capture_output=True, text=True,
                              timeout=60)

    def test_a_right_program_has_an_image(self):
        done = self.embed(PROGRAM)
        self.assertEqual(done.returncode, 0)
        self.assertRegex(done.stdout, r"(?m)^[1-9][0-9]+ bytes$")

    def test_a_wrong_one_is_told_what_is_wrong(self):
        done = self.embed(PROGRAM.replace("touch", "tuoch"))
        self.assertEqual(done.returncode, 1)
        self.assertIn("robot.rsl:1:6", done.stdout)
        self.assertTrue(done.stdout.endswith("\n0 bytes\n"))


if __name__ == "__main__":
    unittest.main()

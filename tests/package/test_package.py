"""The package of scripts/package, unpacked and used as after its installation, from an empty folder."""

import gzip
import os
import subprocess
import tempfile
import unittest
from pathlib import Path

from packed import package

ROOT = Path(__file__).resolve().parents[2]


class Package(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.root = Path(folder.name) / "root"
        cls.folder = Path(folder.name) / "empty"
        cls.folder.mkdir()
        subprocess.run(["dpkg-deb", "-x", package(), cls.root], check=True)

    def run_it(self, *command):
        path = f"{self.root}/usr/bin:{os.environ['PATH']}"
        done = subprocess.run(command, check=False, text=True, cwd=self.folder, env={**os.environ, "PATH": path},
                              stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        self.assertEqual(done.returncode, 0, done.stderr)
        return done.stdout

    def test_apt_finds_all_that_it_depends_on(self):
        self.assertIn("Inst robosync", self.run_it("apt-get", "install", "--simulate", package()))

    def test_a_new_robot_runs_without_the_sources(self):
        self.run_it("rsc", "new", "mine")
        self.run_it("rsc", "check", "mine/robot.rsl")
        self.run_it("rsc", "explain", "mine/robot.rsl")
        self.run_it("rsc", "run", "mine/robot.rsl", "--html", "run.html")
        self.assertTrue((self.folder / "run.html").stat().st_size > 0)

    def test_the_firmware_of_a_board_is_there_to_be_flashed(self):
        drive = self.folder / "drive"
        drive.mkdir()
        for board, file in {"microbit-v2": "hex", "b-l475e-iot01a": "bin", "nucleo-l476rg": "bin"}.items():
            self.run_it("rsc", "flash", "--board", board, "--drive", drive)
            installed = self.root / f"usr/share/robosync/firmware/robosync-{board}.{file}"
            self.assertEqual((drive / installed.name).read_bytes(), installed.read_bytes())

    def test_bash_and_man_know_it(self):
        completed = self.run_it("bash", "-c", f". {self.root}/usr/share/bash-completion/completions/rsc; COMP_WORDS=(rsc upl); COMP_CWORD=1; "
                                "_rsc; echo $COMPREPLY")
        self.assertEqual(completed, "upload\n")
        self.assertIn(".SS rsc upload", gzip.decompress((self.root / "usr/share/man/man1/rsc.1.gz").read_bytes()).decode())

    def test_install_puts_the_tool_into_the_folder_that_is_named(self):
        said = subprocess.run([ROOT / "scripts/install", "mine"], check=True, text=True, cwd=self.folder, stdout=subprocess.PIPE).stdout
        rsc = self.folder / "mine/bin/rsc"
        self.assertIn(f'export PATH="{rsc.parent}:$PATH"', said)
        self.assertTrue(said.endswith(f"{rsc} is installed\n"))
        self.assertTrue(self.run_it(rsc, "--version").startswith("rsc "))
        wrong = subprocess.run([ROOT / "scripts/install", "--pefix"], check=False, stdout=subprocess.DEVNULL)
        self.assertEqual(wrong.returncode, 2)


if __name__ == "__main__":
    unittest.main()

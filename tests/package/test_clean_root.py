"""The package of scripts/package, installed by apt in a Debian that has nothing else, used there by somebody, and removed."""

import tempfile
import unittest

import clean_root
from packed import package

BOARDS = {"microbit-v2": "hex", "b-l475e-iot01a": "bin", "nucleo-l476rg": "bin"}
COMPLETIONS = ("bash-completion/completions/rsc", "fish/vendor_completions.d/rsc.fish", "zsh/vendor-completions/_rsc")


class Installed(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = cls.enterClassContext(tempfile.TemporaryDirectory())
        try:
            cls.there = cls.enterClassContext(clean_root.CleanRoot(folder))
        except clean_root.NoRoots as reason:
            why = f"NOT TESTED: the package in a clean Debian. There is none: {reason}"
            print(why)
            raise unittest.SkipTest(why) from reason
        clean_root.make("cp", package(), cls.there.place / "tmp/robosync.deb")

    def succeeds(self, *command, user="root"):
        done = self.there.run(*command, user=user)
        self.assertEqual(done.returncode, 0, f"{command}: {done.stdout[-2000:]}")
        return done.stdout

    def somebody(self, commands):
        """Runs them as an ordinary user, in one empty folder."""
        return self.succeeds("sh", "-e", "-c", commands, user="somebody")

    def test_it_is_installed_used_and_removed(self):
        self.succeeds("useradd", "somebody")
        self.succeeds("apt-get", "update")
        before = self.there.files()
        self.succeeds("apt-get", "install", "-y", *clean_root.QUICK, "/tmp/robosync.deb")
        added = self.there.files() - before
        for name in ("usr/bin/rsc", "usr/share/man/man1/rsc.1.gz", *(f"usr/share/{place}" for place in COMPLETIONS)):
            self.assertIn(f"/{name}", added)
        with self.subTest("a new robot"):
            self.runs_a_new_robot()
        with self.subTest("modules"):
            self.uses_modules()
        with self.subTest("firmware"):
            self.flashes_each_board()
        self.succeeds("apt-get", "purge", "-y", "--auto-remove", *clean_root.QUICK, "robosync")
        self.assertEqual(self.there.files() - before, set())

    def runs_a_new_robot(self):
        self.assertRegex(self.somebody("rsc --version"), r"^rsc \d")
        said = self.somebody("rsc new mine; rsc check mine/robot.rsl; rsc test mine/robot.rsl; rsc compile mine/robot.rsl -o mine.rsb;"
                             "rsc run mine/robot.rsl --scenario mine/visit.json --html run.html; ls run.html mine.rsb")
        self.assertIn("run.html", said)

    def uses_modules(self):
        said = self.somebody("rsc new arms --template safe; cd arms; grep '^USE' robot.rsl; rsc check robot.rsl; "
                             "rsc run robot.rsl --scenario accidents.json")
        self.assertIn("USE voice_stop", said)
        self.assertIn("Stopped by voice", said)

    def flashes_each_board(self):
        for board, kind in BOARDS.items():
            self.somebody(f"mkdir drive; rsc flash --board {board} --drive drive; "
                          f"cmp drive/robosync-{board}.{kind} /usr/share/robosync/firmware/robosync-{board}.{kind}")


if __name__ == "__main__":
    unittest.main()

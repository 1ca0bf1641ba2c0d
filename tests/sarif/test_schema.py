"""`rsc check --format sarif` against the official schema of SARIF 2.1.0, which an npm package has: with every case of
tests/compiler/diagnostics/golden, and with paths and texts that need care."""

import copy
import json
import os
import shutil
import subprocess
import tempfile
import unittest
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import rsc

HERE = Path(__file__).resolve().parent
PACKAGES = rsc.ROOT / "build/sarif"
GOLDEN = rsc.ROOT / "tests/compiler/diagnostics/golden"
ROBOT = {"sensors": [{"name": "touch", "type": "VIRTUAL", "channels": {"LEVEL": {"range": [0, 10]}}}],
         "actuators": [{"name": "sound", "type": "VIRTUAL", "device": "speaker"}]}
RIGHT = 'WHEN touch LEVEL > 3 DO\n  LOG "a"\nEND\n'
MISSPELT = RIGHT.replace("touch", "tuoch")
DIVIDES = 'REMEMBER x = 0\nWHEN touch LEVEL > 3 DO\n  SET x TO 5 / touch LEVEL\nEND\n'  # a warning
ASKS_AT_START = 'WHEN touch LEVEL > 3\nDO LOG "a"\nELSE LOG "b"\nEND\n'  # a note
STRANGE_TEXT = 'WHEN tuoch LEVEL > 3 DO\n  LOG "\t\\ä🤖", \x01\nEND\n'
STRANGE_NAMES = ("two words.rsl", "100%.rsl", "a#b?c=d&e.rsl", "c:d.rsl", "ä🤖.rsl", "[a]{b}^`|\\\"'<>.rsl", "new\nline.rsl",
                 os.fsdecode(b"\xff\xfe.rsl"))


class Missing(Exception):
    """Why the schema cannot be had."""


def get_packages():
    if not shutil.which("node") or not shutil.which("npm"):
        raise Missing("node and npm are not installed")
    PACKAGES.mkdir(parents=True, exist_ok=True)
    shutil.copy(HERE / "package.json", PACKAGES)
    # No package's own scripts run during the installation.
    done = subprocess.run(["npm", "install", "--no-audit", "--no-fund", "--ignore-scripts", "--prefer-offline"], cwd=PACKAGES, text=True,
                          check=False, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    if done.returncode:
        raise Missing(f"npm could not get the packages: {done.stdout[-1000:]}")


class Schema(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        try:
            get_packages()
        except Missing as reason:
            why = f"NOT TESTED: SARIF against its schema: {reason}"
            print(why)
            raise unittest.SkipTest(why) from reason

    def setUp(self):
        self.folder = Path(self.enterContext(tempfile.TemporaryDirectory()))
        (self.folder / "robot.json").write_text(json.dumps(ROBOT), "utf-8")
        self.written = 0

    def write(self, name, text):
        (self.folder / name).write_text(text, "utf-8")
        return name

    def keep(self, log):
        self.written += 1
        path = self.folder / f"{self.written}.sarif"
        path.write_text(log if isinstance(log, str) else json.dumps(log), "utf-8")
        return str(path)

    def log_of(self, *arguments):
        """The log of one call of rsc."""
        return rsc.call("check", *arguments, "--format", "sarif", cwd=self.folder).stdout

    def faults(self, paths):
        """What the schema says against these files: {path: [what]}, without those that it accepts."""
        done = subprocess.run(["node", HERE / "validate.mjs", PACKAGES], input="\n".join(paths), check=True, text=True, stdout=subprocess.PIPE)
        found = json.loads(done.stdout)
        self.assertEqual(sorted(found), sorted(paths))
        return {path: what for path, what in found.items() if what}

    def accepted(self, *arguments):
        """The log of this call, which the schema accepts."""
        log = self.log_of(*arguments)
        self.assertEqual(self.faults([self.keep(log)]), {})
        return json.loads(log)

    def results(self, log):
        (run,) = log["runs"]
        return run["results"]

    def test_all_levels_fixes_and_both_files(self):
        broken = self.write("broken.json", '{"sensors": [{"name": "touch", "type": "VIRTULA"}]}')
        for name, text in {"wrong.rsl": MISSPELT, "divides.rsl": DIVIDES, "asks.rsl": ASKS_AT_START}.items():
            self.write(name, text)
        results = self.results(self.accepted("wrong.rsl", "divides.rsl", "asks.rsl"))
        self.assertEqual({one["level"] for one in results}, {"error", "warning", "note"})
        self.assertTrue(any("fixes" in one for one in results))
        places = [place["physicalLocation"]["artifactLocation"]["uri"]
                  for one in self.results(self.accepted("wrong.rsl", "--config", broken)) for place in one["locations"]]
        self.assertIn("broken.json", places)

    def test_nothing_found_and_nothing_read(self):
        self.assertEqual(self.results(self.accepted(self.write("right.rsl", RIGHT))), [])
        unread = self.accepted("not_there.rsl", "right.rsl")
        self.assertEqual(self.results(unread), [])
        (call,) = unread["runs"][0]["invocations"]
        (notification,) = call["toolExecutionNotifications"]
        self.assertFalse(call["executionSuccessful"])
        self.assertIn("not_there.rsl", notification["message"]["text"])
        self.assertEqual(notification["locations"][0]["physicalLocation"]["artifactLocation"]["uri"], "not_there.rsl")

    def test_strange_names_and_texts(self):
        for name in STRANGE_NAMES:
            with self.subTest(name.encode("utf-8", "replace")):
                log = self.accepted(self.write(name, STRANGE_TEXT))
                self.assertGreater(len(self.results(log)), 0)
        self.assertGreater(len(self.results(self.accepted(self.folder / self.write("two words.rsl", MISSPELT)))), 0)

    def test_every_program_that_causes_a_diagnostic(self):
        cases = sorted({path.stem for path in GOLDEN.iterdir() if path.suffix != ".txt"})

        def part(name, suffix):
            path = GOLDEN / f"{name}{suffix}"
            return path if path.exists() else GOLDEN / f"robot{suffix}"

        def log_of(name):
            return self.log_of(part(name, ".rsl"), "--config", part(name, ".json"))
        with ThreadPoolExecutor(os.cpu_count()) as pool:
            logs = list(pool.map(log_of, cases))
        found = self.faults([self.keep(log) for log in logs])
        self.assertEqual(found, {})
        codes = {one["ruleId"] for log in logs for one in self.results(json.loads(log))}
        self.assertGreater(len(codes), 80)
        self.assertTrue(any("relatedLocations" in one for log in logs for one in self.results(json.loads(log))))

    def test_the_schema_notices_what_is_wrong(self):
        log = json.loads(self.log_of(self.write("wrong.rsl", MISSPELT)))
        breaks = {
            "level": lambda result: result.update(level="fatal"),
            "message": lambda result: result.pop("message"),
            "region": lambda result: result["locations"][0]["physicalLocation"]["region"].update(startLine=0),
            "uri": lambda result: result["locations"][0]["physicalLocation"]["artifactLocation"].update(uri="two words.rsl"),
            "fixes": lambda result: result["fixes"][0].update(artifactChanges=[]),
            "more": lambda result: result.update(column=1),
        }
        for name, damage in breaks.items():
            with self.subTest(name):
                damaged = copy.deepcopy(log)
                damage(self.results(damaged)[0])
                self.assertNotEqual(self.faults([self.keep(damaged)]), {})


if __name__ == "__main__":
    unittest.main()

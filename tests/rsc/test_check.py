"""`rsc check` as scripts and code hosts call it: SARIF, lint levels, colour, standard input, files that cannot be read."""

import json
import os
import re
import subprocess
import tempfile
import unittest
from pathlib import Path
from urllib.parse import unquote, urlparse

RSC = os.environ["ROBOSYNC_RSC"]
ROBOT = """{"sensors": [{"name": "touch", "type": "VIRTUAL", "channels": {"LEVEL": {"range": [0, 10]}}}],
 "actuators": [{"name": "sound", "type": "VIRTUAL", "device": "speaker"}]}"""
RIGHT = 'WHEN touch LEVEL > 3 DO\n  LOG "a"\nEND\n'
ASKS_AT_START = 'WHEN touch LEVEL > 3\nDO LOG "a"\nELSE LOG "b"\nEND\n'  # W0203, a note
DIVIDES = 'REMEMBER x = 0\nWHEN touch LEVEL > 3 DO\n  SET x TO 5 / touch LEVEL\nEND\n'  # W0217, a warning
MISSPELT = RIGHT.replace("touch", "tuoch")
ESCAPE = "\x1b"


class Check(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        (self.folder / "robot.json").write_text(ROBOT)

    def write(self, name, text):
        (self.folder / name).write_text(text)
        return name

    def check(self, *arguments, text="", **environment):
        return subprocess.run([RSC, "check", *arguments], cwd=self.folder, input=text, text=True, timeout=60,
                              capture_output=True, check=False, env={**os.environ, **environment})

    # ---- SARIF

    def sarif(self, *files):
        done = self.check(*files, "--format", "sarif")
        self.assertEqual(done.stderr, "")
        return done, json.loads(done.stdout)

    def test_sarif_has_what_the_schema_asks_for(self):
        done, log = self.sarif(self.write("wrong one.rsl", MISSPELT), self.write("divides.rsl", DIVIDES))
        self.assertEqual(done.returncode, 1)
        self.assertEqual(log["version"], "2.1.0")
        self.assertIn("sarif-2.1.0", log["$schema"])
        (run,) = log["runs"]
        self.assertEqual(run["columnKind"], "unicodeCodePoints")
        driver = run["tool"]["driver"]
        self.assertEqual(driver["name"], "rsc")
        self.assertEqual(len({rule["id"] for rule in driver["rules"]}), len(driver["rules"]))
        for rule in driver["rules"]:
            self.assertTrue(rule["shortDescription"]["text"])
            self.assertIn(rule["defaultConfiguration"]["level"], ("error", "warning", "note"))
        self.assertGreaterEqual(len(run["results"]), 2)
        for result in run["results"]:
            self.assertEqual(driver["rules"][result["ruleIndex"]]["id"], result["ruleId"])
            self.assertIn(result["level"], ("error", "warning", "note"))
            self.assertTrue(result["message"]["text"])
            self.assertTrue(result["locations"])
            for place in result["locations"] + result.get("relatedLocations", []):
                self.is_a_place(place)

    def is_a_place(self, place):
        physical = place["physicalLocation"]
        uri = physical["artifactLocation"]["uri"]
        self.assertRegex(uri, r"^[A-Za-z0-9._~/%-]+$")
        self.assertTrue((self.folder / unquote(urlparse(uri).path)).exists(), uri)
        region = physical["region"]
        begin, end = ((region[f"{side}Line"], region[f"{side}Column"]) for side in ("start", "end"))
        self.assertTrue((1, 1) <= begin <= end, region)

    def test_a_fix_of_sarif_mends_the_program(self):
        _, log = self.sarif(self.write("wrong.rsl", MISSPELT))
        (result,) = [one for one in log["runs"][0]["results"] if one["level"] == "error"]
        (change,) = result["fixes"][0]["artifactChanges"]
        (replacement,) = change["replacements"]
        region = replacement["deletedRegion"]
        self.assertEqual((region["startLine"], region["endLine"]), (1, 1))
        lines = MISSPELT.splitlines(keepends=True)
        lines[0] = (lines[0][:region["startColumn"] - 1] + replacement["insertedContent"]["text"] +
                    lines[0][region["endColumn"] - 1:])
        self.assertEqual("".join(lines), RIGHT)

    def test_sarif_of_a_right_program_has_no_errors(self):
        done, log = self.sarif(self.write("right.rsl", RIGHT))
        self.assertEqual(done.returncode, 0)
        self.assertNotIn("error", [result["level"] for result in log["runs"][0]["results"]])

    # ---- levels

    def levels(self, text, *options):
        done = self.check(self.write("robot.rsl", text), "--format", "json", *options)
        report = json.loads(done.stdout)
        self.assertEqual(done.returncode, 1 if report["errors"] else 0)
        return {one["code"]: one["level"] for one in report["diagnostics"]}

    def test_levels_by_command_line(self):
        self.assertEqual(self.levels(ASKS_AT_START)["W0203"], "note")
        self.assertEqual(self.levels(ASKS_AT_START, "--warn", "W0203")["W0203"], "warning")
        self.assertEqual(self.levels(ASKS_AT_START, "--deny", "W0203")["W0203"], "error")
        self.assertNotIn("W0203", self.levels(ASKS_AT_START, "--allow", "W0203"))
        both = self.levels(ASKS_AT_START, "--allow", "W0203", "--allow", "W0209")
        self.assertFalse({"W0203", "W0209"} & both.keys())

    def test_deny_warnings_makes_errors_of_warnings_only(self):
        self.assertEqual(self.levels(DIVIDES)["W0217"], "warning")
        self.assertEqual(self.levels(DIVIDES, "--deny", "warnings")["W0217"], "error")
        self.assertEqual(self.levels(ASKS_AT_START, "--deny", "warnings")["W0203"], "note")
        self.assertNotIn("W0217", self.levels(DIVIDES, "--deny", "warnings", "--allow", "W0217"))

    def test_levels_by_a_comment_above_the_line(self):
        self.assertNotIn("W0203", self.levels("# allow W0203: the first reading shall choose\n" + ASKS_AT_START))
        self.assertEqual(self.levels("% why\n  % Warn W0203\n# more\n" + ASKS_AT_START)["W0203"], "warning")
        self.assertEqual(self.levels("# deny W0203\n" + ASKS_AT_START, "--allow", "W0203")["W0203"], "error")
        self.assertNotIn("W0203", self.levels("\ufeff# allow W0203\n" + ASKS_AT_START), "a byte order mark is no part of it")
        for other in ("# allow W0204\n", "# allow W0203\n\n", "# allowing W0203\n", "LET y = 1  # allow W0203\n"):
            self.assertIn("W0203", self.levels(other + ASKS_AT_START), other)

    def test_an_error_is_not_allowed_and_a_wrong_code_is_wrong_usage(self):
        self.assertEqual(self.levels("# allow E0501\n" + MISSPELT)["E0501"], "error")
        for code in ("E0501", "W9999", "warning", ""):
            done = self.check("--deny", code, self.write("robot.rsl", RIGHT))
            self.assertEqual(done.returncode, 2, code)
            self.assertIn("is not a lint", done.stderr)

    # ---- colour

    def test_colour_is_asked_for_or_not_there(self):
        name = self.write("robot.rsl", MISSPELT)
        self.assertNotIn(ESCAPE, self.check(name).stderr)
        self.assertNotIn(ESCAPE, self.check(name, "--color", "auto").stderr)
        self.assertNotIn(ESCAPE, self.check(name, "--color", "never").stderr)
        coloured = self.check(name, "--color", "always", NO_COLOR="1").stderr
        self.assertIn(ESCAPE, coloured)
        self.assertEqual(re.sub(ESCAPE + r"\[[0-9;]*m", "", coloured), self.check(name).stderr)
        self.assertEqual(self.check(name, "--color", "sometimes").returncode, 2)

    # ---- what is read

    def test_standard_input_has_the_robot_of_the_folder(self):
        done = self.check("-", text=RIGHT)
        self.assertEqual((done.returncode, done.stdout.split(",")[0]), (0, "stdin: 0 errors"))
        done = self.check("-", text=MISSPELT)
        self.assertEqual(done.returncode, 1)
        self.assertIn("stdin:1:6", done.stderr)

    def test_a_file_that_cannot_be_read_does_not_silence_the_others(self):
        done = self.check("missing.rsl", self.write("wrong.rsl", MISSPELT), self.write("right.rsl", RIGHT))
        self.assertEqual(done.returncode, 3)
        self.assertIn("missing.rsl", done.stderr)
        self.assertIn("wrong.rsl:1:6", done.stderr)
        self.assertIn("right.rsl: 0 errors", done.stdout)
        for verb in ("test", "fmt"):
            done = subprocess.run([RSC, verb, "missing.rsl", "right.rsl"], cwd=self.folder, text=True, timeout=60,
                                  capture_output=True, check=False)
            self.assertEqual(done.returncode, 3, verb)
            self.assertIn("missing.rsl", done.stderr)
            self.assertEqual("there is no TEST" in done.stderr, verb == "test")

    # ---- rsc fix

    def fix(self, *arguments, text=""):
        return subprocess.run([RSC, "fix", *arguments], cwd=self.folder, input=text, text=True, timeout=60,
                              capture_output=True, check=False)

    def test_fix_mends_what_is_certain_in_both_files(self):
        program = self.write("robot.rsl", RIGHT.replace("WHEN", "WHEN WHEN"))
        (self.folder / "robot.json").write_text(ROBOT.replace('"sensors"', '"sensosr"'))
        done = self.fix(program)
        self.assertEqual((done.returncode, done.stdout.split(", ")[0]), (0, "robot.rsl: 2 fixed; 0 errors"))
        self.assertEqual((self.folder / "robot.rsl").read_text(), RIGHT)
        self.assertEqual((self.folder / "robot.json").read_text(), ROBOT)

    def test_fix_leaves_what_is_likely_unless_it_is_told(self):
        text = RIGHT.replace("> 3", "> .3")
        program = self.write("robot.rsl", text)
        for done in (self.fix(program), self.fix("--likely", program, text="n\n"), self.fix("--likely", program)):
            self.assertEqual(done.returncode, 1)
            self.assertEqual((self.folder / "robot.rsl").read_text(), text)
        done = self.fix("--likely", program, text="y\n")
        self.assertEqual(done.returncode, 0)
        self.assertIn("`.3` -> `0.3`?", done.stdout)
        self.assertEqual((self.folder / "robot.rsl").read_text(), RIGHT.replace("> 3", "> 0.3"))

    def test_fix_makes_a_right_program_of_one_that_says_then_and_do(self):
        program = self.write("robot.rsl", RIGHT.replace(" DO", " THEN\nDO"))
        done = self.fix("--likely", program, text="y\n")
        self.assertEqual(done.returncode, 0)
        self.assertEqual((self.folder / "robot.rsl").read_text(), RIGHT.replace(" DO", "\nDO"))

    def test_fix_says_how_many_likely_fixes_there_are(self):
        program = self.write("robot.rsl", RIGHT.replace("> 3", "> .3"))
        self.assertIn("0 fixed, 1 more with --likely; 1 error", self.fix(program).stdout)
        self.assertNotIn("more with", self.fix("--likely", program).stdout)

    def test_fix_does_not_ask_about_what_brings_a_new_error_to_its_line(self):
        text = 'als touch IS high\nDO LOG "a"\nEND\n'  # WHEN in front of it gives the unknown sensor `als`
        program = self.write("robot.rsl", text)
        self.assertIn("`WHEN` is missing", self.check(program).stderr)
        done = self.fix("--likely", program, text="y\n" * 9)
        self.assertNotIn("[y/N]", done.stdout)
        self.assertEqual((self.folder / "robot.rsl").read_text(), text)

    def test_fix_makes_right_programs_of_those_of_other_languages(self):
        for foreign in ("on touch LEVEL > 3:\n", "WENN touch LEVEL > 3\nDO\n", "forever:\n"):
            program = self.write("robot.rsl", foreign + '  LOG "a"\nEND\n')
            self.fix("--likely", program, text="y\n" * 9)
            done = self.check(program)
            self.assertEqual((done.returncode, done.stderr), (0, ""), foreign)

    def test_fix_leaves_a_right_program_alone(self):
        program = self.write("robot.rsl", RIGHT)
        before = (self.folder / "robot.rsl").stat().st_mtime_ns
        self.assertEqual(self.fix(program).returncode, 0)
        self.assertEqual((self.folder / "robot.rsl").stat().st_mtime_ns, before)

    def test_no_more_than_twenty_errors_are_shown(self):
        names = ["".join(chr(ord("a") + int(digit)) for digit in str(1000 + number)) for number in range(51)]
        text = "".join(f'WHEN touch {name} > 3 DO LOG "a" END\n' for name in names)
        done = self.check(self.write("robot.rsl", text))
        self.assertEqual(done.stderr.count("error["), 20)
        self.assertIn("\nand 31 more\n", done.stderr)
        self.assertIn("51 errors", done.stdout)


if __name__ == "__main__":
    unittest.main()

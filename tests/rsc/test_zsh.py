"""`rsc completion zsh`, read by a zsh whose own helpers are replaced by ones that print what they are given."""

import os
import subprocess
import tempfile
import unittest

RSC = os.environ["ROBOSYNC_RSC"]
# compdef comes with compinit, which looks for files of completions all over the system.
BEFORE = r"""
compdef() { }
_describe() { print -rl -- $verbs }
_arguments() { print -rl -- "$@" }
source $1
shift
words=("$@")
CURRENT=$#words
_rsc
"""


class Zsh(unittest.TestCase):
    def offered(self, *words):
        script = subprocess.run([RSC, "completion", "zsh"], check=True, capture_output=True, text=True).stdout
        with tempfile.NamedTemporaryFile("w", suffix=".zsh") as file:
            file.write(script)
            file.flush()
            done = subprocess.run(["zsh", "-f", "-c", BEFORE, "zsh", file.name, *words], capture_output=True, text=True,
                                  check=False, timeout=60)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        return done.stdout.splitlines()

    def test_verbs_with_what_they_do(self):
        verbs = self.offered("rsc", "")
        self.assertIn("check:finds every mistake in a program and its configuration", verbs)
        self.assertIn("upload:puts a program on the robot while it runs", verbs)
        self.assertEqual(self.offered("rsc", "help", ""), verbs)

    def test_options_with_their_values(self):
        options = self.offered("rsc", "check", "--")
        self.assertIn("*--format[human, json or sarif (2.1.0)]:human|json|sarif:(human json sarif)", options)
        self.assertIn("*--config[configuration; else STEM.json, else robot.json beside it]:FILE:_files", options)
        (port,) = [one for one in self.offered("rsc", "upload", "") if one.startswith("*--port")]
        self.assertTrue(port.endswith(":PORT:_rsc_ports"))
        for option in options[1:]:
            self.assertRegex(option, r"^\*(-[-a-zA-Z0-9]+\[([^]\\]|\\.)*\](:.*)?|:FILE:_files)$")

    def test_words_after_a_verb_and_boards(self):
        self.assertEqual(self.offered("rsc", "completion", "")[-1], "1:bash fish zsh:(bash fish zsh)")
        trace = self.offered("rsc", "trace", "")
        self.assertEqual(trace[-2:], ["1:convert:(convert)", "*:FILE:_files"])
        (board,) = [one for one in self.offered("rsc", "flash", "") if one.startswith("*--board")]
        self.assertRegex(board, r":\(b-l475e-iot01a .*microbit-v2.*\)$")

    def test_files_where_a_device_may_stand_too(self):
        for option in self.offered("rsc", "companion", ""):
            if option.startswith(("*--camera", "*--microphone")):
                self.assertTrue(option.endswith(":DEV|FILE:_files"))
        self.assertEqual(sum(one.startswith("*:") for one in self.offered("rsc", "teach", "")), 1)


if __name__ == "__main__":
    unittest.main()

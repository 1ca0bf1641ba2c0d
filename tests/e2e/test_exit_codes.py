"""rsc's exit codes: 1 the program is wrong, 2 wrong usage, 3 something outside is missing."""

import socket
import tempfile
import threading
import unittest
from pathlib import Path

import rsc
from support import CONFIG, PROGRAMS

PAPER = PROGRAMS / "paper.rsl"
# A 0, which ends any earlier bytes on the line, and the frame.
STOP_FRAME = bytes([0, 5, 0x15, 0xFF, 0x79, 0xFF, 0])


class ExitCodes(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="robosync-e2e-")
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def assert_ends(self, code, *arguments, says=""):
        done = rsc.call(*arguments)
        self.assertEqual(done.returncode, code, done.stderr)
        if code:
            self.assertIn(says, done.stderr)
        return done

    def write(self, name, text):
        path = self.folder / name
        path.write_text(text)
        return path

    def test_fine(self):
        self.assert_ends(0, "check", PAPER)
        self.assert_ends(0, "help")
        self.assert_ends(0, "help", "upload")
        self.assert_ends(0, "ports")

    def test_a_wrong_program(self):
        wrong = self.write("wrong.rsl", "WHEN tuch LEVEL < 3\nDO MOVE arms SLOWLY\nEND\n")
        for verb in (["check"], ["compile", "-o", self.folder / "x.rsb"]):
            done = self.assert_ends(1, *verb, wrong, "--config", CONFIG, says="wrong.rsl:1:6")
            self.assertIn("touch", done.stderr)  # did you mean
        self.assertFalse((self.folder / "x.rsb").exists())

    def test_a_wrong_configuration(self):
        config = self.write("wrong.json", '{"sensors": [\n  {"nam": "touch", "type": "VIRTUAL"}]}\n')
        self.assert_ends(1, "check", PAPER, "--config", config, says="wrong.json:2:")
        config = self.write("broken.json", '{"sensors": [')
        self.assert_ends(1, "check", PAPER, "--config", config, says="broken.json:1:")

    def test_several_mistakes_are_all_reported(self):
        wrong = self.write("many.rsl", "WHEN tuch LEVEL < 3\nDO MOVE arms SLOWLY\nEND\n"
                                       "WHEN touch LEVEL < 3N\nDO JUMP arms\nEND\n")
        done = self.assert_ends(1, "check", wrong, "--config", CONFIG, says="many.rsl:1:6")
        self.assertIn("many.rsl:4:", done.stderr)
        self.assertIn("many.rsl:5:", done.stderr)

    def test_modules_that_are_not_there(self):
        for item, word in (("USE mooves", "moves"), ('USE "nowhere.rsl"', "nowhere.rsl")):
            with self.subTest(item=item):
                source = self.write("module.rsl", item + "\n" + PAPER.read_text())
                self.assert_ends(1, "check", source, "--config", CONFIG, says=word)

    def test_not_an_image(self):
        bad = self.write("bad.rsb", "no image at all")
        self.assert_ends(1, "dump", bad, says="bad.rsb")

    def test_wrong_usage(self):
        self.assert_ends(2)
        self.assert_ends(2, "chek", PAPER, says="check")
        self.assert_ends(2, "check", PAPER, "--confg", CONFIG, says="--confg")
        self.assert_ends(2, "upload", PAPER, says="port")

    def test_missing_files(self):
        self.assert_ends(3, "check", "nowhere.rsl", says="nowhere.rsl")
        self.assert_ends(3, "check", PAPER, "--config", "nowhere.json", says="nowhere.json")
        self.assert_ends(3, "compile", PAPER, "-o", "/nowhere/x.rsb", says="/nowhere/x.rsb")

    def test_missing_ports(self):
        for port in ("/dev/nowhere", f"unix:{self.folder}/nowhere"):
            for verb in (["upload", PAPER], ["info"], ["monitor"], ["feed", "touch.LEVEL=1"]):
                with self.subTest(verb=verb[0], port=port):
                    self.assert_ends(3, *verb, "--port", port, says="nowhere")

    def test_nobody_answers(self):
        heard = []
        server = socket.socket(socket.AF_UNIX)
        self.addCleanup(server.close)
        server.bind(str(self.folder / "port"))
        server.listen()

        def listen():
            line, _ = server.accept()
            with line:
                while some := line.recv(100):
                    heard.append(some)

        listener = threading.Thread(target=listen, daemon=True)
        listener.start()
        self.assert_ends(3, "stop", "--port", f"unix:{self.folder}/port",
                         says="It may have stopped all the same")
        listener.join(10)
        self.assertTrue(b"".join(heard).startswith(STOP_FRAME), heard)


if __name__ == "__main__":
    unittest.main()

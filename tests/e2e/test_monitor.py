"""rsc monitor on a terminal: its screen, the effects of its keys on the board, and that it leaves the terminal as it was."""

import os
import re
import signal
import subprocess
import time
import unittest

import rsc
from board import NAME, Board
from support import PROGRAMS, RobotTest

PATIENCE = 20


class Terminal:
    """tmux, a terminal emulator that reports the contents of its screen."""

    def __init__(self, folder, columns=100, rows=40):
        self._tmux = ["tmux", "-S", str(folder / "tmux"), "-f", "/dev/null"]
        self.call("new-session", "-d", "-x", str(columns), "-y", str(rows), "env", "-i", "LANG=C.UTF-8", "TERM=screen",
                  f"PATH={os.environ['PATH']}", f"HOME={folder}", "sh")

    def call(self, *arguments):
        return subprocess.run([*self._tmux, *arguments], check=True, text=True, stdout=subprocess.PIPE,
                              stderr=subprocess.PIPE).stdout

    def screen(self):
        return self.call("capture-pane", "-p")

    def type(self, *keys):
        self.call("send-keys", *keys)

    def resize(self, columns, rows):
        self.call("resize-window", "-x", str(columns), "-y", str(rows))

    def close(self):
        self.call("kill-server")


class Monitor(RobotTest):
    def setUp(self):
        super().setUp()
        self.terminal = Terminal(self.folder)
        self.addCleanup(self.terminal.close)
        self.upload(self.compile(PROGRAMS / "priorities.rsl"))

    def wait_for(self, pattern, missing=None):
        deadline = time.monotonic() + PATIENCE
        while time.monotonic() < deadline:
            screen = self.terminal.screen()
            if re.search(pattern, screen) and (missing is None or not re.search(missing, screen)):
                return screen
            time.sleep(0.1)
        self.fail(f"no {pattern} (or {missing} is there):\n{screen}")

    def start(self, *arguments):
        command = " ".join([str(rsc.TOOL), "monitor", "--port", self.board.port, *arguments])
        self.terminal.type(f"stty -g > {self.folder}/before; {command}; echo ended $?; stty -g > {self.folder}/after",
                           "Enter")

    def has_ended(self, code):
        """Checks that it has ended with this code and has left the terminal as it was."""
        screen = self.wait_for(f"ended {code}", missing="BEHAVIOURS")
        self.wait_for(r"[$#]\s*$")
        before, after = ((self.folder / name).read_text() for name in ("before", "after"))
        self.assertEqual(before, after)
        return screen

    def test_screen(self):
        self.start()
        screen = self.wait_for("load +[0-9.]+ %")
        for part in (NAME, "SENSORS", "BEHAVIOURS", "ACTUATORS", "SAFETY", "LOG", "q quit"):
            self.assertIn(part, screen)
        self.terminal.type("f")
        self.wait_for("reading, such as touch.LEVEL=2")
        self.terminal.type("touch.LEVEL=1", "Enter")
        self.wait_for(r"touch\.LEVEL +1 ")
        self.terminal.type("f", "nobody.LEVEL=1", "Enter")
        self.wait_for("nobody.LEVEL=1: ")
        self.terminal.type("s")
        self.wait_for("STOPPED")
        self.terminal.type("r")
        self.wait_for("resumed", missing="STOPPED")
        self.terminal.type("/", "touch", "Enter")
        self.wait_for("filter: touch", missing="left_arm  ")
        self.terminal.type("/", "Enter")
        self.wait_for("ACTUATORS", missing="filter: ")
        self.terminal.resize(60, 20)
        screen = self.wait_for("more")
        self.assertLessEqual(max(map(len, screen.splitlines())), 60)
        self.terminal.type("Space")
        self.wait_for("PAUSED")
        self.terminal.type("q")
        self.has_ended(0)

    def test_b_goes_back_to_the_program_before(self):
        self.board.stop()
        self.board = Board(self.elf, icount=self.icount, store=self.folder / "store")
        self.addCleanup(self.board.stop)
        hashes = []
        for name in ("paper", "priorities"):
            self.upload(self.compile(PROGRAMS / f"{name}.rsl"), "--trial", "100ms")
            hashes.append(rsc.info(self.board.port)["board"]["program"]["hash"])
        self.start()
        self.wait_for("BEHAVIOURS")
        self.terminal.type("b")
        self.wait_for(f"program {hashes[0]}")
        self.terminal.type("q")
        self.has_ended(0)
        self.assertEqual(rsc.info(self.board.port)["board"]["program"]["hash"], hashes[0])

    def test_it_leaves_the_terminal_as_it_was(self):
        for ending, code in ((signal.SIGTERM, 0), (signal.SIGINT, 0), (signal.SIGQUIT, 0),
                             (signal.SIGSEGV, 128 + signal.SIGSEGV), (signal.SIGABRT, 128 + signal.SIGABRT)):
            with self.subTest(ending):
                self.start()
                self.wait_for("BEHAVIOURS")
                pids = subprocess.run(["pgrep", "-f", f"^{rsc.TOOL} monitor --port {self.board.port}"], check=True,
                                      text=True, stdout=subprocess.PIPE).stdout.split()
                self.assertEqual(len(pids), 1)
                os.kill(int(pids[0]), ending)
                self.has_ended(code)
                self.terminal.type("clear", "Enter")  # for the next run
                self.wait_for(r"[$#]\s*$", missing="ended")

    def test_plain_lines(self):
        self.start("--plain", "--duration", "1s")
        self.wait_for(f"board  {NAME}, up")
        self.assertNotIn("BEHAVIOURS", self.terminal.screen())
        self.has_ended(0)


if __name__ == "__main__":
    unittest.main()

"""Boards in QEMU that play programs, many on each: `player` (player.cpp) is at the line of each."""

import json
import subprocess
import threading

import comparison
from board import FAST, Board, BoardError

PLAYER = comparison.BUILD / "tests/properties/player"
STARTS = 3  # of a board, for one program that it comes to no end with


class Playing:
    """A board that runs, and the player at its line."""

    def __init__(self):
        self._board = Board(icount=FAST)
        try:
            self._player = subprocess.Popen([PLAYER, self._board.port], text=True, stdin=subprocess.PIPE,
                                            stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        except OSError:
            self._board.stop()  # it would run for ever
            raise

    def play(self, image, scenario, end_ms):
        """The lines of its trace, and whether they are "whole"; else why not. BoardError when it has come to no end."""
        try:
            self._player.stdin.write(f"{image} {scenario} {end_ms}\n")
            self._player.stdin.flush()
        except BrokenPipeError:
            pass  # it says why
        lines = []
        for line in self._player.stdout:
            if line.startswith('{"played"'):
                return lines, json.loads(line)["played"]
            lines.append(line.rstrip("\n"))
        raise BoardError(self._player.stderr.read().strip())

    def stop(self):
        self._player.kill()
        self._player.communicate()
        self._board.stop()


class Boards:
    """One for each thread that asks, started when it does."""

    def __init__(self):
        self._of = threading.local()
        self._all = []

    def play(self, image, scenario, end_ms):
        for start in range(STARTS):
            try:
                return self._mine().play(image, scenario, end_ms)
            except BoardError:
                self._end_mine()
                if start + 1 == STARTS:
                    raise

    def _mine(self):
        if getattr(self._of, "playing", None) is None:
            self._of.playing = Playing()
            self._all.append(self._of.playing)
        return self._of.playing

    def _end_mine(self):
        self._of.playing.stop()
        self._all.remove(self._of.playing)
        self._of.playing = None

    def __enter__(self):
        return self

    def __exit__(self, *_):
        for playing in self._all:
            playing.stop()

"""scripts/robot: boots the board, prints its port and runs until it is ended."""

import argparse
import os
import sys
from pathlib import Path

from board import FAST, REAL_TIME, TOUCH, Board, BoardError, end_on_signals


def given_path(path):
    return Path(os.environ.get("INVOKED_FROM", ".")) / path


def arguments():
    parser = argparse.ArgumentParser(prog="scripts/robot")
    line = parser.add_mutually_exclusive_group()
    line.add_argument("--pty", action="store_true")
    line.add_argument("--socket", metavar="PATH", type=given_path)
    parser.add_argument("--fast", action="store_true")
    parser.add_argument("--store", metavar="FILE", type=given_path)
    return parser.parse_args()


def main():
    wanted = arguments()
    end_on_signals()
    try:
        with Board(pty=wanted.pty, serial_path=wanted.socket,
                   icount=FAST if wanted.fast else REAL_TIME, store=wanted.store) as board:
            print(f"\nport: {board.port}      (rsc … --port {board.port})")
            print(f"qmp:  {board.qmp_path}      (qom-set {TOUCH} vout[0]: the touch sensor)")
            print("Ctrl-C ends it.", flush=True)
            board.wait()
            board.check()
    except KeyboardInterrupt:
        return 0
    except BoardError as error:
        print(f"robot: {error}", file=sys.stderr)
        return 3
    return 0


if __name__ == "__main__":
    sys.exit(main())

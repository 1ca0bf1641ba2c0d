"""A board that has kept a program and powers up with it."""

import time
from pathlib import Path

import rsc
from board import FAST, Board
from counting import BenchError


def wait_until_kept(port):
    """Waits until the program has passed its trial; returns the board's report about itself."""
    give_up = time.monotonic() + rsc.TIMEOUT
    while (info := rsc.info(port))["kept"]["state"] != "kept":
        if time.monotonic() > give_up:
            raise BenchError(f"the board does not keep its program: {info['kept']}")
    return info


def store_with(image, folder):
    """The store file of a board that has kept that program."""
    store = Path(folder) / "store"
    with Board(icount=FAST, store=store) as board:
        rsc.run("upload", image, "--port", board.port)
        wait_until_kept(board.port)
    return store

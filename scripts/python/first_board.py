"""scripts/first-board: compares what a board reports over the line with what it should report."""

import argparse
import json
import sys
import tempfile
import time
from pathlib import Path

import rsc

CLOCK_SECONDS = 10
CLOCK_TOLERANCE = 0.01
LOOKS_EVERY = 1  # second
PORT_SECONDS = 15
KEPT_SECONDS = 15  # until a new program is kept: its trial, and writing it
READ = "3s"
ROBOT = """{{"board": "{board}",
 "sensors": [{{"name": "hand", "type": "VIRTUAL", "channels": {{"LEVEL": {{"range": [0, 10]}}}}}}],
 "actuators": [{{"name": "arm", "type": "VIRTUAL", "device": "servo"}}]}}"""
PROGRAM = """WHEN hand LEVEL > 5
DO
  MOVE arm TO 90deg
END
"""


class Table:
    """Rows of a Markdown table, printed as they come."""

    def __init__(self):
        self.failed = 0
        print("| what | should be | is | |\n|---|---|---|---|")

    def row(self, what, should, got, good):
        self.failed += not good
        print(f"| {what} | {should} | {got} | {'ok' if good else '**NOT**'} |", flush=True)

    def equal(self, what, should, got):
        self.row(what, should, got, should == got)


def port_of(board, listed):
    """The port in the list of `rsc ports` on which such a board answers."""
    answering = [one["port"] for one in listed if "port" in one and one["board"] == board]
    if len(answering) != 1:
        raise rsc.RscError(f"{len(answering)} ports at which a {board} answers: name it with --port (`rsc ports`)")
    return answering[0]


def find_port(board):
    """Tries for a while: a board that was just flashed takes a moment to come back."""
    deadline = time.monotonic() + PORT_SECONDS
    while True:
        listed = json.loads(rsc.run("ports", "--format", "json"))
        if any(one["board"] == board for one in listed if "port" in one) or time.monotonic() > deadline:
            return port_of(board, listed)
        time.sleep(LOOKS_EVERY)


def look_at_itself(table, board, port):
    info = rsc.info(port)
    version = rsc.run("--version").split()[-1]
    table.equal("board", board, info["board"]["name"])
    table.equal("firmware", version, info["board"]["firmware"])
    table.equal("last reset", "power", info["status"]["reset_reason"])
    table.equal("threads stopped by a fault", 0, info["status"]["faults"])


def look_at_clock(table, port):
    def now():
        asked = time.monotonic()
        uptime = rsc.info(port)["status"]["uptime_us"] / 1e6
        return (asked + time.monotonic()) / 2, uptime

    begun, before = now()
    time.sleep(CLOCK_SECONDS)
    ended, after = now()
    ratio = (after - before) / (ended - begun)
    table.row("its second, of ours", f"1 ± {CLOCK_TOLERANCE}", f"{ratio:.4f}", abs(ratio - 1) <= CLOCK_TOLERANCE)


def look_at_program(table, board, port, folder):
    (folder / "robot.json").write_text(ROBOT.format(board=board))
    (folder / "robot.rsl").write_text(PROGRAM)
    said = rsc.run("feed", "hand.LEVEL=7", "--upload", folder / "robot.rsl", "--port", port, "--watch", "1s",
                   "--format", "json").splitlines()
    commands = [event for event in map(json.loads, said) if event["event"] == "command"]
    table.equal("commands of a program that a reading makes move once", 1, len(commands))
    rsc.run("stop", "--port", port)
    table.equal("stopped, after `rsc stop`", True, rsc.info(port)["state"]["stopped"])
    rsc.run("resume", "--port", port)
    table.equal("stopped, after `rsc resume`", False, rsc.info(port)["state"]["stopped"])
    look_at_store(table, port)
    late = sum(thread["missed_deadlines"] for thread in rsc.info(port)["threads"])
    table.equal("deadlines that its threads have missed", 0, late)


def look_at_store(table, port):
    deadline = time.monotonic() + KEPT_SECONDS
    while (state := rsc.info(port)["kept"]["state"]) not in ("kept", "no_store") and time.monotonic() < deadline:
        time.sleep(LOOKS_EVERY)
    table.row("the program, after its trial", "kept, or no_store", state, state in ("kept", "no_store"))


def on_board(board):
    """The board's own sensors: (name, channels)."""
    profile = json.loads((rsc.ROOT / "stdlib/boards" / f"{board}.json").read_text("utf-8"))
    devices = rsc.ROOT / "stdlib/devices"
    for name, wiring in profile.get("on_board", {}).items():
        device = json.loads((devices / f"{wiring['device']}.json").read_text("utf-8"))
        if device["kind"] == "sensor":
            yield name, list(device["channels"])


def readings_of(name, channels, board, port, folder):
    """{channel: its readings, in the channel's unit}"""
    (folder / "robot.json").write_text(json.dumps({"board": board, "sensors": [{"name": name, "device": name}]}))
    rules = (f"WHEN {name} {channel} CHANGES\nDO LOG \"{channel}\"\nEND\n" for channel in channels)  # numbers and words
    (folder / "robot.rsl").write_text("".join(rules))
    said = rsc.run("monitor", "--upload", folder / "robot.rsl", "--port", port, "--duration", READ, "--format", "json")
    found = {channel: [] for channel in channels}
    for event in map(json.loads, said.splitlines()):
        if event["event"] == "input":
            found[event["channel"]].append(event["value"])
    return found


def look_at_sensors(table, board, port, folder):
    for name, channels in on_board(board):
        for channel, values in readings_of(name, channels, board, port, folder).items():
            got = f"{min(values)} to {max(values)}, {len(values)} of them" if values else "none"
            table.row(f"readings of `{name} {channel}` in {READ}", "some", got, bool(values))


def main():
    parser = argparse.ArgumentParser(prog="scripts/first-board")
    parser.add_argument("board")
    parser.add_argument("--port")
    parser.add_argument("--no-flash", action="store_true")
    wanted = parser.parse_args()
    try:
        port = wanted.port or find_port(wanted.board)
        rsc.info(port)
        table = Table()
        with tempfile.TemporaryDirectory() as folder:
            look_at_itself(table, wanted.board, port)
            look_at_clock(table, port)
            look_at_program(table, wanted.board, port, Path(folder))
            look_at_sensors(table, wanted.board, port, Path(folder))
    except rsc.RscError as error:
        print(f"first-board: {error}", file=sys.stderr)
        return 3
    print(f"\n{table.failed} not as they should be. What you have to look at yourself: docs/boards.md, "
          "\"First tests\" of this board.")
    return 1 if table.failed else 0


if __name__ == "__main__":
    sys.exit(main())

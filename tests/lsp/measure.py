"""What a keystroke costs the language server in a large program: CPU time, from the change to the diagnostics and the
completion that an editor asks for with it; and its memory.

usage: tests/lsp/measure.py [--lines 10000] [--keys 200] [--rsc build/host/rsc]
"""

import argparse
import tempfile
from pathlib import Path

import client
from client import Server, position, range_of
from programs import ROBOT, large

TYPED = {
    "a rule": "WHEN proximity DISTANCE < 80cm DO MOVE arms SLOWLY\nEND\n",  # most of the time there is a mistake
    "a comment": "% what a person could write about it, in words \n",  # there is none: all passes run
}


def cpu(server):
    """CPU time of the server so far, in ms."""
    return int(Path(f"/proc/{server.process.pid}/schedstat").read_text().split()[0]) / 1e6


def resident(server):
    """KiB."""
    status = Path(f"/proc/{server.process.pid}/status").read_text()
    return int(status.split("VmRSS:")[1].split()[0])


def keystroke(server, program, text, at, key, version):
    server.change(program, version, {"range": range_of(text, at, at), "text": key})
    text = text[:at] + key + text[at:]
    server.at("completion", program, position(text, at + 1))
    server.diagnostics(program, version)
    return text


def measure(lines, keys, typed):
    """(CPU time of each keystroke in ms, KiB after a quarter of them, KiB at the end)."""
    with tempfile.TemporaryDirectory() as folder, Server() as server:
        program = Path(folder) / "robot.rsl"
        (Path(folder) / "robot.json").write_text(ROBOT)
        text = large(lines)
        server.open(program, text)
        assert all(one["severity"] > 1 for one in server.diagnostics(program)), "the program has a mistake"
        middle = text.index("TEST")
        costs, before = [], 0
        for key in range(keys):
            at = middle + key % len(typed)
            if key and at == middle:  # all of it is typed: from the beginning
                server.change(program, 2 * key, {"range": range_of(text, middle, middle + len(typed)), "text": ""})
                text = text[:middle] + text[middle + len(typed):]
                server.diagnostics(program, 2 * key)
            if key == keys // 4:
                before = resident(server)
            start = cpu(server)
            text = keystroke(server, program, text, at, typed[key % len(typed)], 2 * key + 1)
            costs.append(cpu(server) - start)
        return costs, before, resident(server)


def main():
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("--lines", type=int, default=10_000, help="at least 2000")
    options.add_argument("--keys", type=int, default=200)
    options.add_argument("--rsc", default=client.RSC)
    asked = options.parse_args()
    client.RSC = asked.rsc
    if asked.lines < 2000:
        options.error("the program has at least 2000 lines")
    for what, typed in TYPED.items():
        costs, before, after = measure(asked.lines, asked.keys, typed)
        costs.sort()
        print(f"{what}, {asked.keys} keystrokes in {asked.lines} lines: CPU time median {costs[len(costs) // 2]:.1f} ms, "
              f"95 % within {costs[len(costs) * 95 // 100]:.1f} ms, most {costs[-1]:.1f} ms; memory {before} KiB after a "
              f"quarter of them, {after} KiB at the end")


if __name__ == "__main__":
    main()

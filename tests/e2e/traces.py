"""Compares the board with `rsc run`, line by line: same image, same readings, same trace."""

import json

from board import KEEPS_BY_ITSELF, NAME
from support import CONFIG, LineReader, RobotTest, host_trace

# Program time left to get the readings onto the board. In QEMU a board whose time comes from SysTick alone is the slowest: on a busy
# machine six seconds of it last longer than rsc waits for a free place among the board's readings.
FIRST_LEAD_MS = 1_500 if NAME in ("b-l475e-iot01a", "nucleo-l476rg") else 6_000
AFTER_MS = 12_000  # program time in which everything that was started ends
PATIENCE = 60  # seconds for the board to get there, on a loaded machine
CHIPS = ("pca9685", "ssd1306")  # QEMU's buses have none of them, and a simulation does not use them
QUIET = 0.5  # seconds in which no extra line may come
# The board's virtual time does not wait for this machine: a busy one may feed too late, or lose
# events because it reads too late. The board reports that, and the test tries again.
ATTEMPTS = 8


class TraceTest(RobotTest):
    """Runs a program on both with the same readings."""

    def check(self, program, readings, config=CONFIG):
        lines, expected, errors = self.run_both(program, readings, config)
        self.maxDiff = 4000
        self.assertEqual(lines, expected, errors)
        return lines

    def run_both(self, program, readings, config):
        """(the board's lines, the host's, what rsc said of the board)."""
        image = self.compile(program, config)
        lead_ms = FIRST_LEAD_MS
        for _ in range(ATTEMPTS):
            if NAME in KEEPS_BY_ITSELF:
                self.restart()  # without a kept program, to which it would go back when SAFETY trips in a trial
            scenario = self.write_scenario(readings, lead_ms)
            until_ms = lead_ms + readings[-1].at_ms + AFTER_MS
            expected = host_trace(image, scenario, until_ms)
            lost_before = self.status()["lost_events"]
            lines, errors = self.board_trace(image, scenario, len(expected), until_ms)
            lost = self.status()["lost_events"] - lost_before
            if "already past" in errors:
                lead_ms *= 3
            elif lost == 0 and "has fallen silent" not in errors:  # it has answered since: QEMU stood still
                break
        self.assertEqual(lost, 0, "this machine is too busy to read the board's trace")
        self.assertGreater(len(expected), len(set(r.at_ms for r in readings)) // 2)
        return lines, expected, errors

    def board_trace(self, image, scenario, count, until_ms):
        """The board's lines from activation on; expects `count`, then waits briefly for extra ones."""
        # In the worst case a drawn program may be too slow for the board; with these readings it is not.
        reader = LineReader("feed", "--upload", image, "--anyway", "--fresh", "--scenario", scenario, "--port",
                            self.board.port, "--watch", f"{2 * PATIENCE}s", "--format", "json")
        reader.wait_for(lambda lines: len(own(lines)) >= count, PATIENCE)
        reader.wait_for(lambda lines: len(own(lines)) > count, QUIET)
        errors = reader.stop()
        # Some programs go on for ever.
        lines = [line for line in own(reader.lines) if json.loads(line)["t_us"] <= until_ms * 1000]
        return lines, errors


def own(lines):
    """Removes the lines of the program before, and reports that a chip does not answer."""
    starts = [i for i, line in enumerate(lines) if '"event":"activated"' in line]
    mine = lines[starts[0]:] if starts else []
    return [line for line in mine if not ('"event":"silent"' in line and any(f'"sensor":"{chip}"' in line for chip in CHIPS))]

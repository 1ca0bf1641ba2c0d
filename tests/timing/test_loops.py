"""What programs that go round by themselves take of the processor, counted on the Cortex-M4, against what `rsc check --timing`
says that they take: a program that goes round more often than is said would starve the board unnoticed."""

import json
import subprocess
import tempfile
import unittest
from pathlib import Path

import paths

TICKS = 3000
FOREVER = "WHEN m IS on DO\nREPEAT FOREVER\n{}\nEND\nEND"
WHILE = "WHILE m IS on DO\n{}\nEND"
EVERY = "EVERY 7ms DO\n{}\nEND"
TAKES = 'BEHAVIOR takes PRIORITY 60\nEVERY 5ms DO\nMOVE a0 FOR 1ms\nEND\nEND\n'
AT_ONCE, SHORT = "MOVE a0 FOR 0ms", "MOVE a0 FOR 1ms"
EIGHT = "\n".join([SHORT] * 8)

LOOPS = {
    "THEN after what is done at once": FOREVER.format(f"{AT_ONCE}\nTHEN"),
    "THEN after a millisecond": FOREVER.format(f"{SHORT}\nTHEN"),
    "THEN after a queue of short commands": FOREVER.format(f"{EIGHT}\nTHEN"),
    "WAIT UNTIL of what is true": FOREVER.format(f"WAIT UNTIL m IS on\n{SHORT}"),
    "two WAIT UNTILs": FOREVER.format(f"WAIT UNTIL m IS on\n{SHORT}\nWAIT UNTIL m IS on WITHIN 1ms\n{SHORT}"),
    "a WAIT of a millisecond": FOREVER.format(f"WAIT 1ms\n{SHORT}"),
    "a WHILE that takes no time": WHILE.format('LOG "x"'),
    "a WHILE whose variable another rule reads": WHILE.format("RAISE x BY 1") + "\nWHEN x > 5 AND x < 100 DO\nRAISE y BY 1\nEND",
    "a WHILE of a short command": WHILE.format(SHORT),
    "a WHILE that waits a millisecond": WHILE.format(f"{SHORT}\nWAIT 1ms"),
    "a WHILE that works before and after its WAIT": WHILE.format(f"{SHORT}\nRAISE x BY 1\nWAIT 2ms\nRAISE y BY 1\n{SHORT}"),
    "a WHILE that may miss its WAIT": WHILE.format("IF x > 5 DO\nWAIT 1s\nEND\nRAISE y BY 1\n" + SHORT),
    "an EVERY that waits": EVERY.format(f"{SHORT}\nWAIT 6ms\n{SHORT}"),
    "a WHILE that loses its actuator again and again": TAKES + "BEHAVIOR loses PRIORITY 40\n" +
                                                       WHILE.format("MOVE a0 FOR 1s") + "\nEND",
}
DECLARED = "STATE m: off, on\nREMEMBER x = 0\nREMEMBER y = 0\nAT START DO\nSET m TO on\nEND\n"
NOTHING = "AT START DO\nSET m TO off\nEND"


def said_and_taken(rules):
    """Instructions in a millisecond."""
    with tempfile.TemporaryDirectory(prefix="robosync-loops-") as folder:
        source, image = Path(folder) / "p.rsl", Path(folder) / "p.rsb"
        source.write_text(DECLARED + rules + "\n")
        config = source.with_suffix(".json")
        config.write_text(json.dumps(paths.robot()))
        checked = subprocess.run([paths.RSC, "check", "--timing", source, "--config", config, "--format", "json"],
                                 check=False, capture_output=True, text=True)
        timing = json.loads(checked.stdout)["timing"][0]["responses"]
        paths.compiled(source, config, image)
        taken = sum(paths.Run(image, [paths.wait(TICKS)]).ticks) / TICKS
        return timing["utilization"] * timing["instructions_per_ms"], taken


class Loops(unittest.TestCase):
    def test_a_loop_takes_no_more_than_is_said(self):
        said_of_nothing, taken_by_nothing = said_and_taken(NOTHING)
        for name, rules in LOOPS.items():
            with self.subTest(name):
                said, taken = said_and_taken(rules)
                said, taken = said - said_of_nothing, taken - taken_by_nothing
                print(f"\n  {name}: {taken:.0f} instructions in a millisecond, said {said:.0f}", end="")
                self.assertGreater(taken, 20)
                self.assertLessEqual(taken, said)


if __name__ == "__main__":
    unittest.main()

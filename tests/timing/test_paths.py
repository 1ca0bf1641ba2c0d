"""The costs that `rsc check --timing` works out response times with (rsc/response_costs.hpp) against what
the Cortex-M4 executes, and the response times of examples against what a reading takes."""

import json
import re
import struct
import subprocess
import tempfile
import unittest
from pathlib import Path

import timing
from timing import ROOT

import counting

RSC = ROOT / "build/host/rsc"
FIRMWARE = ROOT / "build/m4/bench/path.elf"
TABLE = ROOT / "rsc/response_costs.hpp"
DEVICES = ["-device", "max34451,id=touch,address=0x70", "-device", "tmp105,address=0x48"]
POST = "robosync::layers::Mailboxes::post("
LOW, STILL_LOW, HIGH = 10_000, 20_000, 90_000  # thousandths; the rules look for more than 80
LOOSEST = 1.25  # a cost of the table is at most this many times what was measured, and 60 more
SLACK = 60


def costs():
    found = re.findall(r"constexpr std::uint32_t (k\w+) = ([\d']+);", TABLE.read_text())
    return {name: int(value.replace("'", "")) for name, value in found}


def robot(actuators):
    return {"sensors": [{"name": "s", "type": "VIRTUAL", "channels": {"c0": {"range": [0, 100]}}}],
            "actuators": [{"name": f"a{i}", "type": "VIRTUAL"} for i in range(actuators)]}


def behaviors(count, rules=1, body="LOG \"x\"", when="s c0 > 80"):
    lines = []
    for b in range(count):
        lines.append(f"BEHAVIOR b{b} PRIORITY {90 - b}")
        for _ in range(rules):
            lines += [f"  WHEN {when}", "  DO", *(f"    {line}" for line in body.splitlines()), "  END"]
        lines.append("END")
    return "\n".join(lines) + "\n"


def spans(text, actuators=4):
    """Instructions of a reading that fires nothing, and of one that fires all."""
    with tempfile.TemporaryDirectory(prefix="robosync-paths-") as folder:
        source, image = Path(folder) / "p.rsl", Path(folder) / "p.rsb"
        source.write_text(text)
        source.with_suffix(".json").write_text(json.dumps(robot(actuators)))
        subprocess.run([RSC, "compile", source, "-o", image, "--strip"], check=True,
                       capture_output=True)
        feeds = [value for reading in (LOW, STILL_LOW, HIGH) for value in (0, reading)]
        marks = counting.run_given(FIRMWARE, image, feeds)
    _, idle, firing = marks.spans("mark_feed_begin", "mark_feed_end")
    return idle, firing


def move(actuator):
    return f"MOVE a{actuator} TO 1% OVER 10ms"


class Table(unittest.TestCase):
    """Each cost by the difference of two programs."""

    def setUp(self):
        self.costs = costs()

    def assert_covers(self, name, measured):
        self.assertGreaterEqual(self.costs[name], measured, name)
        self.assertLessEqual(self.costs[name], LOOSEST * measured + SLACK, name)

    def test_a_rule_and_a_behavior(self):
        one, two, apart = (spans(behaviors(*how))[0] for how in ((1, 1), (1, 2), (2, 1)))
        condition = 14 + 15  # gt_k, ret
        rule = two - one - condition
        self.assert_covers("kRule", rule)
        behavior = apart - one - rule - condition
        self.assert_covers("kBehavior", behavior)
        self.assert_covers("kStep", one - rule - condition - behavior)

    def test_what_a_rule_does_that_fires(self):
        idle, text = spans(behaviors(1))
        texts = spans(behaviors(1, body='LOG "x"\nLOG "y"'))[1]
        self.assert_covers("kText", texts - text)
        self.assert_covers("kFire", text - idle - (texts - text))

    def test_commands(self):
        one, other, queued = (spans(behaviors(1, body=body))[1] for body in
                              (move(0), f"{move(0)}\n{move(1)}", f"{move(0)}\n{move(0)}"))
        self.assertGreaterEqual(self.costs["kCommand"], other - one)
        self.assert_covers("kQueued", queued - one)


class Paths(unittest.TestCase):
    def test_no_reading_takes_longer_to_its_command_than_is_said(self):
        ticks = {name: at for name, at in counting.symbols(FIRMWARE).items()
                 if name.startswith((POST, "robosync::drivers::servo::start(")) or
                 name == "SysTick_Handler"}
        program = ROOT / "examples/touch_companion/robot.rsl"
        said = json.loads(subprocess.run([RSC, "check", "--timing", program, "--format", "json"],
                                         check=True, capture_output=True, text=True).stdout)
        bound = min(path["base"]["instructions"]
                    for path in said["timing"][0]["responses"]["paths"])
        with tempfile.TemporaryDirectory(prefix="robosync-paths-") as folder:
            image, none = Path(folder) / "p.rsb", Path(folder) / "none"
            subprocess.run([RSC, "compile", program, "-o", image], check=True, capture_output=True)
            none.write_bytes(struct.pack("<i", 0))
            marks = counting.run(FIRMWARE, counting.loaded(image, counting.IMAGE_ADDRESS)
                                 + counting.loaded(none, counting.READINGS_ADDRESS) + DEVICES, ticks)
        worst = due = tick = 0
        for name, count in marks.all:
            if name == "SysTick_Handler":
                tick = count
            elif name.startswith(POST):
                due = tick
            elif "servo" in name:
                worst = max(worst, count - due)
        print(f"\n  touch_companion: from the tick to the last arm {worst} instructions, said {bound}")
        self.assertGreater(worst, 0)
        self.assertLessEqual(worst, bound)



if __name__ == "__main__":
    unittest.main()

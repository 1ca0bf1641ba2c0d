"""The large profile on the board: 64 behaviours, 1,000 rules and 64 KB arrive over the link and run."""

import json
import subprocess
import unittest

import rsc
from board import ROOT
from support import LineReader, RobotTest, host_trace

FIRMWARE = ROOT / "build/m4/robosync-large.elf"
TOOL = ROOT / "build/host/rsc-large"
RULES, BEHAVIORS, CHANNELS = 1000, 64, 32
FIRST_VALUE = 10  # 0 means nothing to any rule


def channel_of(rule):
    return f"s{rule % CHANNELS // 8}", f"C{rule % CHANNELS}"


def value_of(rule):
    return FIRST_VALUE + rule // CHANNELS


def program():
    """Rule r fires when its channel, one of 32, has the value that is its own."""
    text = ""
    for b in range(BEHAVIORS):
        text += f"BEHAVIOR b{b} PRIORITY {90 - b}\n"
        for r in range(RULES * b // BEHAVIORS, RULES * (b + 1) // BEHAVIORS):
            sensor, channel = channel_of(r)
            text += (f"  WHEN {sensor} {channel} = {value_of(r)} DO\n"
                     f'    LOG "{r} is what fired"\n  END\n')
        text += "END\n"
    return text


def config():
    sensors = [{"name": f"s{s}", "type": "VIRTUAL",
                "channels": {f"C{c}": {"range": [0, 1000]} for c in range(8 * s, 8 * s + 8)}}
               for s in range(CHANNELS // 8)]
    return {"sensors": sensors,
            "actuators": [{"name": "a", "type": "VIRTUAL", "device": "virtual_actuator"}]}


class Large(RobotTest):
    elf = FIRMWARE

    def compile_large(self):
        source, robot = self.folder / "large.rsl", self.folder / "robot.json"
        source.write_text(program())
        robot.write_text(json.dumps(config()))
        return self.compile(source, robot)

    def test_one_reading_fires_one_rule(self):
        image = self.compile_large()
        self.assertGreater(image.stat().st_size, 60_000)
        self.upload(image)
        everything_known = [f"{s}.{c}=0" for s, c in map(channel_of, range(CHANNELS))]
        rsc.run("feed", *everything_known, "--port", self.board.port)
        for rule in (0, 255, 256, 517, 999):
            with self.subTest(rule=rule):
                sensor, channel = channel_of(rule)
                reader = LineReader("feed", f"{sensor}.{channel}={value_of(rule)}", "--port",
                                    self.board.port, "--watch", "20s", "--format", "json")
                reader.wait_for(lambda lines: any('"finished"' in line for line in lines), 20)
                errors = reader.stop()
                fired = [json.loads(line)["rule"] for line in reader.lines if '"event":"fire"' in line]
                self.assertEqual(len(fired), 1, errors)
                text = "\n".join(reader.lines)
                self.assertIn(f"{rule} is what fired", text)
        self.assertEqual(self.status()["faults"], 0)
        for thread in rsc.info(self.board.port)["threads"]:
            self.assertLess(thread["stack_used"], thread["stack_bytes"], thread)

    def test_the_host_runs_it_with_the_same_limits(self):
        image = self.compile_large()
        scenario = self.folder / "scenario.json"
        sensor, channel = channel_of(517)
        scenario.write_text(json.dumps({"stimuli": [
            {"at": "10ms", "sensor": sensor, "channel": channel, "value": f"{value_of(517)}"}]}))
        arguments = ["run", image, "--scenario", scenario, "--duration", "100ms", "--format", "json"]
        lines = subprocess.run([TOOL, *arguments], check=True, text=True, stdout=subprocess.PIPE,
                               timeout=rsc.TIMEOUT).stdout
        self.assertEqual(lines.count('"event":"fire"'), 1)
        self.assertIn("517 is what fired", lines)
        with self.assertRaises(rsc.RscError):  # the standard profile is for 40 rules
            host_trace(image, scenario, 100)


if __name__ == "__main__":
    unittest.main()

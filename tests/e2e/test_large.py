"""Large programs on the shipped firmware: 32 servos, 40 behaviours and 1,000 rules (fewer servos on a board with less memory) arrive
over the link and react on the board as on the host. A program that is too large is refused with the numbers."""

import json
import re
import unittest

import rsc
from board import NAME
from support import OUTPUTS, PROFILE, SEED, LineReader, RobotTest, host_trace

FIRST_VALUE = 10  # 0 means nothing to any rule
CHANNELS = 8
MOST_SERVOS = 32 if PROFILE["arena"]["bytes"] == 112 * 1024 else 20


def servos(count):
    """On pins; those for which the board has no pin are virtual."""
    return [{"name": f"arm{i}", "range": ["0deg", "120deg"],
             **({"type": "PWM", "pin": OUTPUTS[i], "device": "servo"} if i < len(OUTPUTS) else {"type": "VIRTUAL", "device": "joint"})}
            for i in range(count)]


def config(actuators):
    return {"board": NAME,
            "sensors": [{"name": "near", "type": "VIRTUAL",
                         "channels": {f"c{i}": {"range": [0, 1000]} for i in range(CHANNELS)}}],
            "actuators": servos(actuators), "lints": {"W0209": "allow"}}


def program(rules, behaviors, actuators):
    """Rule r moves one arm when its channel has the rule's own value."""
    lines = []
    for b in range(behaviors):
        lines.append(f"BEHAVIOR b{b} PRIORITY {90 - b}")
        for r in range(rules * b // behaviors, rules * (b + 1) // behaviors):
            lines.append(f"  WHEN near c{r % CHANNELS} = {FIRST_VALUE + r // CHANNELS} DO\n"
                         f"    MOVE arm{r % actuators} TO {r % 100}deg\n  END")
        lines.append("END")
    return "\n".join(lines) + "\n"


def reading(rule):
    return f"near.c{rule % CHANNELS}", FIRST_VALUE + rule // CHANNELS


class Large(RobotTest):
    def write_large(self, rules, behaviors, actuators):
        source, robot = self.folder / "large.rsl", self.folder / "robot.json"
        source.write_text(program(rules, behaviors, actuators))
        robot.write_text(json.dumps(config(actuators)))
        return source, robot

    def compile_large(self, rules, behaviors, actuators):
        source, robot = self.write_large(rules, behaviors, actuators)
        image = self.folder / "large.rsb"
        rsc.run("compile", source, "--config", robot, "-o", image, "--strip", "--anyway", "--seed", SEED)
        return image

    def fired_on_the_board(self, rule):
        channel, value = reading(rule)
        reader = LineReader("feed", f"{channel}={value}", "--port", self.board.port, "--watch", "20s",
                            "--format", "json")
        reader.wait_for(lambda lines: any('"command"' in line for line in lines), 20)
        errors = reader.stop()
        events = [json.loads(line) for line in reader.lines]
        return [e["rule"] for e in events if e["event"] == "fire"], errors

    def check_reacts(self, rules, behaviors, actuators, some):
        self.upload(self.compile_large(rules, behaviors, actuators), "--anyway")
        rsc.run("feed", *(f"near.c{c}=0" for c in range(CHANNELS)), "--port", self.board.port)
        for rule in some:
            with self.subTest(rule=rule):
                fired, errors = self.fired_on_the_board(rule)
                self.assertEqual(len(fired), 1, errors)
        self.assertEqual(self.status()["faults"], 0)
        memory = rsc.info(self.board.port)["board"]["memory"]
        self.assertEqual(sum(memory["by"].values()), memory["used"])  # the host's count equals the board's
        for thread in rsc.info(self.board.port)["threads"]:
            self.assertLess(thread["stack_used"], thread["stack_bytes"], thread)

    def test_1000_rules_in_40_behaviors_with_many_servos(self):
        self.check_reacts(1000, 40, MOST_SERVOS, (0, 17, 255, 256, 517, 999))

    def test_1000_rules_in_50_behaviors(self):
        self.check_reacts(1000, 50, 2, (0, 255, 256, 517, 999))

    def test_the_host_runs_it_as_well(self):
        image = self.compile_large(1000, 50, 2)
        scenario = self.folder / "scenario.json"
        channel, value = reading(517)
        sensor, channel = channel.split(".")
        scenario.write_text(json.dumps({"stimuli": [
            {"at": "10ms", "sensor": sensor, "channel": channel, "value": f"{value}"}]}))
        lines = "\n".join(host_trace(image, scenario, 100))
        self.assertEqual(lines.count('"event":"fire"'), 1)

    def test_what_is_too_large_is_refused_with_both_numbers(self):
        """rsc refuses a program before it sends it; an image is refused in the same way by the simulator, and on the line (3)."""
        source, robot = self.write_large(1000, 60, 32)
        image = self.compile_large(1000, 60, 32)
        port = ["--port", self.board.port]
        told = set()
        for code, arguments in ((1, ["check", source, "--config", robot]), (1, ["upload", source, "--config", robot, *port]),
                                (1, ["run", image]), (3, ["upload", image, "--anyway", *port])):
            with self.subTest(arguments=arguments[:2]):
                done = rsc.call(*arguments)
                self.assertEqual(done.returncode, code)
                told |= set(re.findall(r"the program needs \d+ bytes of memory, the board has \d+ for programs; "
                                       r"most of it is for \w+", done.stderr))
        self.assertEqual(len(told), 1, told)


if __name__ == "__main__":
    unittest.main()

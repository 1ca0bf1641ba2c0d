"""The board and `rsc run` do the same, bit for bit, with the programs in this folder and with random ones."""

import itertools
import json
import unittest

from support import PROGRAMS  # also makes the imports below work
from traces import CONFIG, TraceTest

import rsc
import stimuli
from generator import TOO_LARGE, Generator


class Traces(TraceTest):
    def test_the_papers_program(self):
        lines = self.check(PROGRAMS / "paper.rsl", stimuli.touch(0, 1, 2, 3, 4, 5, 2, 2, 10, 0))
        text = "\n".join(lines)
        for wanted in ("greeting.wav", "warning.wav", "SLOWLY", "QUICKLY", '"side":"ELSE"'):
            self.assertIn(wanted, text)

    def test_priorities_and_interruption(self):
        lines = self.check(PROGRAMS / "priorities.rsl", stimuli.PRIORITIES)
        events = {event for line in lines for event in ("interrupt", "lose", "cancel", "finished")
                  if f'"event":"{event}"' in line}
        self.assertEqual(events, {"interrupt", "lose", "cancel", "finished"})

    def test_conditions(self):
        program = PROGRAMS / "conditions.rsl"
        self.check(program, stimuli.drawn(1, program.read_text()))

    def test_arithmetic(self):
        program = PROGRAMS / "arithmetic.rsl"
        self.check(program, stimuli.drawn(2, program.read_text(), count=60))

    def test_adaptive_priorities(self):
        """Ranks change, and change back, at the same tick on both."""
        config = self.folder / "adapting.json"
        robot = json.loads((PROGRAMS / "robot.json").read_text("utf-8"))
        robot["scheduler"] = {"alpha": 20, "window": "500ms"}
        config.write_text(json.dumps(robot))
        lines = self.check(PROGRAMS / "priorities.rsl", stimuli.PRIORITIES, config)
        changes = [json.loads(line) for line in lines if '"event":"priority"' in line]
        self.assertGreater(len(changes), 2)
        self.assertTrue(all(change["t_us"] % 500_000 == 0 for change in changes))
        last = {change["behavior"]: change for change in changes}
        self.assertTrue(all(change["priority"] == change["base"] for change in last.values()))
        self.check_drawn(4, config)

    def check_drawn(self, count, config):
        for seed in range(count):
            with self.subTest(seed=seed):
                program = self.folder / f"drawn{seed}.rsl"
                text = Generator(seed).program()
                program.write_text(text)
                self.check(program, stimuli.drawn(seed, text), config)

    def test_ramps(self):
        """Movements with a limit of acceleration, also those that replace each other, end in the same microsecond."""
        config = self.folder / "ramps.json"
        robot = json.loads((PROGRAMS / "robot.json").read_text("utf-8"))
        for arm, acceleration in zip(robot["actuators"], ("300deg/s2", "90deg/s2")):
            arm["limits"] = arm.get("limits", {}) | {"ACCELERATION": acceleration}
        config.write_text(json.dumps(robot))
        with_ramps, without = (self.check(PROGRAMS / "priorities.rsl", stimuli.PRIORITIES, *given) for given in ((config,), ()))
        done = [[json.loads(line)["t_us"] for line in lines if '"event":"done"' in line] for lines in (with_ramps, without)]
        self.assertNotEqual(*done)
        self.check_drawn(6, config)

    def test_algorithms(self):
        """The firmware's modules, with synthetic recordings: the board's modules run behind its MPU."""
        for name, units, recording, words in (
                ("feeling", stimuli.FEELING_UNITS, stimuli.touches, {"tap", "pat", "stroke", "firm"}),
                ("moving", stimuli.MOVING_UNITS, stimuli.motions,
                 {"shaken", "tapped", "falling", "lifted", "left", "jerked"}),
                ("hearing", stimuli.HEARING_UNITS, stimuli.sounds, {"clap", "speech", "sound", "loud"}),
                ("singing", stimuli.HEARING_UNITS, stimuli.songs,
                 {"la", "whistle", "up", "down", "in tune", "melody", "silence"})):
            with self.subTest(name):
                self.units = units
                lines = self.check(PROGRAMS / f"{name}.rsl", recording(0), PROGRAMS / f"{name}.json")
                said = {json.loads(line).get("word") for line in lines if '"event":"command"' in line}
                self.assertLessEqual(words, said)

    def test_words(self):
        """own_words works for longer than a tick on a word, so this comes a few milliseconds later on the board, in the same 20 ms."""
        self.units = stimuli.LISTENING_UNITS
        lines, expected, errors = self.run_both(PROGRAMS / "listening.rsl", stimuli.words(0), PROGRAMS / "listening.json")

        def words(told):
            events = (json.loads(line) for line in told)
            return [(event["t_us"] // 20_000, event["value"]) for event in events
                    if event["event"] == "input" and event["channel"] == "WORD" and event["value"] is not None]
        self.assertEqual(words(lines), words(expected), errors)
        self.assertEqual({word for _, word in words(lines)}, {*stimuli.SPOKEN, "none"})

    def test_the_words_that_it_listens_for_are_those_that_are_said(self):
        self.assertEqual((PROGRAMS / "listening.words").read_text(), stimuli.words_file())

    def test_drawn_programs(self):
        seeds = itertools.islice(filter(self.draw, itertools.count()), 12)
        for seed in seeds:
            with self.subTest(seed=seed):
                program = self.drawn(seed)
                self.check(program, stimuli.drawn(seed, program.read_text()))

    def drawn(self, seed):
        return self.folder / f"drawn{seed}.rsl"

    def draw(self, seed):
        """Draws a random program; False if it is too large for a robot."""
        program = self.drawn(seed)
        program.write_text(Generator(seed).program())
        return TOO_LARGE not in rsc.call("check", "--config", self.for_board(CONFIG), program).stderr


if __name__ == "__main__":
    unittest.main()

"""What `rsc check --timing` says is never less than what the Cortex-M4 executes, nor much more."""

import os
import statistics
import unittest

import timing

PROGRAMS = int(os.environ.get("ROBOSYNC_TIMING_PROGRAMS", "300"))
LOOSEST = 2.0  # an example's bound is at most this many times the worst that was seen
EXAMPLE_STEPS = 2000
NEAR = 5  # instructions: entering and leaving the VM, measured here and in bench/, differs by a few


class Tally:
    """What was seen of many programs."""

    def __init__(self):
        self.programs, self.over, self.used = 0, [], []
        self.parts = self.near = 0
        self.opcodes = set()

    def add(self, program):
        self.programs += 1
        self.over += program.over()
        self.opcodes |= program.opcodes
        self.used.append(program.step.worst / program.step.bound)
        parts = [part for part in program.parts() if part.worst]
        self.parts += len(parts)
        self.near += sum(part.bound - part.worst <= NEAR for part in parts)

    def __str__(self):
        unseen = ", ".join(sorted(timing.opcodes() - self.opcodes)) or "none"
        return (f"{self.programs} programs: a step took at most {max(self.used):.3f} of what was said, "
                f"the median program's worst {statistics.median(self.used):.3f}; of {self.parts} "
                f"conditions, responses and steps {self.near} came within {NEAR} instructions of it, "
                f"{len(self.over)} took more\n  opcodes that stand in none of them: {unseen}")


class Bounds(unittest.TestCase):
    def test_no_random_program_takes_more_than_was_said(self):
        tally = Tally()
        for programs in timing.measure_random(PROGRAMS):
            for program in programs:
                tally.add(program)
            self.assertEqual(tally.over, [])
        print(f"\n  {tally}")
        self.assertEqual(tally.programs, PROGRAMS)
        # A bound that nothing comes near would prove little.
        self.assertGreater(tally.near, tally.parts // 3)
        self.assertGreater(max(tally.used), 0.9)

    def test_the_examples_take_at_least_half_of_what_was_said(self):
        print(f"\n  {'example':18}{'bound':>7}{'scenario':>10}{'random':>8}{'bound/worst':>13}")
        examples = list(timing.examples())
        acted = timing.measure([f"{program}:{scenario}" if scenario else program
                                for program, scenario in examples], steps=0)
        drawn = timing.measure([program for program, _ in examples], EXAMPLE_STEPS)
        for (program, scenario), real, random in zip(examples, acted, drawn, strict=True):
            with self.subTest(program=program.parent.name):
                worst = max(real.step.worst, random.step.worst)
                print(f"  {program.parent.name:18}{real.step.bound:>7}{real.step.worst or '–':>10}"
                      f"{random.step.worst:>8}{real.step.bound / worst:>13.2f}")
                self.assertEqual(real.over() + random.over(), [])
                self.assertEqual(real.step.worst > 0, scenario is not None)
                self.assertLessEqual(real.step.bound, LOOSEST * worst)

    def test_one_instruction_more_is_noticed(self):
        programs = timing.measure([program for program, _ in timing.examples()], steps=50)
        for program in programs:
            for part in program.parts():
                if part.worst:
                    part.bound = part.worst - 1
                    self.assertEqual(len(program.over()), 1, part.name)
                    part.bound = part.worst


if __name__ == "__main__":
    unittest.main()

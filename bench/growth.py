"""What idle rules cost: a step in which one reading concerns one rule, among more and more of them. Also images at the
limits of the format, verified and loaded."""

import json
import tempfile
from pathlib import Path

import rsc
from counting import BUILT, BenchError, run_given

ABOVE, BELOW, LOWER = 60_000, 40_000, 30_000  # thousandths: the rule's threshold is between the first two
READINGS = (ABOVE, BELOW, LOWER) * 3
RULES = (10, 20, 40, 100, 300, 1000)
FEW_RULES = 40  # up to this many are in 10 behaviours and 8 channels; more are in as many as the format allows
ACTUATORS = 2
FIRMWARE = BUILT / "bench_step.elf"
COMMANDS_OF_64K = 2540  # for 1,000 rules, so that their image is just below 64 KB


def robot(channels, actuators):
    """robot.json as an object: one fed sensor, and some actuators, all virtual."""
    return {
        "sensors": [{"name": "s", "type": "VIRTUAL",
                     "channels": {f"c{i}": {"range": [0, 100]} for i in range(channels)}}],
        "actuators": [{"name": f"a{i}", "type": "VIRTUAL"} for i in range(actuators)],
        "lints": {"W0209": "allow"},
    }


def program(rules, behaviors, channels, actuators, commands):
    """RSL: rules are spread evenly over behaviours, and commands over the rules. Each rule has its own response. Only
    the rule in the middle reads channel c0."""
    lines, rule, middle = [], 0, rules // 2
    for behavior in range(behaviors):
        lines.append(f"BEHAVIOR b{behavior} PRIORITY {99 - behavior}")
        while rule * behaviors < (behavior + 1) * rules:
            channel = 0 if rule == middle else 1 + rule % (channels - 1)
            limit = 50 if rule == middle else 1 + rule % 90
            lines += [f"  WHEN s c{channel} > {limit}", "  DO"]
            mine = (rule + 1) * commands // rules - rule * commands // rules
            lines += [f"    MOVE a{rule % actuators} TO {limit}.{rule:03}% OVER 10ms"] * mine
            lines.append("  END")
            rule += 1
        lines.append("END")
    return "\n".join(lines) + "\n"


def behaviors_of(rules):
    return 10 if rules <= FEW_RULES else 64


def compiled(folder, rules, commands=None):
    channels = 8 if rules <= FEW_RULES else 32
    source = Path(folder) / f"grown_{rules}.rsl"
    source.write_text(program(rules, behaviors_of(rules), channels, ACTUATORS, commands or rules))
    source.with_suffix(".json").write_text(json.dumps(robot(channels, ACTUATORS)))
    image = source.with_suffix(".rsb")
    rsc.run("compile", source, "-o", image, "--strip", "--anyway")
    return image


class Steps:
    """Instructions for loading an image; for the most expensive step in which a channel has its first reading (a
    behaviour then evaluates all of its rules); for the most expensive later step; and for the most expensive ones that
    fire nothing, where the reading crosses a rule's threshold and where it crosses none."""

    def __init__(self, elf, image):
        marks = run_given(elf, image, READINGS)
        wanted = [[1, 1] if reading == ABOVE else [0, 0] for reading in READINGS]
        if marks.heard("step") != wanted:
            raise BenchError(f"{image.stem}: rules fired and commands were {marks.heard('step')}, "
                             f"not {wanted}")
        self.load = marks.spans("mark_load_begin", "mark_load_end")[0]
        self.first = max(marks.spans("mark_first_begin", "mark_first_end"))
        later = marks.spans("mark_step_begin", "mark_step_end")
        self.later = max(later)
        self.quiet_crossing, self.quiet = (max(count for count, reading in zip(later, READINGS) if reading == kind)
                                           for kind in (BELOW, LOWER))


def verify_cost(image):
    """Instructions of the verifier per word of the image."""
    marks = run_given(BUILT / "bench_workload", image)
    words = image.stat().st_size // 4
    return round(marks.spans("mark_verify_begin", "mark_verify_end")[0] / words, 1)


def growth_between(steps, few, many):
    """How much more a step costs among `many` rules than among `few` in as many behaviours, as a factor."""
    return round(steps[many].later / steps[few].later, 3)


def growth_figures():
    with tempfile.TemporaryDirectory() as folder:
        steps = {rules: Steps(FIRMWARE, compiled(folder, rules)) for rules in RULES}
        largest = compiled(folder, RULES[-1], COMMANDS_OF_64K)
        load_64k = Steps(FIRMWARE, largest).load
        size, verify = largest.stat().st_size, verify_cost(largest)
    return {
        **{f"path/step_{rules}_rules": (step.later, "insn") for rules, step in steps.items()},
        "path/step_quiet": (steps[10].quiet, "insn"),
        "path/step_quiet_crossing": (steps[10].quiet_crossing, "insn"),
        "path/growth_10_to_1000_rules": (growth_between(steps, 10, 1000), ""),
        "path/growth_to_40_rules": (growth_between(steps, 10, 40), ""),
        "path/growth_to_1000_rules": (growth_between(steps, 100, 1000), ""),
        "path/first_step_40_rules": (steps[40].first, "insn"),
        "path/first_step_1000_rules": (steps[1000].first, "insn"),
        "path/load_40_rules": (steps[40].load, "insn"),
        "path/load_64k": (load_64k, "insn"),
        "image/largest_bytes": (size, "B"),
        "vm/verify_64k": (verify, "insn"),
    }

"""What rules cost that have nothing to do: a step in which one reading concerns one rule, among ever
more of them; and images at the limits of the format, verified and loaded."""

import json
import tempfile
from pathlib import Path

import rsc
from counting import BUILT, BenchError, run_given

ABOVE, BELOW = 60_000, 40_000  # thousandths: on either side of the threshold of the rule
READINGS = (ABOVE, BELOW) * 3
COMMANDS_OF_64K = 2540  # of 1,000 rules, so that their image is just below 64 KB


def robot(channels, actuators):
    """robot.json as an object: one sensor that is fed, and some actuators, all virtual."""
    return {
        "sensors": [{"name": "s", "type": "VIRTUAL",
                     "channels": {f"c{i}": {"range": [0, 100]} for i in range(channels)}}],
        "actuators": [{"name": f"a{i}", "type": "VIRTUAL"} for i in range(actuators)],
        "lints": {"W0209": "allow"},
    }


def program(rules, behaviors, channels, actuators, commands):
    """RSL: rules spread evenly over behaviours, and commands over the rules, each of which has a
    response of its own. Only the rule in the middle reads channel c0."""
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


def compiled(folder, rules, behaviors, channels, actuators=2, commands=None):
    source = Path(folder) / f"grown_{rules}.rsl"
    source.write_text(program(rules, behaviors, channels, actuators, commands or rules))
    source.with_suffix(".json").write_text(json.dumps(robot(channels, actuators)))
    image = source.with_suffix(".rsb")
    rsc.run("compile", source, "-o", image, "--strip")
    return image


def run_steps(elf, image):
    """(instructions of the dearest step in which the rule acts, instructions of loading)."""
    marks = run_given(elf, image, READINGS)
    wanted = [[1, 1] if reading == ABOVE else [0, 0] for reading in READINGS]
    if marks.heard("step") != wanted:
        raise BenchError(f"{image.stem}: rules fired and commands were {marks.heard('step')}, "
                         f"not {wanted}")
    steps = marks.spans("mark_step_begin", "mark_step_end")
    return max(steps), marks.spans("mark_load_begin", "mark_load_end")[0]


def verify_cost(image):
    """Instructions of the verifier for each word of the image."""
    marks = run_given(BUILT / "bench_workload", image)
    words = image.stat().st_size // 4
    return round(marks.spans("mark_verify_begin", "mark_verify_end")[0] / words, 1)


def growth_figures():
    with tempfile.TemporaryDirectory() as folder:
        figures = {}
        for rules in (10, 20, 40):
            image = compiled(folder, rules, behaviors=10, channels=8)
            step, load = run_steps(BUILT / "bench_step.elf", image)
            figures[f"path/step_{rules}_rules"] = (step, "insn")
        figures["path/load_40_rules"] = (load, "insn")
        largest = compiled(folder, 1000, behaviors=64, channels=32, commands=COMMANDS_OF_64K)
        figures["image/largest_bytes"] = (largest.stat().st_size, "B")
        figures["vm/verify_64k"] = (verify_cost(largest), "insn")
    return figures

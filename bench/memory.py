"""RAM: what the firmware needs without a program and with the paper's, and what one more behaviour, sensor, actuator or
rule takes of a board's memory for programs, as counted by `rsc check --timing`. The board's own report must agree. The
program's image is counted separately (`image/…`), and so is the space lost to the MPU's alignment."""

import json
import subprocess
import tempfile
from pathlib import Path

import rsc
from board import FAST, FIRMWARE, Board
from counting import BenchError
from workloads import PAPER

MORE = 8  # added together, so that rounding does not show
NO_PART = ("image", "borders", "memory")
FEW = {"behaviors": 8, "sensors": 4, "actuators": 16, "rules": 64}


def robot(sensors, actuators):
    return {"sensors": [{"name": f"s{i}", "type": "I2C", "address": hex(0x20 + i)} for i in range(sensors)],
            "actuators": [{"name": f"a{i}", "type": "PWM", "pin": str(i), "device": "servo"}
                          for i in range(actuators)],
            "lints": {"W0209": "allow"}}


def program(behaviors, sensors, actuators, rules):
    """Rules are spread evenly; the last one reads every sensor. Each moves one actuator, in turn."""
    lines, all_sensors = [], " OR ".join(f"s{i} > 5" for i in range(sensors))
    for b in range(behaviors):
        lines.append(f"BEHAVIOR b{b} PRIORITY {99 - b}")
        for r in range(rules * b // behaviors, rules * (b + 1) // behaviors):
            condition = all_sensors if r == rules - 1 else f"s0 > {r}"
            lines += [f"  WHEN {condition} DO", f"    MOVE a{r % actuators} TO 10deg", "  END"]
        lines.append("END")
    return "\n".join(lines) + "\n"


def parts(**counts):
    """Bytes of the parts of such a program, without its image."""
    with tempfile.TemporaryDirectory() as folder:
        source = Path(folder) / "counted.rsl"
        source.write_text(program(**counts))
        source.with_suffix(".json").write_text(json.dumps(robot(counts["sensors"], counts["actuators"])))
        done = rsc.call("check", "--timing", "--format", "json", source)
        memory = json.loads(done.stdout)["timing"][0]["memory"]
    return sum(share["used"] for share in memory if share["what"] not in NO_PART)


def one_more(what):
    return round((parts(**(FEW | {what: FEW[what] + MORE})) - parts(**FEW)) / MORE, 1)


def fixed_bytes():
    """RAM of the firmware, without its memory for programs."""
    listing = subprocess.run(["arm-none-eabi-size", "-A", str(FIRMWARE)], check=True, text=True,
                             stdout=subprocess.PIPE).stdout
    sizes = {line.split()[0]: int(line.split()[1]) for line in listing.splitlines() if line.startswith(".")}
    return sum(sizes[name] for name in (".stack", ".noinit", ".data", ".bss"))


def used(*program_arguments):
    """Bytes of the memory for programs that the board reports as used. The parts must add up to it."""
    with Board(icount=FAST) as board:
        if program_arguments:
            rsc.run("upload", *program_arguments, "--port", board.port)
        memory = rsc.info(board.port)["board"]["memory"]
    if program_arguments and sum(memory["by"].values()) != memory["used"]:
        raise BenchError(f"the board uses {memory['used']} bytes, rsc counts {memory['by']}")
    return memory["used"]


def firmware_ram():
    """The RAM of a board without a program."""
    return fixed_bytes() + used()


def memory_figures():
    behavior = one_more("behaviors")
    return {
        "firmware/ram_fixed": (firmware_ram(), "B"),
        "firmware/ram_paper": (fixed_bytes() + used(PAPER), "B"),
        "memory/behavior": (behavior, "B"),
        "vm/ram_per_thread": (behavior, "B"),  # everything a thread takes, not only the interpreter's part
        "memory/sensor": (one_more("sensors"), "B"),
        "memory/actuator": (one_more("actuators"), "B"),
        "memory/rule": (one_more("rules"), "B"),
    }

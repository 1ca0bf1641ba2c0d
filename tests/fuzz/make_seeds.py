"""Compiles what the fuzzer starts from: every example, and programs of tests/generators/programs.

usage: make_seeds.py RSC FOLDER

Afterwards FOLDER holds their images, and a file `made`. Which programs are drawn is fixed; one that is too
large for a robot is left out.
"""

import json
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
CONFIG = ROOT / "tests/e2e/programs/robot.json"
sys.path.insert(0, str(ROOT / "tests/generators/programs"))
from generator import TOO_LARGE, Generator  # noqa: E402  (found by the line before)

DRAWN = 16
# SAFETY over a sensor that the board measures.
ROVER = """\
SAFETY near
  WHEN range DISTANCE < 8cm
  DO STOP ALL
  RESUME WHEN range DISTANCE > 12cm FOR 1s
END

SAFETY bumped
  WHEN bumper IS pressed
  DO STOP ALL
END

WHEN range DISTANCE > 50cm
DO RUN wheel AT 40% FOR 2s
END
"""
ROVER_ROBOT = {
    "sensors": [{"name": "range", "type": "I2C", "bus": 0, "address": "0x29", "device": "i2c_register", "channels": {
        "DISTANCE": {"input": 0, "unit": "cm", "range": [2, 200], "rate": "50Hz", "stale_after": "100ms"}}},
                {"name": "bumper", "type": "GPIO", "pin": 40, "device": "button"}],
    "actuators": [{"name": "wheel", "type": "PWM", "pin": "12", "device": "pwm"}]}


def compile_program(rsc, source, image, *options):
    subprocess.run([rsc, "compile", source, "--anyway", "--strip", "-o", image, *options], check=True,
                   stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)


def make(rsc, folder):
    folder.mkdir(parents=True, exist_ok=True)
    for old in folder.glob("*.rsb"):
        old.unlink()
    for source in sorted((ROOT / "examples").glob("*/robot.rsl")):
        compile_program(rsc, source, folder / f"{source.parent.name}.rsb")
    plain = CONFIG
    adapting = folder / "adapting.json"
    adapting.write_text(json.dumps(json.loads(plain.read_text()) | {"scheduler": {"window": "1s"}}))
    for seed in range(DRAWN):
        source = folder / f"drawn{seed:02}.rsl"
        source.write_text(Generator(seed).program())
        try:
            compile_program(rsc, source, source.with_suffix(".rsb"), "--config",
                            adapting if seed % 4 == 0 else plain)
        except subprocess.CalledProcessError as error:
            if TOO_LARGE.encode() not in error.stderr:
                raise
    rover = folder / "rover.rsl"
    rover.write_text(ROVER)
    rover.with_suffix(".json").write_text(json.dumps(ROVER_ROBOT))
    compile_program(rsc, rover, rover.with_suffix(".rsb"))
    for name in ("feeling", "moving"):  # with algorithms
        source = CONFIG.with_name(f"{name}.rsl")
        compile_program(rsc, source, folder / f"{name}.rsb", "--config", source.with_suffix(".json"))
    (folder / "made").touch()


if __name__ == "__main__":
    make(sys.argv[1], Path(sys.argv[2]))

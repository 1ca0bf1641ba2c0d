"""A robot.json changed for a test: without the parts that are soldered to its board, it can run on another one, and a test can feed all
of it."""

import json
from pathlib import Path

STDLIB = Path(__file__).resolve().parents[3] / "stdlib"
GENERIC = {"LEVEL": {"range": [0, 4095]}}  # of a sensor that says nothing of itself
KEPT = ("unit", "range", "labels")  # of a channel: what is fed has no inputs and no scale


def read(path):
    """The robot.json at that path, so that it may be written to another folder: it names each file of words by its whole path."""
    robot, folder = json.loads(Path(path).read_text()), Path(path).resolve().parent
    for algorithm in robot.get("algorithms", []):
        words = folder / algorithm.get("config", {}).get("words", f"{algorithm['name']}.words")
        if words.is_file():
            algorithm.setdefault("config", {})["words"] = str(words)
    return robot


def without_parts(robot, kinds=("sensors", "actuators")):
    """The robot, with what is on its board replaced by the same, virtual; without its board, when nothing is left of it."""
    if "board" not in robot:
        return robot
    parts = json.loads((STDLIB / f"boards/{robot['board']}.json").read_text()).get("on_board", {})
    for kind in kinds:
        for entry in robot[kind]:
            if part := parts.get(entry.get("device")):
                entry.update(type="VIRTUAL", device=part["device"])
                if kind == "sensors":
                    entry["channels"] = _channels(entry)
    if len(kinds) == 2:
        del robot["board"]
    return robot


def turned(robot):
    """The names of the sensors that the wheels of a drive turn, also virtual ones."""
    return {name for actuator in robot["actuators"] for name in actuator.get("encoders", [])}


def by_timing(robot):
    """The robot without the encoders of its drive."""
    for actuator in robot["actuators"]:
        for key in ("encoders", "simulated_difference"):
            actuator.pop(key, None)
    return robot


def fed(sensor):
    """The sensor as one whose readings a test can choose."""
    return {"name": sensor["name"], "type": "VIRTUAL", "channels": _channels(sensor)}


def _channels(sensor):
    """Those that its entry names, or else all of its device."""
    known = {}
    if "device" in sensor:
        known = json.loads((STDLIB / f"devices/{sensor['device']}.json").read_text())["channels"]
    return {name: {key: value for key, value in {**known.get(name, {}), **said}.items() if key in KEPT}
            for name, said in sensor.get("channels", known or GENERIC).items()}

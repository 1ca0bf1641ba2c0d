"""The examples, and random readings for each, from its robot.json."""

import random
import re
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
EXAMPLES = ROOT / "examples"
MOST_COUNTED = 8  # more than an example distinguishes
sys.path.insert(0, str(ROOT / "tests/generators/programs"))

import on_board  # noqa: E402
from board import NAME, REFERENCE  # noqa: E402
from on_board import by_timing, fed, turned, without_parts  # noqa: E402
from stimuli import Reading  # noqa: E402


def folders():
    return [folder for folder in sorted(EXAMPLES.iterdir()) if (folder / "robot.json").is_file()]


def config(folder):
    """Its robot.json with virtual sensors instead of real ones, so that the board can be fed. On a board other than the
    example's, that board's parts are replaced by virtual actuators, too."""
    robot = on_board.read(folder / "robot.json")
    robot = without_parts(robot, ("sensors",) if robot.get("board") == NAME else ("sensors", "actuators"))
    if NAME != REFERENCE:
        by_timing(robot)  # nothing turns its wheels
    for sensor in robot["sensors"]:
        if sensor["name"] in turned(robot):
            continue
        if sensor.get("type") != "VIRTUAL":
            sensor.update(fed(sensor))
        for key in set(sensor) - {"name", "channels"}:
            del sensor[key]
        sensor["type"] = "VIRTUAL"
        for channel in sensor.get("channels", {}).values():
            channel.pop("input", None)
    return robot


def _number(value):
    """A number from robot.json without its unit, which is the channel's."""
    return value if isinstance(value, (int, float)) else float(re.match(r"-?[0-9.]+", value)[0])


def _companion():
    """The channels of each module that runs on a companion computer: {NAME: its range and unit, or its first word}."""
    text = (ROOT / "companion/modules.def").read_text()
    units = dict(re.findall(r'^DIMENSION\((\w+), *"([^"]*)"', (ROOT / "vm/dimensions.def").read_text(), re.M))
    modules = {}
    for kind, arguments in re.findall(r"^(MODULE|OUTPUT|WORDS|TAUGHT|ONE_OF)\(([^)]*)\)", text, re.M):
        name, *rest = (argument.strip() for argument in arguments.split(","))
        if kind == "MODULE":
            channels = modules[name] = {}
        elif kind in ("WORDS", "TAUGHT", "ONE_OF"):
            channels[name] = rest[0]
        else:
            channels[name] = (int(rest[1]) / 1000, int(rest[2]) / 1000, units[rest[0]])
    return modules


def _heard(folder):
    """The same as _channels(), for the algorithms on a companion computer."""
    program = (folder / "robot.rsl").read_text().lower()
    modules, found = _companion(), {}
    robot = config(folder)
    sensors = {sensor["name"] for sensor in robot["sensors"]}
    for algorithm in robot.get("algorithms", []):
        if algorithm.get("input") in sensors:
            continue  # it runs on the board
        for channel, said in modules.get(algorithm.get("module"), {}).items():
            name = algorithm["name"].lower()
            words = re.findall(rf'{name} {channel.lower()} (?:is|becomes) (?:not )?"?(\w+)', program)
            if isinstance(said, str):
                found[f"{algorithm['name']}.{channel}"] = (0, 100, [said, *words], "")
            elif f"{name} {channel.lower()}" in program:
                found[f"{algorithm['name']}.{channel}"] = (said[0], said[1], _counted(*said), said[2])
    return found


def _counted(low, high, unit):
    """The first few values and the last for channels that count or number; none for those that measure."""
    return [] if unit else [*range(int(low), int(low) + MOST_COUNTED), int(high)]


def _channels(folder):
    """{NAME.CHANNEL: (lowest value, highest value, words, unit)} for everything that the program reads."""
    program = (folder / "robot.rsl").read_text().lower()
    found = _heard(folder)
    for sensor in config(folder)["sensors"]:
        for name, channel in sensor.get("channels", {"LEVEL": {}}).items():
            if name.startswith("BANDS_"):  # of sound, in which nobody finds a word by chance; test_traces.py has words
                continue
            if sensor["name"].lower() not in program:
                continue
            words = ["no", "yes"] if channel.get("truth") else channel.get("labels", [])
            low, high = map(_number, channel.get("range", [0, 100]))
            found[f"{sensor['name']}.{name}"] = (low, high, words, channel.get("unit", ""))
    return found


def drawn(folder, seed, count=30):
    """`count` random readings, most of them near the last one of their channel, some anywhere."""
    random_ = random.Random(seed)
    channels = _channels(folder)
    last = {name: low for name, (low, _, _, _) in channels.items()}
    at, readings = 0, []
    for _ in range(count):
        name = random_.choice(list(channels))
        low, high, words, _ = channels[name]
        step = (high - low) / 8
        value = random_.uniform(low, high) if random_.random() < 0.5 else \
            min(high, max(low, last[name] + random_.uniform(-step, step)))
        last[name] = round(value, 1)
        readings.append(Reading(at, name, random_.choice(words) if words else last[name]))
        at += random_.choice([0, 1, 20, 150, 400, 1200, 2500])
    return readings


def units(folder):
    return {name: unit for name, (_, _, _, unit) in _channels(folder).items()}

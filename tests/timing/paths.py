"""Counts what the whole runtime executes on the Cortex-M4 (firmware/path.cpp): for a reading that is fed, and for
a tick with all that is due in it. Assumes that the presets host and m4 have been built."""

import json
import re
import struct
import subprocess
import tempfile
from pathlib import Path

from timing import ROOT

import counting

RSC = ROOT / "build/host/rsc"
FIRMWARE = ROOT / "build/m4/bench/path.elf"
RUNTIME_COSTS = ROOT / "runtime-m4/policy/costs.def"
DRIVERS = ROOT / "vm/drivers.def"
DEVICES = ["-device", "max34451,id=touch,address=0x70", "-device", "tmp105,address=0x48", "-device", "tmp105,address=0x19",
           "-device", "tmp105,address=0x6a", "-device", "tmp105,address=0x68", "-device", "tmp105,address=0x5f", "-device", "tmp105,address=0x1e",
           "-device", "tmp105,address=0x29",
           # In the place of a PCA9685, and of an SSD1306: it acknowledges all, and is never as it was set up.
           "-device", "tmp105,address=0x4a", "-device", "tmp105,address=0x3c"]
PAUSE = 2**31 - 1  # kPause of path.cpp
TICK = "SysTick_Handler"


def board_costs():
    """The list of the board that build/m4 was built for."""
    cache = (ROOT / "build/m4/CMakeCache.txt").read_text()
    return ROOT / "runtime-m4/boards" / re.search(r"^ROBOSYNC_BOARD:\w+=(.+)$", cache, re.M)[1] / "costs.def"


def costs():
    """{name: figure} of what the runtime and the board declare: response times are worked out with them."""
    listed = RUNTIME_COSTS.read_text() + board_costs().read_text()
    return {name: int(value.replace("'", ""))
            for name, value in re.findall(r"^COST\((\w+),\s*([\d']+),", listed, re.M)}


def actuator_drivers():
    """{driver: {call: instructions}} as vm/drivers.def declares them."""
    found = re.findall(r"^ACTUATOR_DRIVER\((\w+),\s*(\d+),\s*(\d+),\s*(\d+),", DRIVERS.read_text(), re.M)
    return {name: dict(zip(("start", "advance", "release"), map(int, calls))) for name, *calls in found}


def samples():
    """{driver: instructions of one sample of one channel}, of the drivers that sample."""
    declared, drivers = costs(), DRIVERS.read_text()
    by_i2c = {name: int(transfers) * declared["i2c_transfer"] + int(size) * declared["i2c_byte"] for
              name, transfers, size in re.findall(r"^SENSOR_DRIVER\((\w+),\s*i2c(?:_once)?\((\d+), (\d+)\)", drivers, re.M)}
    by_pin = re.findall(r"^SENSOR_DRIVER\((\w+),\s*pin\(\)", drivers, re.M)
    by_echo = re.findall(r"^SENSOR_DRIVER\((\w+),\s*echo\(\)", drivers, re.M)
    by_adc = re.findall(r"^SENSOR_DRIVER\((\w+),\s*adc\(\)", drivers, re.M)
    by_edges = re.findall(r"^SENSOR_DRIVER\((\w+),\s*edges\(\)", drivers, re.M)
    by_spi = {name: declared["spi_transfer"] + int(size) * declared["spi_byte"]
              for name, size in re.findall(r"^SENSOR_DRIVER\((\w+),\s*spi\((\d+)\)", drivers, re.M)}
    return (by_i2c | by_spi | {name: declared["input"] for name in by_pin} | {name: declared["echo"] for name in by_echo}
            | {name: declared["analog"] for name in by_adc} | {name: declared["encoder"] for name in by_edges})


def robot(actuators=4, sensors=None):
    """A robot.json: a sensor that is fed, and virtual actuators a0, a1 …"""
    fed = {"name": "s", "type": "VIRTUAL", "channels": {f"c{c}": {"range": [0, 100]} for c in range(4)}}
    return {"sensors": sensors or [fed],
            "actuators": [{"name": f"a{a}", "type": "VIRTUAL"} for a in range(actuators)]}


def feed(value, channel=0):
    return channel, round(value * 1000)


def wait(ticks=10):
    return ticks, PAUSE


def compiled(source, config, image):
    said = subprocess.run([RSC, "compile", source, "--config", config, "-o", image, "--strip", "--anyway"],
                          check=False, capture_output=True, text=True)
    if said.returncode:
        raise counting.BenchError(f"{source}: {said.stderr}")


class Run:
    """One boot: what each reading took until all that came of it was done, and what each tick took."""

    def __init__(self, image, orders, extra=()):
        values = [value for order in orders for value in order]
        at = {TICK: counting.symbols(FIRMWARE)[TICK]} | dict(extra)
        with tempfile.TemporaryDirectory(prefix="robosync-paths-") as folder:
            given = Path(folder) / "orders"
            given.write_bytes(struct.pack(f"<{1 + len(values)}i", len(values), *values))
            self.marks = counting.run(FIRMWARE, counting.loaded(image, counting.IMAGE_ADDRESS) +
                                      counting.loaded(given, counting.READINGS_ADDRESS) + DEVICES, at)
        fed = any(value != PAUSE for _, value in orders)
        self.feeds = self.marks.spans("mark_feed_begin", "mark_feed_end") if fed else []
        self.ticks = self.marks.spans(TICK, "mark_woken")

    @property
    def idle_tick(self):
        """A tick that nobody but the driving thread waits for."""
        return min(self.ticks)


OFF_BEAT = wait(5)  # what is fed comes between two periods of the safety monitor, which would be counted, too


def run(text, orders, config=None, extra=()):
    with tempfile.TemporaryDirectory(prefix="robosync-paths-") as folder:
        source, image = Path(folder) / "p.rsl", Path(folder) / "p.rsb"
        source.write_text(text)
        source.with_suffix(".json").write_text(json.dumps(config or robot()))
        compiled(source, source.with_suffix(".json"), image)
        return Run(image, [OFF_BEAT, *orders], extra)

"""A face on an SSD1306, on the shipped firmware. QEMU has an older relative, the SSD0303: it takes the same control bytes and
addresses, and shows the upper 16 rows of its memory, from column 36 on. That is the upper quarter of the picture. It ignores the
commands that it does not know (addressing mode, charge pump); tests/runtime-m4/drivers/ssd1306_test.cpp has all 128 x 64 dots."""

import json
import re
import time
import unittest

from support import DEVICES, NAME, ROOT, STOPS_WHEN_FAR, LineReader, needs_i2c  # also makes the imports below work
from traces import TraceTest

import rsc
from stimuli import Reading

PATIENCE = 20
SAYS_NOTHING = {"b-l475e-iot01a", "nucleo-l476rg"}
PICTURES = dict(re.findall(r'^PICTURE\((\w+),\s*"(.*)"\)$', (ROOT / "runtime-m4/drivers/pictures.def").read_text(), re.M))
PICTURES = {name: rows.split('", "') for name, rows in PICTURES.items()}
ALIKE = {"happy", "sad"}  # their upper quarter equals that of `neutral`
COLUMNS, ROWS, SCALE, SIDE = 96, 16, 4, 12  # QEMU's display; SIDE: a light in dots
THERE, NOBODY = 0x3C, 0x3D
PROGRAM = "".join(f"WHEN near X > {10 * i} AND near X < {10 * i + 9} DO SHOW face {name} END\n" for i, name in enumerate(PICTURES))
BLINKS = """
BEHAVIOR shows PRIORITY 10
  WHEN near X > 10 DO
    SHOW face happy FOR 300ms
    THEN
    SHOW face sad
    THEN
    BLINK face 3 TIMES OVER 900ms
  END
END
BEHAVIOR interrupts PRIORITY 90
  WHEN near X > 50 DO SHOW face scared FOR 330ms END
END
""" + STOPS_WHEN_FAR
GOES_ON = 'AT START DO SHOW face happy END\nEVERY 100ms DO LOG "goes on" END\n'


def quarter(name):
    """The visible part of the picture, row by row."""
    lights = PICTURES.get(name, ["....."] * 5)
    return ["".join(lights[y // SIDE][x // SIDE] if x < 5 * SIDE else "." for x in range(COLUMNS)) for y in range(ROWS)]


class Face(TraceTest):
    units = {"near.X": ""}

    def qemu_arguments(self):
        display = ["-device", f"ssd0303,id=oled,address={THERE:#x}"] if NAME in DEVICES else []
        return [*display, *super().qemu_arguments()]

    def written(self, text, address=THERE):
        near = {"name": "near", "type": "VIRTUAL", "channels": {"X": {"range": [0, 100]}}}
        face = {"name": "face", "type": "I2C", "device": "ssd1306", "address": hex(address), "bus": 0}
        (self.folder / "face.json").write_text(json.dumps({"board": NAME, "sensors": [near], "actuators": [face]}))
        (self.folder / "face.rsl").write_text(text)
        return self.folder / "face.rsl", self.folder / "face.json"

    def shown(self):
        path = self.folder / "screen.ppm"
        self.board.qmp.command("screendump", filename=str(path), device="oled")
        header = f"P6\n{COLUMNS * SCALE} {ROWS * SCALE}\n255\n".encode()
        data = path.read_bytes()
        self.assertEqual((data[:len(header)], len(data)), (header, len(header) + 3 * COLUMNS * ROWS * SCALE**2))
        dots = data[len(header)::3]
        width = COLUMNS * SCALE
        return ["".join("#" if dots[y * SCALE * width + x * SCALE] else "." for x in range(COLUMNS)) for y in range(ROWS)]

    def await_shown(self, name):
        wanted, give_up = quarter(name), time.monotonic() + PATIENCE
        while (seen := self.shown()) != wanted:
            self.assertLess(time.monotonic(), give_up, f"not {name}:\n" + "\n".join(seen))

    def say(self, verb, *arguments):
        return rsc.call(verb, *arguments, "--port", self.board.port)

    def begin(self, text, address=THERE):
        program, config = self.written(text, address)
        return self.say("upload", program, "--config", config)

    @needs_i2c
    def test_each_picture_is_on_it_until_the_robot_is_stopped(self):
        done = self.begin(PROGRAM)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        for i, name in enumerate(PICTURES):
            if name not in ALIKE:
                self.say("feed", f"near.X={10 * i + 5}")
                self.await_shown(name)
        self.say("stop")
        self.await_shown("dark")
        self.say("resume")
        self.say("feed", "near.X=5")
        self.await_shown("neutral")
        self.assertEqual(self.status()["faults"], 0)

    @needs_i2c
    def test_the_next_program_begins_in_the_dark(self):
        self.begin("AT START DO SHOW face heart END\n")
        self.await_shown("heart")
        self.begin(PROGRAM)
        self.await_shown("dark")

    @unittest.skipIf(NAME in SAYS_NOTHING, "QEMU has no I2C master of this board: a write to it never ends, and counts as done")
    def test_one_that_is_not_there_is_told_and_the_program_goes_on_without_it(self):
        program, config = self.written(GOES_ON, NOBODY)
        reader = LineReader("monitor", "--port", self.board.port, "--format", "json", "--upload", program, "--config", config)
        self.assertTrue(reader.wait_for(lambda lines: "".join(lines).count("goes on") > 30, PATIENCE), reader.lines)
        reader.stop()
        events = [json.loads(line) for line in reader.lines]
        silent = [event for event in events if event["event"] == "silent"]
        self.assertEqual([(event["sensor"], event["bus"], event["address"]) for event in silent], [("ssd1306", 0, "0x3d")])
        self.assertEqual([event for event in events if event["event"] == "deadline"], [])
        self.assertRegex(rsc.run("info", "--port", self.board.port), r"(?m)^silent    ssd1306 at address 0x3d on i2c bus 0 does not answer")

    def test_the_board_does_what_the_host_does(self):
        readings = [Reading(at, "near.X", value) for at, value in
                    ((0, 0), (200, 20), (900, 60), (1000, 20), (2500, 95), (2700, 0), (2900, 30), (3700, 70), (3800, 93), (4000, 3), (4100, 80))]
        program, config = self.written(BLINKS)
        lines = self.check(program, readings, config)
        self.assertGreater(sum('"verb":"BLINK"' in line for line in lines), 1)
        self.assertIn('"event":"halt"', "".join(lines))


if __name__ == "__main__":
    unittest.main()

"""`rsc info --scan`: which addresses of the I2C buses answer, with and without a program, beside one that measures. The devices are
QEMU's; on a board for which it has none, nothing answers."""

import json
import re
import unittest

import rsc
from board import DEVICES, NAME
from support import PROFILE, RobotTest, needs_i2c

ROBOT = {"board": NAME, "actuators": [{"name": "lamp", "type": "VIRTUAL"}],
         "sensors": [{"name": "touch", "type": "I2C", "address": "0x70", "device": "max34451", "channels": {
             "A": {"input": 0, "range": [0, 10], "rate": "100Hz"}, "B": {"input": 1, "range": [0, 10], "rate": "100Hz"}}}]}
PROGRAM = 'WHEN touch A > 3 OR touch B > 3\nDO LOG "touched"\nEND\n'


@needs_i2c
class Scan(RobotTest):
    def qemu_arguments(self):
        return ["-device", "tmp105,address=0x48", "-device", "tmp105,address=0x29", "-device", "at24c-eeprom,address=0x50,rom-size=65536"]

    def scan(self):
        found = json.loads(rsc.run("info", "--scan", "--port", self.board.port, "--format", "json"))["buses"]["scan"]
        self.assertEqual((found["buses"], found["held"]), (1, []))
        return {answer["address"]: (answer["known"], answer["may_be"]) for answer in found["answers"]}

    def test_without_a_program(self):
        store = "the EEPROM that keeps programs and the owner's key"
        self.assertEqual(self.scan(), {"0x29": (None, ["vl53l0x"]), "0x48": (None, ["tmp105"]), "0x50": (store, []), "0x70": (None, [])})
        said = rsc.run("info", "--scan", "--port", self.board.port)
        self.assertRegex(said, r"(?m)^scan      4 answers on 1 I2C bus$")
        self.assertRegex(said, r"(?m)^  0x29    on bus 0: may be vl53l0x$")
        self.assertRegex(said, rf"(?m)^  0x50    on bus 0: {re.escape(store)}$")
        self.assertRegex(said, r"(?m)^  0x70    on bus 0: of no device whose addresses rsc knows$")
        self.assertNotIn("scan", rsc.run("info", "--port", self.board.port))

    def test_beside_a_program_which_loses_nothing(self):
        (self.folder / "robot.json").write_text(json.dumps(ROBOT))
        (self.folder / "robot.rsl").write_text(PROGRAM)
        self.upload(self.folder / "robot.rsl")
        self.assertEqual(self.scan()["0x70"], ("touch (max34451)", []))
        info = rsc.info(self.board.port)
        self.assertEqual([(device["answers"], device["failed"]) for device in info["buses"]["devices"]], [(True, 0)])
        self.assertEqual([thread["missed_deadlines"] for thread in info["threads"]], [0] * len(info["threads"]))
        self.assertEqual(info["buses"]["clears"], 0)
        self.assertEqual(self.status()["faults"], 0)


@unittest.skipIf(NAME in DEVICES, "QEMU has I2C devices for this board: see above")
class NothingThere(RobotTest):
    def test_nothing_answers_and_nothing_hangs(self):
        buses = json.loads(rsc.run("info", "--scan", "--port", self.board.port, "--format", "json"))["buses"]
        self.assertEqual((buses["scan"]["buses"], buses["scan"]["answers"]), (PROFILE["i2c_buses"], []))
        self.assertEqual(self.status()["faults"], 0)


if __name__ == "__main__":
    unittest.main()

"""Thermometers on the emulated I2C bus, a TMP105 and a TMP421, warmed over QMP and read by our driver."""

import json
import unittest

from support import LineReader, RobotTest, needs_i2c

ROBOT = {"sensors": [
    {"name": "room", "type": "I2C", "address": "0x48", "device": "tmp105"},
    {"name": "skin", "type": "I2C", "address": "0x4c", "device": "tmp421"}]}
PROGRAM = """
WHEN room TEMPERATURE > 30C DO LOG "warm room" END
WHEN room TEMPERATURE < -10C DO LOG "frost" END
WHEN skin TEMPERATURE > 50C DO LOG "hot chip" END
WHEN skin REMOTE > 40C DO LOG "hot hand" END
"""
PATIENCE = 20
STEP = 0.07  # degrees: a TMP421's resolution, by which the emulated one reads too low


@needs_i2c
class Thermometers(RobotTest):
    def qemu_arguments(self):
        return ["-device", "tmp105,id=room,address=0x48", "-device", "tmp421,id=skin,address=0x4c"]

    def warm(self, device, which, degrees):
        self.board.qmp.command("qom-set", path=f"/machine/peripheral/{device}", property=which, value=int(degrees * 1000))

    def test_degrees_arrive_with_their_sign_and_each_from_its_own_place(self):
        (self.folder / "robot.json").write_text(json.dumps(ROBOT))
        program = self.folder / "robot.rsl"
        program.write_text(PROGRAM)
        for device, which in (("room", "temperature"), ("skin", "temperature0"), ("skin", "temperature1")):
            self.warm(device, which, 20)
        self.upload(program)
        reader = LineReader("monitor", "--port", self.board.port, "--format", "json")
        try:
            self.await_listening(reader)
            # (the device that is warmed, its temperature, the channel that reports it, the robot's reaction)
            for device, which, degrees, channel, said in (
                    ("room", "temperature", 31.5, "TEMPERATURE", "warm room"),
                    ("room", "temperature", -20.5, "TEMPERATURE", "frost"),
                    ("skin", "temperature0", 60, "TEMPERATURE", "hot chip"),
                    ("skin", "temperature1", 45.25, "REMOTE", "hot hand")):
                with self.subTest(said):
                    self.warm(device, which, degrees)
                    self.expect(reader, f'"{said}"')
                    self.assertAlmostEqual(self.last_reading(reader, device, channel), degrees, delta=STEP)
        finally:
            reader.stop()

    def await_listening(self, reader):
        for degrees in [22, 21] * 50:
            self.warm("room", "temperature", degrees)
            if reader.wait_for(lambda lines: any('"input"' in line for line in lines), 0.4):
                return
        self.fail("rsc monitor shows no reading")

    def expect(self, reader, text):
        self.assertTrue(reader.wait_for(lambda lines: any(text in line for line in lines), PATIENCE),
                        f"no {text} in {reader.lines}")

    def last_reading(self, reader, sensor, channel):
        events = [json.loads(line) for line in reader.lines]
        return [e["value"] for e in events
                if (e["event"], e.get("sensor"), e.get("channel")) == ("input", sensor, channel)][-1]


if __name__ == "__main__":
    unittest.main()

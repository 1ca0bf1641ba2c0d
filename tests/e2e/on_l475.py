"""Tests how the shipped firmware of the B-L475E-IOT01A uses the parts of its chip that QEMU does not have: some stay silent, and
the test plays others. Run with ROBOSYNC_BOARD=b-l475e-iot01a."""

import functools
import json
import math
import re
import struct
import subprocess
import sys
import time
import unittest
from pathlib import Path

import panel
import pins
import rsc
import test_store
import unimplemented
from debugger import LINK_REGISTER, PC, DebuggedTest
from player import FLASH
from support import PROGRAMS, LineReader, RobotTest

sys.path.append(str(Path(__file__).resolve().parents[2] / "bench"))
from board import FIRMWARE, REAL_TIME, ROOT  # noqa: E402
from counting import symbols  # noqa: E402

PATIENCE = 20
# Registers of the I2C masters and of DMA1.
TRANSFER, COUNT_4, MEMORY_4, COUNT_5, MEMORY_5 = ("I2C2", 0x04), ("DMA1", 0x48), ("DMA1", 0x50), ("DMA1", 0x5C), ("DMA1", 0x64)
CORE, BUS_INTERRUPT = "/machine/soc/armv7m", 33
ADDRESS, LEVEL = 0x6A, 0x12
WROTE, STOPPED = 1 << 6, 1 << 5  # bits of the master's state
BOTH_BUSES = {"board": "b-l475e-iot01a", "actuators": [{"name": "arm", "type": "PWM", "pin": 3, "device": "servo"}],
              "sensors": [{"name": f"bus{bus}", "type": "I2C", "bus": bus, "address": hex(ADDRESS), "device": "i2c_register",
                           "channels": {"LEVEL": {"input": LEVEL, "rate": "50Hz"}}} for bus in range(2)]}
WATCHED = """
SAFETY blind
  WHEN bus1 LEVEL > 1000
  DO
    STOP arm
    ALERT "stands still"
END
WHEN bus0 LEVEL > 500
DO LOG "high"
END
"""
LOOSEST, CALLS = 1.3, 20
READS, STOPS_BEHIND = 1 << 10, 1 << 25  # bits of the master's commands
# The motion sensor on that bus: its registers after power-up, the writes to it, and the register of the rotation about Z.
LAMP, LIT_US, PWM_WRITE = 13, 14_000, "robosync::boards::stm32l4::Board::pwm_write("
MOTION = {"board": "b-l475e-iot01a", "actuators": [{"name": "lamp", "type": "PWM", "pin": LAMP, "device": "pwm"}],
          "sensors": [{"name": "motion", "device": "motion"}]}
TURNED = "WHEN motion TURN_Z > 90deg/s MARGIN 10deg/s\nDO RUN lamp TO 70%\nEND\n"
WITHOUT_POWER = {0x0F: 0x6A, 0x12: 0x04}
SETTING, TOLD, OUTPUT, OUTPUTS, TURN_Z, Z, COUNTS_EACH = 0x10, bytes((0x58, 0x54, 0x44)), 0x22, 12, 0x26, 0x2C, 1 / 0.0175
WHOLE = {SETTING: len(TOLD), OUTPUT: OUTPUTS}
# The distance sensor there, and the air sensor, whose register addresses auto-increment when bit 7 is set.
FRONT, FRONT_ADDRESS, FRONT_WHOLE, XSHUT = "front", 0x29, {0xC0: 1, 0x13: 13}, 6
AIR, AIR_ADDRESS, GOES_ON, AIR_WHOLE = "air", 0x5F, 0x80, {0x0F: 1, 0xA0: 12, 0xB0: 16}
PORT_C = 0x4800_0800
DISTANCE = MOTION | {"sensors": [{"name": FRONT, "device": "distance"}]}
NEAR = f"WHEN {FRONT} DISTANCE < 20cm MARGIN 1cm\nDO RUN lamp TO 70%\nEND\n"
CLIMATE = MOTION | {"sensors": [{"name": AIR, "device": "climate"}]}
DAMP = f"WHEN {AIR} HUMIDITY > 60% MARGIN 2%\nDO RUN lamp TO 70%\nEND\n"
# The magnetometer there, whose register addresses do the same.
COMPASS, COMPASS_ADDRESS, COMPASS_WHOLE = "magnet", 0x1E, {0xA0: 5, 0xA8: 6}
FIELD = MOTION | {"sensors": [{"name": COMPASS, "device": "compass"}]}
PULLED = f"WHEN {COMPASS} STRENGTH > 200uT MARGIN 20uT\nDO RUN lamp TO 70%\nEND\n"
COSTS = ROOT / "runtime-m4/boards/b-l475e-iot01a/costs.def"
COST_OF_BUS = re.compile(r"^COST\((i2c_\w+),\s*(\d+),", re.M)

# A panel of lights at D11, PA7: its registers in DMA1, the function of the pin, and its cost.
PANEL = {"board": "b-l475e-iot01a", "sensors": [{"name": "near", "type": "VIRTUAL", "channels": {"X": {"range": [0, 100]}}}],
         "actuators": [{"name": "face", "pin": 11, "device": "ws2812", "color": "blue", "brightness": 20}]}
CHANGES = "WHEN near X > 10 DO SHOW face happy END\nEVERY 100ms DO SHOW face heart FOR 30ms\nTHEN\nSHOW face happy END\n"
SHOWS = "WHEN near X > 10 DO SHOW face happy END\n"
HAPPY, DARK, BLUE, LIGHTS = [".....", ".#.#.", ".....", "#...#", ".###."], ["....."] * 5, 0x33, 25
CONTROL_3, COUNT_3, MEMORY_3 = ("DMA1", 0x30), ("DMA1", 0x34), ("DMA1", 0x3C)
SPI_CONTROL, SENDS = ("SPI1", 0x00), 0xC364
PORT_A, OF_SPI, OF_TIMER = 0x4800_0000, 5, 2
SERVO = {"board": "b-l475e-iot01a", "sensors": PANEL["sensors"], "actuators": [{"name": "arm", "type": "PWM", "pin": 11, "device": "servo"}]}
MOVES = "WHEN near X > 10 DO MOVE arm TO 10deg END\n"
TELL = "robosync::guard::OutputGuard::tell("
COST_OF_PANEL, COST_OF_STRIP = (re.compile(rf"^COST\({name},\s*(\d+),", re.M) for name in ("panel", "strip"))
STRIP = PANEL | {"actuators": [{"name": "eyes", "pin": 11, "device": "ws2812_strip", "lights": 64, "brightness": 20}]}
# A part on SPI at D11 to D13, its select pin A5: DMA1's channels 2 (to memory) and 3, and their interrupt.
KNOB = {"board": "b-l475e-iot01a", "sensors": [{"name": "knob", "device": "mcp3008", "pin": 45, "channels": {"LEVEL": {"input": 5}}}],
        "actuators": []}
TURNED_UP = 'WHEN knob LEVEL > 50% DO LOG "up" END\n'
COUNT_2, MEMORY_2, SPI_INTERRUPT, ENDED_2, READ_5 = ("DMA1", 0x20), ("DMA1", 0x28), 12, 1 << 5, 0x3A
BOTH_WAYS, OUT, RELEASED = 0x374, 0x14, 1
SPI_ENDED = "robosync::boards::AskedSpi<robosync::boards::stm32l4::SpiMaster>::on_interrupt("
COST_OF_SPI = re.compile(r"^COST\((spi_\w+),\s*(\d+),", re.M)
BUSY, READS_FLAGS, READS_STATE = 1 << 7, *(
    rf"^\s*([0-9a-f]+):[^\n]*\sldr(?:\.w)?\s+r(\d+), \[r\d+{place}\]\n[^\n]*\s{then}"
    for place, then in (("(?:, #0)?", r"(?:and|tst)\S*\s[^\n]*#160"), (", #8", r"lsls\s")))
DRIVER, ASK, SAMPLE = "robosync::drivers::spi_register::read(", *(f"robosync::layers::DriverSampler::{name}(" for name in ("ask", "sample"))
OF_CHANNEL, MOST_OTHERS = (1, 2), 200  # the driver's arguments
FADES = "EVERY 300ms DO LIGHT eyes TO 77.7% OVER 77ms\nTHEN\nBLINK eyes purple END\n"


class KeptInFlash(test_store.Switched):
    """What the erased pages show."""

    def test_it_starts_with_the_program_that_stood_its_trial(self):
        first, second = self.images()
        kept = self.keep(first)
        self.assertGreaterEqual(self.board.flash.erased, 2)  # one for it, one for the record
        self.power_cycle()
        self.await_kept("kept")
        self.assertEqual(self.running(), kept)
        self.assertEqual(self.board.flash.erased, 0)
        self.upload(second)
        self.assertNotEqual(self.running(), kept)
        self.assertEqual(self.keep(second), self.running())


class Bus(DebuggedTest):
    def qemu_arguments(self):
        return [*unimplemented.arguments(self.folder), *pins.arguments(self.folder), *super().qemu_arguments()]

    def begin(self):
        config, program = self.folder / "watched.json", self.folder / "watched.rsl"
        config.write_text(json.dumps(BOTH_BUSES))
        program.write_text(WATCHED)
        return program, "--config", config

    def told(self, place):
        """The values that have been written to that place."""
        return unimplemented.told(self.folder, place)

    def test_nobody_on_it_is_told_trips_safety_and_holds_nobody_up(self):
        reader = LineReader("monitor", "--port", self.board.port, "--format", "json", "--upload", *self.begin())
        self.addCleanup(lambda: reader and reader.stop())
        for wanted in ({"event": "silent", "sensor": "bus0"}, {"event": "silent", "sensor": "bus1"}, {"event": "alert"}):
            self.assertTrue(reader.wait_for(lambda lines, wanted=wanted: any(wanted.items() <= json.loads(line).items() for line in lines),
                                            PATIENCE), (wanted, reader.lines[-8:]))
        reader.stop()
        reader = None
        said = rsc.info(self.board.port)
        self.assertEqual((said["status"]["safety_late_us"], said["status"]["faults"]), (0, 0))
        self.assertEqual([thread["missed_deadlines"] for thread in said["threads"]], [0] * len(said["threads"]))
        self.assertEqual([device["answers"] for device in said["buses"]["devices"]], [False, False])
        self.assertTrue(all(device["failed"] > 0 for device in said["buses"]["devices"]))

    def test_what_it_is_told_and_what_that_costs(self):
        """The test plays the master and its DMA: it reports that everything was written, stores the read bytes and reports stop."""
        self.upload(*self.begin())
        wires = pins.Pins(self.folder)
        self.addCleanup(wires.close)
        at = symbols(FIRMWARE)
        driver = next(place for name, place in at.items() if name.startswith("robosync::drivers::i2c_register::read("))
        read, where = self.read_of_state()
        asked, ended = [], []
        with self.debugger() as debugger:
            for value in (7, 260, 1234):
                asked.append(self.ask_own_bus(debugger, driver))
                self.assertEqual(self.told(TRANSFER)[-1], 0x1_2000 | ADDRESS << 1)
                self.assertEqual((self.told(COUNT_4)[-1], self.told(COUNT_5)[-1]), (1, 2))
                self.assertEqual(wires.read(self.told(MEMORY_4)[-1], 1), bytes([LEVEL]))
                for state, memory in ((WROTE, b"\0\0"), (STOPPED, value.to_bytes(2, "little"))):
                    wires.write(self.told(MEMORY_5)[-1], memory)
                    wires.interrupt(CORE, BUS_INTERRUPT)
                    debugger.run_to(at["OwnBus_Handler"], lambda: None)
                    ended.append(debugger.steps_to_return({read: (where, state)}))
                self.assertEqual(self.told(TRANSFER)[-1], 0x202_2400 | ADDRESS << 1)
                self.assertEqual(self.first_answer(debugger, driver), value)
        said = int(dict(COST_OF_BUS.findall(COSTS.read_text()))["i2c_ask"])
        measured = max(asked) + ended[0] + max(ended)
        print(f"\n  asked {asked}, interrupts {ended}: {measured}, said {said}")
        self.assertGreaterEqual(said, measured)
        self.assertLessEqual(said, LOOSEST * measured)

    def test_the_motion_sensor_on_the_board_is_told_and_read_and_what_that_costs(self):
        """The test plays the master, its DMA, and the sensor's registers."""
        config, program = self.folder / "motion.json", self.folder / "motion.rsl"
        config.write_text(json.dumps(MOTION))
        program.write_text(TURNED)
        self.upload(program, "--config", config)
        wires = pins.Pins(self.folder)
        self.addCleanup(wires.close)
        registers = bytearray(128)
        for at, value in WITHOUT_POWER.items():
            registers[at] = value
        self.asked, self.taken, self.measured = [], [], []
        self.assertEqual(self.turn(wires, registers, 80, -100, 100), [80, -100, 100])
        self.assertEqual(registers[SETTING:SETTING + len(TOLD)], TOLD)
        self.most_of_a_sample = max(self.asked) + max(self.measured)  # once the sensor has been told; for bench/bus.py
        costs = {name: int(value) for name, value in COST_OF_BUS.findall(COSTS.read_text())}
        for what, said, measured in (("asking", 3 * costs["i2c_ask"], max(self.asked)),
                                     ("taking", 3 * costs["i2c_transfer"] + 26 * costs["i2c_byte"], max(self.taken))):
            print(f"\n  {what}: {measured}, said {said}")
            self.assertGreaterEqual(said, measured)
        self.assertEqual((self.status()["safety_late_us"], self.status()["faults"]), (0, 0))

    def start(self, config, program):
        (self.folder / "part.json").write_text(json.dumps(config))
        (self.folder / "part.rsl").write_text(program)
        self.upload(self.folder / "part.rsl", "--config", self.folder / "part.json")
        wires = pins.Pins(self.folder)
        self.addCleanup(wires.close)
        self.asked, self.taken, self.measured = [], [], []
        return wires

    def assert_lamp_is_lit(self, debugger):
        debugger.run_to(next(at for name, at in symbols(FIRMWARE).items() if name.startswith(PWM_WRITE)), lambda: None)
        self.assertEqual([debugger.register(1), debugger.register(2)], [LAMP, LIT_US])

    def assert_costs(self, transfers, size):
        """The writes to the part for a sample are asked ahead while the driver takes the bytes that have come."""
        costs = {name: int(value) for name, value in COST_OF_BUS.findall(COSTS.read_text())}
        said = transfers * (costs["i2c_ask"] + costs["i2c_transfer"]) + size * costs["i2c_byte"]
        print(f"\n  asking and taking: {max(self.asked)} and {max(self.taken)}, said {said}")
        self.assertGreaterEqual(said, max(self.asked) + max(self.taken))
        self.assertEqual((self.status()["safety_late_us"], self.status()["faults"]), (0, 0))

    def test_the_distance_sensor_on_the_board_is_awake_and_has_it_measure_with_each_sample(self):
        """The test plays the master, its DMA, and the sensor's registers."""
        wires, registers = self.start(DISTANCE, NEAR), bytearray(256)
        registers[0xC0] = 0xEE
        with self.debugger() as debugger:
            mode, output = debugger.read_words(PORT_C, 1)[0], debugger.read_words(PORT_C + 0x14, 1)[0]
            self.assertEqual((mode >> 2 * XSHUT & 3, output >> XSHUT & 1), (1, 1))
            self.played = len(self.told(TRANSFER))
            for millimetres in (800, 1999, 150):
                registers[0x00], registers[0x0B] = 0, 0
                registers[0x13], registers[0x14] = 4, 11 << 3 | 1
                registers[0x1E:0x20] = millimetres.to_bytes(2, "big")
                self.assertEqual(self.reading(debugger, wires, registers, "vl53l0x", FRONT_ADDRESS, FRONT_WHOLE), millimetres)
                self.assertEqual((registers[0x0A], registers[0x0B], registers[0x00]), (4, 1, 1))
            self.assert_lamp_is_lit(debugger)
        self.assert_costs(4, 27)

    def test_the_sensor_of_the_air_on_the_board_is_told_and_read(self):
        wires, registers = self.start(CLIMATE, DAMP), bytearray(64)
        registers[0x0F] = 0xBC
        registers[0x30:0x40] = struct.pack("<BBBBBBhhhhh", 40, 160, 80, 280 & 0xFF, 0, 280 >> 8 << 2, -4000, 0, 6000, 300, 700)
        with self.debugger() as debugger:
            self.played = len(self.told(TRANSFER))
            for percent in (50, 20, 80):
                registers[0x28:0x2C] = struct.pack("<hh", round(-4000 + (percent - 20) * 10_000 / 60), 460)
                given = self.reading(debugger, wires, registers, "hts221", AIR_ADDRESS, AIR_WHOLE, GOES_ON)
                self.assertAlmostEqual(given, 1000 * percent, delta=4)
                self.assertEqual(registers[0x20], 0x87)
            self.assert_lamp_is_lit(debugger)
        self.assert_costs(4, 41)

    def test_the_magnetometer_on_the_board_is_told_and_read(self):
        wires, registers = self.start(FIELD, PULLED), bytearray(64)
        registers[0x20], registers[0x22] = 0x10, 0x03
        with self.debugger() as debugger:
            self.played = len(self.told(TRANSFER))
            for counts in ((500, 0, 500), (-300, 20, -2100), (3000, -2900, 2)):
                registers[0x28:0x2E] = struct.pack("<hhh", *counts)
                given = self.reading(debugger, wires, registers, "lis3mdl", COMPASS_ADDRESS, COMPASS_WHOLE, GOES_ON)
                self.assertEqual(given, math.isqrt(sum(count * count for count in counts)))
                self.assertEqual(registers[0x20:0x25], bytes((0x7C, 0x60, 0, 0x0C, 0x40)))
            self.assert_lamp_is_lit(debugger)
        self.assert_costs(3, 24)

    def turn(self, wires, registers, *speeds):
        """The driver's results for each speed, while the board lies still."""
        registers[Z:Z + 2] = round(1 / 0.000122).to_bytes(2, "little")
        given = []
        with self.debugger() as debugger:
            self.played = len(self.told(TRANSFER))
            for speed in speeds:
                registers[TURN_Z:TURN_Z + 2] = round(speed * COUNTS_EACH).to_bytes(2, "little", signed=True)
                given.append(self.reading(debugger, wires, registers, "lsm6dsl", ADDRESS, WHOLE))
            self.assert_lamp_is_lit(debugger)  # the program's response to the last one
        return [round(count / COUNTS_EACH) for count in given]

    def reading(self, debugger, wires, registers, name, address, whole, goes_on=0):
        """The next reading. For calls that ask ahead, instructions are counted with the interrupts that they cause; for the others
        without, since their writes to the sensor are asked ahead in that time."""
        driver = next(at for symbol, at in symbols(FIRMWARE).items() if symbol.startswith(f"robosync::drivers::{name}::read("))
        for _ in range(CALLS):
            debugger.run_to(driver, lambda: None)
            place = debugger.register(3)
            steps = debugger.steps_to_return()
            given = debugger.register(0) & 1
            ended, read = self.play(debugger, wires, registers, address, goes_on)
            if read == whole:
                self.asked.append(steps + ended)
            elif not read:
                self.taken.append(steps)
            self.assertLessEqual(read.items(), whole.items())  # at the start one may be under way
            if given:
                self.measured.append(steps)
                return int.from_bytes(debugger.read_words(place, 1)[0].to_bytes(4, "little"), "little", signed=True)
        return self.fail("nothing is read")

    def play(self, debugger, wires, registers, address, goes_on):
        """Performs all commands of the master. Returns the interrupts' instructions, and {register: bytes read from there on}.
        `goes_on` holds the further bits of a register's address."""
        handler, (state, where), steps, place, found = symbols(FIRMWARE)["OwnBus_Handler"], self.read_of_state(), 0, None, {}
        while self.played < len(told := self.told(TRANSFER)):
            order = told[self.played]
            self.assertEqual(order >> 1 & 0x7F, address)
            if order & READS:
                found[place] = order >> 16 & 0xFF
                first = place & ~goes_on
                wires.write(self.told(MEMORY_5)[-1], bytes(registers[first:first + found[place]]))
            else:
                place, *values = wires.read(self.told(MEMORY_4)[-1], self.told(COUNT_4)[-1])
                first = place & ~goes_on
                registers[first:first + len(values)] = bytes(values)
            self.played += 1
            wires.interrupt(CORE, BUS_INTERRUPT)
            debugger.run_to(handler, lambda: None)
            steps += debugger.steps_to_return({state: (where, STOPPED if order & STOPS_BEHIND else WROTE)})
        return steps, found

    def ask_own_bus(self, debugger, driver):
        """The instructions of the driver's next call that begins a transfer on that bus."""
        before = len(self.told(TRANSFER))
        for _ in range(CALLS):
            debugger.run_to(driver, lambda: None)
            steps = debugger.steps_to_return()
            if len(self.told(TRANSFER)) > before:
                return steps
        return self.fail("it is asked no more")

    def first_answer(self, debugger, driver):
        """The driver's next result."""
        for _ in range(CALLS):
            debugger.run_to(driver, lambda: None)
            place = debugger.register(3)
            debugger.run_to(debugger.register(LINK_REGISTER) & ~1, lambda: None)
            if debugger.register(0) & 1:
                return debugger.read_words(place, 1)[0]
        return self.fail("nothing is read")

    def read_of_state(self):
        """The address where the interrupt handler reads the master's state, and the register it reads into."""
        place = next(at for name, at in symbols(FIRMWARE).items() if name.startswith("robosync::boards::AskedBus<robosync::boards::stm32l4::I2cMaster>::on_interrupt("))
        said = subprocess.run(["arm-none-eabi-objdump", "-d", f"--start-address={place & ~1:#x}", f"--stop-address={(place & ~1) + 64:#x}",
                               FIRMWARE], check=True, text=True, stdout=subprocess.PIPE).stdout
        found = re.search(r"^\s*([0-9a-f]+):.*\sldr(?:\.w)?\s+r(\d+), \[r\d+, #24\]", said, re.M)
        return int(found[1], 16), int(found[2])


class Spi(DebuggedTest):
    def qemu_arguments(self):
        return [*unimplemented.arguments(self.folder), *pins.arguments(self.folder), *super().qemu_arguments()]

    told, first_answer = Bus.told, Bus.first_answer

    def begin(self, robot=None, text=TURNED_UP):
        (self.folder / "spi.json").write_text(json.dumps(robot or KNOB))
        (self.folder / "spi.rsl").write_text(text)
        return self.folder / "spi.rsl", "--config", self.folder / "spi.json"

    def functions(self, wires):
        """Of PA5 and PA7; and their modes and that of PA6."""
        return wires.word(PORT_A + 0x20) >> 20 & 0xF0F, wires.word(PORT_A) >> 10 & 0x3F

    def test_a_transfer_that_does_not_end_is_told_and_holds_nobody_up_and_the_pins_are_given_back(self):
        wires = pins.Pins(self.folder)
        self.addCleanup(wires.close)
        self.status()
        before = self.functions(wires)
        reader = LineReader("monitor", "--port", self.board.port, "--format", "json", "--upload", *self.begin())
        try:
            silent = {"event": "silent", "sensor": "knob", "bus": 0, "pin": 45}
            self.assertTrue(reader.wait_for(lambda lines: any(silent.items() <= json.loads(line).items() for line in lines), PATIENCE),
                            reader.lines[-8:])
        finally:
            reader.stop()
        self.assertEqual(self.functions(wires), (0x505, 0b10_10_10))
        self.assertEqual((set(self.told(SPI_CONTROL)), set(self.told(COUNT_2)), set(self.told(COUNT_3))), ({BOTH_WAYS}, {3}, {3}))
        said = rsc.info(self.board.port)
        self.assertEqual((said["status"]["safety_late_us"], said["status"]["faults"]), (0, 0))
        [knob] = said["buses"]["devices"]
        self.assertEqual((knob["driver"], knob["pin"], knob["answers"], knob["failed"] > 0), ("mcp3008", 45, False, True))
        self.upload(*self.begin(SERVO, MOVES))
        self.assertEqual(self.functions(wires), before)
        self.assertEqual(wires.word(PORT_C + OUT) & RELEASED, RELEASED)

    def test_what_it_is_told_and_what_that_costs(self):
        """The test plays SPI1, its DMA, and the part."""
        self.upload(*self.begin())
        wires = pins.Pins(self.folder)
        self.addCleanup(wires.close)
        at = symbols(FIRMWARE)
        driver = next(place for name, place in at.items() if name.startswith("robosync::drivers::mcp3008::read("))
        asked, ended, taken = [], [], []
        with self.debugger() as debugger:
            for value in (1023, 512, 5):
                asked.append(self.ask(debugger, driver))
                self.assertEqual(wires.word(PORT_C + OUT) & RELEASED, 0)
                self.assertEqual(wires.read(self.told(MEMORY_3)[-1], 3), bytes((READ_5, 0, 0)))
                again = int(f"{value:010b}"[-2:-7:-1], 2)  # B1 to B5
                wires.write(self.told(MEMORY_2)[-1], b"\xff" + (value << 5 | again).to_bytes(2, "big"))
                wires.interrupt(CORE, SPI_INTERRUPT)
                debugger.run_to(at["Spi_Handler"], lambda: None)
                ended.append(debugger.steps_to_return(self.reads_of_interrupt(0)))
                self.assertEqual(wires.word(PORT_C + OUT) & RELEASED, RELEASED)
                debugger.run_to(driver, lambda: None)
                place = debugger.register(3)
                taken.append(debugger.steps_to_return())
                self.assertEqual((debugger.register(0) & 1, debugger.read_words(place, 1)), (1, [value]))
        print(f"\n  asked {asked}, interrupts {ended}, taken {taken}")

    def test_what_as_many_channels_as_there_can_be_cost(self):
        """The test decides which channel is asked for or collected, and when a transfer ends. So the worst case is there each time: the last
        request of the table runs, and the one before it, which is found last, waits, or none."""
        channels = {f"C{i}": {"input": i} for i in range(32)}
        robot = KNOB | {"sensors": [{"name": "part", "type": "SPI", "pin": 45, "channels": channels}]}
        self.upload(*self.begin(robot, "".join(f'WHEN part {channel} > 50 DO LOG "up" END\n' for channel in channels)))
        wires = pins.Pins(self.folder)
        self.addCleanup(wires.close)
        asked, collected, ended = {}, [], []
        with self.debugger() as debugger:
            self.await_call(debugger, SAMPLE)
            self.await_call(debugger, ASK)  # all that was asked for before has been collected
            while len(asked) < len(channels):
                channel, steps = self.call(debugger, ASK)
                asked[channel] = steps
                self.end(debugger, wires)
            *_, before, last = sorted(asked, key=asked.get)
            for waiting in ([], [before]):
                for collects in (True, False):
                    for channel in (last, *waiting):
                        self.call(debugger, ASK, channel)
                    if collects:
                        collected.append(self.call(debugger, SAMPLE, last)[1])
                    else:
                        ended.append(self.end(debugger, wires))
                    self.end(debugger, wires)
        costs = {name: int(number) for name, number in COST_OF_SPI.findall(COSTS.read_text())}
        for what, said, measured in (("asking", costs["spi_ask"], max(asked.values()) + max(ended)),
                                     ("taking", costs["spi_transfer"], max(collected))):
            print(f"\n  {what}: {measured}, said {said}")
            self.assertGreaterEqual(said, measured)
            self.assertLessEqual(said, LOOSEST * measured)

    def await_call(self, debugger, caller):
        """Stops where this function calls the driver."""
        for _ in range(MOST_OTHERS):
            debugger.run_to(self.driver(), lambda: None)
            if self.is_called_by(debugger, caller):
                return
            debugger.step()
        self.fail(f"{caller} calls it no more")

    def call(self, debugger, caller, channel=None):
        """The driver's next call by this function; it is for `channel`, if that is given: its channel and its instructions. To others the
        driver returns at once, without a result."""
        for _ in range(MOST_OTHERS):
            debugger.run_to(self.driver(), lambda: None)
            if self.is_called_by(debugger, caller):
                for number, value in zip(OF_CHANNEL, channel or ()):
                    debugger.set_register(number, value)
                return tuple(map(debugger.register, OF_CHANNEL)), debugger.steps_to_return()
            debugger.set_register(0, 0)
            debugger.set_register(PC, debugger.register(LINK_REGISTER) & ~1)
        return self.fail(f"{caller} calls it no more")

    @staticmethod
    def driver():
        return next(place for name, place in symbols(FIRMWARE).items() if name.startswith(DRIVER))

    @staticmethod
    def is_called_by(debugger, function):
        back = debugger.register(LINK_REGISTER) & ~1
        return max((place, name) for name, place in symbols(FIRMWARE).items() if place <= back)[1].startswith(function)

    def end(self, debugger, wires):
        """The instructions of the interrupt at a transfer's end, if the bus stays busy as long as it looks."""
        wires.interrupt(CORE, SPI_INTERRUPT)
        debugger.run_to(symbols(FIRMWARE)["Spi_Handler"], lambda: None)
        return debugger.steps_to_return(self.reads_of_interrupt(BUSY))

    def ask(self, debugger, driver):
        """The instructions of the driver's next call that begins a transfer."""
        before = len(self.told(COUNT_2))
        for _ in range(CALLS):
            debugger.run_to(driver, lambda: None)
            steps = debugger.steps_to_return()
            if len(self.told(COUNT_2)) > before:
                return steps
        return self.fail("it is asked no more")

    @staticmethod
    @functools.cache
    def reads_of_interrupt(state):
        """What the interrupt at a transfer's end reads: {address of the instruction: (register, value)}. `state` is that of the SPI."""
        handler = next(place for name, place in symbols(FIRMWARE).items() if name.startswith(SPI_ENDED))
        said = subprocess.run(["arm-none-eabi-objdump", "-d", f"--start-address={handler:#x}", f"--stop-address={handler + 96:#x}", FIRMWARE],
                              check=True, text=True, stdout=subprocess.PIPE).stdout
        found = [re.search(pattern, said, re.M) for pattern in (READS_FLAGS, READS_STATE)]
        return {int(at, 16): (int(register), value) for (at, register), value in zip(map(re.Match.groups, found), (ENDED_2, state))}


class Panel(DebuggedTest):
    def qemu_arguments(self):
        return [*unimplemented.arguments(self.folder), *pins.arguments(self.folder), *super().qemu_arguments()]

    told = Bus.told

    def begin(self, robot, text):
        (self.folder / "panel.json").write_text(json.dumps(robot))
        (self.folder / "panel.rsl").write_text(text)
        self.upload(self.folder / "panel.rsl", "--config", self.folder / "panel.json")

    def await_picture(self, wires, picture):
        wanted, give_up, shown = panel.chain(picture, BLUE, 5, False), time.monotonic() + PATIENCE, None
        while shown != wanted:
            self.assertLess(time.monotonic(), give_up, shown)
            if self.told(MEMORY_3):
                shown = panel.colors("b-l475e-iot01a", wires.read(self.told(MEMORY_3)[-1], self.told(COUNT_3)[-1]), LIGHTS)

    def function(self, wires):
        return wires.word(PORT_A + 0x20) >> 28

    def test_it_is_told_its_picture_until_the_robot_is_stopped_and_its_pin_is_given_back(self):
        wires = pins.Pins(self.folder)
        self.addCleanup(wires.close)
        self.begin(PANEL, SHOWS)
        self.await_picture(wires, DARK)
        self.assertEqual((self.function(wires), self.told(SPI_CONTROL)), (OF_SPI, [SENDS]))
        rsc.run("feed", "near.X=20", "--port", self.board.port)
        self.await_picture(wires, HAPPY)
        rsc.run("stop", "--port", self.board.port)
        self.await_picture(wires, DARK)
        self.assertEqual((self.status()["safety_late_us"], self.status()["faults"]), (0, 0))
        self.begin(SERVO, MOVES)
        self.assertEqual((self.function(wires), self.told(SPI_CONTROL)[-1]), (OF_TIMER, 0))

    def test_what_a_picture_costs(self):
        self.compare_cost(PANEL, CHANGES, COST_OF_PANEL)

    def test_what_a_colour_of_a_strip_costs(self):
        self.compare_cost(STRIP, FADES, COST_OF_STRIP)

    def compare_cost(self, robot, program, cost):
        self.begin(robot, program)
        tell, counts = next(at for name, at in symbols(FIRMWARE).items() if name.startswith(TELL)), []
        with self.debugger() as debugger:
            for _ in range(CALLS):
                debugger.run_to(tell, lambda: None)
                counts.append(debugger.steps_to_return())
        said = int(cost.search(COSTS.read_text())[1])
        print(f"\n  {cost.pattern}: {max(counts)}, said {said}")
        self.assertGreaterEqual(said, max(counts))
        self.assertLessEqual(said, 1.25 * max(counts) + 60)


class WithoutFlash(RobotTest):
    def test_a_flash_that_does_nothing_is_a_store_that_does_not_answer(self):
        said = self.upload(PROGRAMS / "priorities.rsl", "--config", self.for_board(PROGRAMS / "robot.json"), "--trial", "1s")
        self.assertIn("not kept: this board has no working store; after a reset the robot has no program", said)
        told = rsc.info(self.board.port)
        self.assertEqual((told["kept"]["state"], told["status"]["faults"], told["status"]["safety_late_us"]), ("no_store", 0, 0))
        self.assertIsNotNone(told["board"]["program"])
        self.assertEqual([thread["missed_deadlines"] for thread in told["threads"]], [0] * len(told["threads"]))
        self.board.qmp.command("system_reset")
        self.assertIsNone(rsc.info(self.board.port)["board"]["program"])


class Damage(DebuggedTest):
    def qemu_arguments(self):
        return [*pins.arguments(self.folder), *super().qemu_arguments()]

    def test_what_the_flash_cannot_correct_ends_in_a_reset_but_in_the_store(self):
        wires = pins.Pins(self.folder)
        self.addCleanup(wires.close)
        forgive = next(at for name, at in symbols(FIRMWARE).items() if name.startswith(FLASH + "forgive_damage("))
        for forgiven, reason in ((1, "power"), (0, "software")):
            with self.debugger() as debugger:
                debugger.run_to(forgive, lambda: wires.interrupt(CORE, 0, "NMI"))
                debugger.set_register(0, forgiven)
                debugger.set_register(PC, debugger.register(LINK_REGISTER) & ~1)
            self.assertEqual(self.status()["reset_reason"], reason)


class NoOwner(RobotTest):
    icount = REAL_TIME  # for the minute in which it can be paired

    def test_who_would_be_its_owner_is_told(self):
        key = self.folder / "key"
        rsc.run("keygen", "--key", key)
        done = rsc.call("pair", "--key", key, "--port", self.board.port)
        self.assertEqual(done.returncode, 3)
        self.assertIn("does its store work?", done.stderr)
        self.assertEqual(rsc.info(self.board.port)["owner"]["pairing"], "unpaired")


if __name__ == "__main__":
    unittest.main()

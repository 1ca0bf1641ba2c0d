"""What the shipped firmware of the micro:bit V2 hears when the debugger plays the converter of its microphone, which QEMU does not have."""

import array
import json
import random
import re
import shutil
import subprocess
import sys
import unittest
import wave
from pathlib import Path

import pins
import rsc
from support import LineReader

sys.path.append(str(Path(__file__).resolve().parents[2] / "bench"))
from board import FIRMWARE, ROOT  # noqa: E402
from counting import symbols  # noqa: E402

PATIENCE = 20
P0_OUT = 0x5000_0504
HAPPY = [".....", ".#.#.", ".....", "#...#", ".###."]
COSTS = ROOT / "runtime-m4/boards/microbit-v2/costs.def"
# The microphone: its power, RESULT.PTR and CH[1].PSELP of SAADC, and the counter of its blocks, which
# QEMU has (it has neither SAADC nor PPI).
MICROPHONE = "robosync::boards::microbit::microphone::"
RUN_MIC, SAADC = 20, 0x4000_7000
SOUND_TO, SOUND_INPUT = (SAADC + at for at in (0x62C, 0x520))
BLOCK_ENDED = 0x4000_A008  # TIMER2, TASKS_COUNT
BLOCK, HALF, RESTS_AT, STEPS, MEAN_PARTS = 160, 80, 8000, 4, 128
HEARS = {"sensors": [{"name": "microphone", "device": "microphone"}], "actuators": [{"name": "face", "device": "lights"}],
         "algorithms": [{"name": "ear", "module": "sound_events", "input": "microphone"}]}
CLAPS = "WHEN ear EVENT IS clap\nDO SHOW face happy\nEND\n"
COST = r"COST\({}, +([0-9']+)"


def discarded():
    """How many of its first samples a program discards."""
    return int(re.search(r"is_microphone\(driver\)\) return (\d+);", (ROOT / "vm/drivers.hpp").read_text())[1])


class Hearing:
    """The tests of a DebuggedTest that hears."""

    def begin_hearing(self):
        config, program = self.folder / "hears.json", self.folder / "hears.rsl"
        config.write_text(json.dumps({"board": "microbit-v2", **HEARS}))
        program.write_text(CLAPS)
        self.upload(program, "--config", config)
        wires = pins.Pins(self.folder)
        self.addCleanup(wires.close)
        return wires, program, config

    def place_in(self, name):
        return next(at for known, at in symbols(FIRMWARE).items() if known.startswith(MICROPHONE + name))

    def place_of_byte(self, name):  # symbols() clears the lowest bit of an address
        listing = subprocess.run(["arm-none-eabi-nm", "-C", FIRMWARE], check=True, text=True, stdout=subprocess.PIPE).stdout
        return int(re.search(rf"^(\w+) \w {re.escape(MICROPHONE + name)}$", listing, re.M)[1], 16)

    def play(self, debugger, wires, blocks):
        """Plays the converter: at each call of hear() a block has come to its buffer, first the one of half the length."""
        hear, buffers = self.place_in("hear("), self.place_in("(anonymous namespace)::blocks")
        for _ in range(discarded() + 1):  # if the program has just begun
            debugger.run_to(hear, lambda: None)
            debugger.step()
        debugger.run_to(hear, lambda: None)  # it has been started, but QEMU has not said so
        wires.write(self.place_of_byte("(anonymous namespace)::runs"), bytes([1]))
        for i, block in enumerate(blocks):
            wires.write(buffers + i % 2 * 2 * BLOCK, b"".join(value.to_bytes(2, "little") for value in block))
            wires.set_word(BLOCK_ENDED, 1)
            debugger.step()
            debugger.run_to(hear, lambda: None)
            self.await_told(SOUND_TO, buffers + i % 2 * 2 * BLOCK)  # the one that it took is the next but one

    def clap(self):
        """Blocks as the converter gives them, 14 bits. The first whole one begins at the mean, so what is before it has no effect."""
        draw = random.Random(1)
        heights = [0] + 30 * [8] + [2200, 400] + 20 * [8]
        whole = [[max(0, min(16383, round(draw.gauss(RESTS_AT, height)))) for _ in range(BLOCK)] for height in heights]
        whole[1][0] = RESTS_AT
        return [whole[0][:HALF], *whole[1:]]

    def without_mean(self, blocks):
        """As boards::Board::hear() says: 16 bits, without the mean voltage."""
        mean, without = blocks[0][0] * STEPS * MEAN_PARTS, []
        for block in blocks:
            heard = []
            for value in block:
                mean += value * STEPS - mean // MEAN_PARTS
                heard.append(max(-32768, min(32767, value * STEPS - mean // MEAN_PARTS)))
            without.append(heard)
        return without[1:]

    def heard_on_host(self, program, config, blocks):
        """The readings that rsc run has of the same sound."""
        with wave.open(str(self.folder / "clap.wav"), "wb") as file:
            file.setparams((1, 2, 8000, 0, "NONE", ""))
            file.writeframes(b"".join(value.to_bytes(2, "little", signed=True) for block in blocks for value in block))
        scenario = self.folder / "clap.json"
        scenario.write_text(json.dumps({"duration": "3s", "stimuli": [{"sound": "clap.wav", "sensor": "microphone", "at": "1s"}]}))
        told = rsc.run("run", program, "--config", config, "--scenario", scenario, "--format", "json")
        return self.readings(told.splitlines())

    def readings(self, lines):
        told = map(json.loads, lines)
        return [(event["channel"], event["value"]) for event in told
                if event.get("event") == "input" and event.get("sensor") == "microphone" and event["value"] is not None]

    def assert_happy_as_on_host(self, wires, program, config, blocks, told=""):
        """The readings of this sound are those of rsc run; the trace tells that, and in the end the face is happy."""
        wanted = self.heard_on_host(program, config, self.without_mean(blocks))
        self.assertGreater(len(wanted), 60)
        reader = self.listen()
        with self.debugger() as debugger:
            self.play(debugger, wires, blocks)
        self.assertTrue(reader.wait_for(lambda lines: len(self.readings(lines)) >= len(wanted), PATIENCE))
        self.assertTrue(reader.wait_for(lambda lines: any(told in line for line in lines), PATIENCE))
        reader.stop()
        self.assertEqual(self.readings(reader.lines)[:len(wanted)], wanted)
        self.assertEqual(self.seen(wires), dict(enumerate(row[:3] + "." + row[4] for row in HAPPY)))
        status = self.status()
        self.assertEqual((status["faults"], status["safety_late_us"]), (0, 0))

    def test_a_clap_that_the_converter_writes_is_heard_as_on_the_host_and_lights_the_face(self):
        wires, program, config = self.begin_hearing()
        self.assertEqual(self.told(SOUND_INPUT)[-1], 4)
        self.assertEqual(wires.word(P0_OUT) >> RUN_MIC & 1, 1)
        self.assert_happy_as_on_host(wires, program, config, self.clap())
        self.begin("SHOW face happy")
        self.assertEqual(wires.word(P0_OUT) >> RUN_MIC & 1, 0)
        self.assertEqual(self.told(SOUND_INPUT)[-1], 0)

    def spoken(self, text):
        """As the converter gives it: somebody says it, with a second of a quiet room before it and 0.8 s after it."""
        path = self.folder / "said.wav"
        subprocess.run(["espeak-ng", "-v", "en-us+f2", "-s", "157", "-p", "53", "-w", path, text], check=True)
        with wave.open(str(path)) as file:
            rate, samples = file.getframerate(), array.array("h", file.readframes(file.getnframes()))
        draw, spoken = random.Random(1), []
        for i in range(len(samples) * 8000 // rate):
            part = samples[i * rate // 8000:(i + 1) * rate // 8000]
            spoken.append(sum(part) / len(part))
        sound = [0] * 8000 + spoken + [0] * (6400 + -len(spoken) % BLOCK)
        raw = [max(0, min(16383, round(RESTS_AT + value / (2 * STEPS) + draw.gauss(0, 4)))) for value in sound]
        return [raw[:HALF], *(raw[at:at + BLOCK] for at in range(HALF, len(raw) - BLOCK, BLOCK))]

    @unittest.skipUnless(shutil.which("espeak-ng"), "nobody speaks: espeak-ng is not installed")
    def test_a_pet_hears_its_name_as_on_the_host(self):
        pet = ROOT / "examples/pocket_pet"
        program, config = pet / "robot.rsl", pet / "robot.json"
        self.upload(program, "--config", config)
        wires = pins.Pins(self.folder)
        self.addCleanup(wires.close)
        self.assert_happy_as_on_host(wires, program, config, self.spoken("pixel"), '"word":"hello"')

    def test_a_microphone_that_never_answers_is_told_and_holds_nothing_up(self):
        _, program, config = self.begin_hearing()
        reader = LineReader("monitor", "--port", self.board.port, "--format", "json", "--upload", program, "--config", config)
        try:
            told = {"event": "silent", "sensor": "microphone"}
            self.assertTrue(reader.wait_for(lambda lines: any(told.items() <= json.loads(line).items() for line in lines), PATIENCE))
        finally:
            reader.stop()
        status = self.status()
        self.assertEqual((status["faults"], status["safety_late_us"]), (0, 0))

    def steps_of_a_block(self, wires):
        """The most instructions of several blocks, of a tone of a pitch for which the ear does most (bench/firmware/ear_bench.cpp)."""
        draw = random.Random(1)
        tone = [[RESTS_AT + (BLOCK * i + at) % 4 * 800 + draw.randrange(200) for at in range(BLOCK)] for i in range(8)]
        sample = next(at for name, at in symbols(FIRMWARE).items() if name.startswith("robosync::drivers::Microphone::sample("))
        counts = []
        with self.debugger() as debugger:
            self.play(debugger, wires, [tone[0][:HALF], *tone[1:]])
            wires.set_word(BLOCK_ENDED, 1)
            while len(counts) < 2 or counts[-1][1] < 4:
                debugger.run_to(sample, lambda: None)
                if debugger.register(2) & 0xFF:  # the first channel
                    wires.write(self.place_in("(anonymous namespace)::blocks"), b"".join(value.to_bytes(2, "little") for value in 2 * tone[0]))
                    wires.set_word(BLOCK_ENDED, 1)
                    counts.append([0, 0])
                steps = debugger.steps_to_return(most=100_000)
                if counts:
                    counts[-1] = [counts[-1][0] + steps, counts[-1][1] + 1]
        print(f"\n  20 ms of sound: {counts}")
        return max(count for count, _ in counts)

    def check_cost(self, name, measured):
        said = int(re.search(COST.format(name), COSTS.read_text())[1].replace("'", ""))
        self.assertGreaterEqual(said, measured)
        self.assertLessEqual(said, 1.25 * measured + 60)

    def test_what_a_block_of_sound_costs(self):
        wires, *_ = self.begin_hearing()
        self.check_cost("sound", self.steps_of_a_block(wires))

    def test_what_the_spectrum_of_a_block_costs(self):
        pet = ROOT / "examples/pocket_pet"
        self.upload(pet / "robot.rsl", "--config", pet / "robot.json")
        wires = pins.Pins(self.folder)
        self.addCleanup(wires.close)
        self.check_cost("spectrum", self.steps_of_a_block(wires))

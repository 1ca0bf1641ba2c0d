"""What every board must do: boot, report its name, run an example as the host does, and stop."""

import json
import sys
import unittest

import examples
import periods
import pins
import rsc
import stimuli
from board import FIRMWARE, NAME, REAL_TIME
from support import INPUTS, OUTPUTS, PROFILE, PROGRAMS, RobotTest
from traces import TraceTest

sys.path.append(str(rsc.ROOT / "bench"))
from counting import symbols  # noqa: E402

COMPANION = rsc.ROOT / "examples/touch_companion"
MOST_LATE_US = 20_000
READINGS_SEED = 475
RAM = 0x1000_0000  # and up; flash is below on each board
PARTS = PROFILE.get("on_board", {})
BY_I2C = """{"board": "%s", "actuators": [],
 "sensors": [{"name": "touch", "type": "I2C", "bus": %d, "address": "0x70", "device": "max34451",
              "channels": {"LEVEL": {"input": 0}}}]}"""


# The actuators that stdlib/safety_basics.rsl expects, on the first output.
ARMS = {"actuators": [{"name": "arm", "type": "PWM", "pin": OUTPUTS[0], "device": "servo",
                       "range": ["0deg", "100deg"]}],
        "groups": {"arms": ["arm"]}}
FORCE = {"name": "arms", "type": "VIRTUAL", "channels": {"FORCE": {"unit": "N", "range": [0, 50]}}}
ALL_INPUTS = "\n".join(f'WHEN i{pin} IS closed\nDO LOG "{pin} low"\nELSE LOG "{pin} high"\nEND' for pin in INPUTS)


def button(name, pin):
    """A button on this pin, by its name if the board has one there."""
    part = next((part for part, wired in PARTS.items() if wired.get("pin") == pin), None)
    return {"name": name, "device": part} if part else {"name": name, "type": "GPIO", "pin": pin, "device": "button"}


class EveryBoard(TraceTest):
    def qemu_arguments(self):
        return pins.arguments(self.folder)

    def run_wired(self, program, robot, *feeds):
        """Uploads the program; returns the pins, and a reader of the board's trace from then on."""
        config, source = self.folder / "wired.json", self.folder / "wired.rsl"
        config.write_text(json.dumps({"board": NAME, **robot}))
        source.write_text(program)
        wires = pins.Pins(self.folder)
        self.addCleanup(wires.close)
        self.upload(source, "--config", config)
        for feed in feeds:
            rsc.run("feed", feed, "--port", self.board.port)
        return wires, self.listen()

    def test_it_says_what_it_is(self):
        said = rsc.info(self.board.port)
        board, status = said["board"], said["status"]
        self.assertEqual(board["name"], NAME)
        self.assertEqual(board["memory"]["bytes"], PROFILE["arena"]["bytes"])
        self.assertEqual(board["memory"]["arena_begin"], int(PROFILE["arena"]["begin"], 16))
        self.assertEqual(board["step_budget"], PROFILE["step_budget"])
        self.assertIsNone(board["program"])
        self.assertEqual((status["reset_reason"], status["faults"]), ("power", 0))
        self.assertIn(f"board     {NAME},", rsc.run("info", "--port", self.board.port))

    def test_its_time_goes_on_evenly(self):
        """The safety monitor is never late, however the core sleeps and is woken by the line."""
        statuses = [self.status() for _ in range(20)]
        passed = statuses[-1]["uptime_us"] - statuses[0]["uptime_us"]
        checks = statuses[-1]["safety_checks"] - statuses[0]["safety_checks"]
        self.assertGreater(passed, 0)
        self.assertEqual(sorted(s["uptime_us"] for s in statuses), [s["uptime_us"] for s in statuses])
        self.assertAlmostEqual(checks, passed / (1000 * periods.idle_ms()), delta=2)
        self.assertEqual(statuses[-1]["safety_late_us"], 0)

    def test_the_companion_does_what_it_does_on_the_host(self):
        config = self.folder / "companion.json"
        config.write_text(json.dumps(examples.config(COMPANION)))
        self.units = examples.units(COMPANION)
        lines = self.check(COMPANION / "robot.rsl", examples.drawn(COMPANION, READINGS_SEED), config)
        self.assertTrue(any('"verb":"MOVE"' in line for line in lines))

    def test_examples_of_this_board_do_what_they_do_on_the_host(self):
        """Uses the real parts of the board that the examples are for; on other boards these are virtual."""
        for folder in examples.folders():
            if json.loads((folder / "robot.json").read_text()).get("board") != NAME:
                continue
            with self.subTest(folder.name):
                config = self.folder / f"{folder.name}.json"
                config.write_text(json.dumps(examples.config(folder)))
                self.units = examples.units(folder)
                lines = self.check(folder / "robot.rsl", examples.drawn(folder, READINGS_SEED), config)
                self.assertTrue(any('"command"' in line for line in lines))

    def test_the_papers_program_does_what_it_does_on_the_host(self):
        lines = self.check(PROGRAMS / "paper.rsl", stimuli.touch(0, 1, 2, 3, 4, 5, 2, 2, 10, 0))
        self.assertTrue(any("greeting.wav" in line for line in lines))

    def test_the_red_button_stops_it_and_the_green_one_lets_it_go_on(self):
        red, green = INPUTS[0], INPUTS[-1]
        wires, reader = self.run_wired(
            "USE safety_basics\n", {"sensors": [button("red_button", red), button("green_button", green), FORCE], **ARMS},
            "arms.FORCE=0N")
        wires.set(red, False)
        self.await_event(reader, "trip")
        self.await_event(reader, "alert", text="Stopped by the red button")
        wires.set(red, True)
        wires.set(green, False)
        self.await_event(reader, "release", actuator="arm")

    def test_no_code_of_kernel_and_port_is_in_the_place_of_the_cores_registers(self):
        """Their addresses differ modulo 64 KB, because QEMU caches one page per such address (boards/common/firmware.ld)."""
        ours = {name: at for name, at in symbols(FIRMWARE).items()
                if name.endswith("_Handler") or name.startswith(("robosync::kernel::Kernel::", "robosync::port::"))}
        self.assertGreater(len(ours), 20)
        there = [name for name, at in ours.items() if at < RAM and at % 0x1_0000 in range(0xE000, 0xF000)]
        self.assertEqual(there, [])

    def test_each_input_is_its_own_pin(self):
        switches = [{"name": f"i{pin}", "type": "GPIO", "pin": pin, "device": "switch"} for pin in INPUTS]
        wires, reader = self.run_wired(ALL_INPUTS, {"sensors": switches})
        for pin in INPUTS:
            for high in (False, True):
                wires.set(pin, high)
                self.await_event(reader, "log", text=f"{pin} {'high' if high else 'low'}")
        told = [json.loads(line) for line in reader.lines]
        self.assertEqual([event["text"] for event in told if event["event"] == "log"],
                         [f"{pin} {level}" for pin in INPUTS for level in ("low", "high")])

    def test_stop_holds_until_resume(self):
        config = self.folder / "companion.json"
        config.write_text(json.dumps(examples.config(COMPANION)))
        self.upload(self.compile(COMPANION / "robot.rsl", config))
        for verb, stopped in (("stop", True), ("resume", False)):
            rsc.run(verb, "--port", self.board.port)
            self.assertEqual(rsc.info(self.board.port)["state"]["stopped"], stopped)

    def test_what_it_has_not_is_refused_before(self):
        config, program = self.folder / "robot.json", self.folder / "robot.rsl"
        config.write_text(BY_I2C % (NAME, PROFILE["i2c_buses"]))
        program.write_text("BEHAVIOR none PRIORITY 1\nEND\n")
        done = rsc.call("check", program, "--config", config)
        self.assertEqual(done.returncode, 1)
        self.assertIn(f"the board {NAME} has no I2C bus {PROFILE['i2c_buses']}", done.stderr)


class AtThePaceOfTheHost(RobotTest):
    icount = REAL_TIME

    def test_a_busy_host_makes_it_slow_and_not_late(self):
        self.upload(self.compile(COMPANION / "robot.rsl", COMPANION / "robot.json"))
        self.board.hold_up(0.3)
        status = rsc.info(self.board.port)["status"]
        self.assertEqual(status["activations"], 1)
        self.assertLessEqual(status["safety_late_us"], MOST_LATE_US)


if __name__ == "__main__":
    unittest.main()

"""How fast the shipped firmware reaches its safe state, with isolation on, and what the output guard costs.

safety/reading_to_safe     from the reading in its mailbox that trips a SAFETY rule, until the guard has shut the pins
                           of all actuators and put them into their safe state
safety/stop_frame_to_safe  from the interrupt with the last byte of rsc's `stop` to the same point
safety/guard_per_command   instructions in the guard, and in the code that drives the pin, for one order of a driver

The arms are moving. Everything in between counts, including interrupts. The figure is the worst of several times. The
first two are counted again as …_loaded: with 40 busy threads, 36 of them behaviours that compute for two thirds of the
time, during an upload that floods the link; the stop arrives in the middle of it.

The emulated line delivers the bytes of a handful together. A real one carries one byte each way in the time of 2,170
instructions. So the time of the line's interrupts is subtracted. For …_loaded, one receive and one transmit interrupt
with one byte each are added back: the worst case in so short a time, whether or not they occurred. An interrupt that
sees a stop counts with its least time: that is the one in which it had no other byte to take.
"""

import tempfile
from pathlib import Path

import rsc
from board import Board
from counting import (READING, BenchError, Marks, begin_of, ends_of, functions, of_the_board, plugin_arguments,
                      wait_for_readings)
from flood import STOP, Flood
from idle import code_of

BYTE = "Uart0Receive_Handler"
SENT = "Uart0Transmit_Handler"
SWITCH = "PendSV_Handler"
STOPPED = "robosync::Runtime::say("
END = "end of "
ORDER = "robosync::guard::OutputGuard::drive("
SHUT = "robosync::guard::OutputGuard::halt("
PIN = "Board::pwm_write("  # of the board
TIMES = 20
BURST = 16  # the most bytes that one interrupt moves (runtime-m4/boards/common/serial_line.hpp)
ROBOTS_TIME = "shift=5,sleep=off"  # otherwise, on a busy host, the watchdog would reset the board
LIGHT, FIRM, TOO_FIRM = 1, 5, 9
BETWEEN = 6  # readings, 120 ms
CONFIG = """{
  "sensors": [{"name": "touch", "type": "I2C", "bus": 0, "address": "0x70", "device": "max34451",
               "channels": {"LEVEL": {"input": 0, "range": [0, 10], "rate": "50Hz"}}}],
  "actuators": [
    {"name": "left_arm", "type": "PWM", "pin": 10, "device": "servo", "range": ["0deg", "120deg"]},
    {"name": "right_arm", "type": "PWM", "pin": 11, "device": "servo", "range": ["0deg", "120deg"]}]
}"""
PROGRAM = """
SAFETY pinch
  WHEN touch LEVEL > 7
  DO STOP ALL
  RESUME WHEN touch LEVEL < 2
END
WHEN touch LEVEL > 3
DO
  MOVE left_arm TO 100deg AT 10deg/s
  MOVE right_arm TO 100deg AT 10deg/s
END
"""
BUSY_BEHAVIORS = 36
BUSY_THREADS = BUSY_BEHAVIORS + 4  # sensor, arms, link
# RAISE and LOWER cancel out, so nothing follows from them. `rsc check` cannot know that: hence --anyway.
LOAD = "REMEMBER n = 0\n" + "".join(f"""
BEHAVIOR busy{i} PRIORITY {i + 1}
  EVERY 10ms
  DO
    REPEAT 70 TIMES
      RAISE n BY 1
      LOWER n BY 1
    END
  END
END
""" for i in range(BUSY_BEHAVIORS))


def lines_of(path):
    with open(path, encoding="ascii") as lines:
        return sum(1 for _ in lines)


class Person:
    """Stops the robot and resumes it, with rsc."""

    lonely = None

    def __init__(self, board, _):
        self.port = board.port

    def stop(self):
        rsc.run("stop", "--port", self.port)

    def resume(self):
        rsc.run("resume", "--port", self.port)

    def leave(self):
        pass


class PersonInAFlood:
    """The same, on a line that is being flooded."""

    def __init__(self, board, marks):
        threads = rsc.info(board.port)["threads"]
        if len(threads) < BUSY_THREADS:
            raise BenchError(f"{len(threads)} threads are no load")
        self.marks, self.flood = marks, Flood(board.port, marks)
        begin = lines_of(marks)
        for _ in range(TIMES):
            self.flood.send_raw(b"\0")
            wait_for_readings(marks, 1)
        self.lonely = begin, lines_of(marks) - 1  # marks between which bytes came one by one
        self.flood.start()

    def stop(self):
        self.flood.say(STOP)
        wait_for_readings(self.marks, 1, STOPPED)

    def resume(self):
        self.flood.quiet()
        self.flood.ask("resume", self.flood.resumption(), "status")
        self.flood.start()

    def leave(self):
        self.flood.close()


def drive(board, image, pause, person_at):
    """Trips TIMES times with moving arms, then has a person stop it as often. Returns the person."""
    def touch(raw):
        board.set_touch(raw)
        pause()

    board.set_touch(LIGHT)
    rsc.run("upload", image, "--port", board.port, "--anyway")
    pause()
    person = person_at(board)
    for _ in range(TIMES):
        for raw in (FIRM, TOO_FIRM, LIGHT):
            touch(raw)
    for _ in range(TIMES):
        touch(FIRM)
        person.stop()
        touch(LIGHT)
        person.resume()
        pause()
    person.leave()
    return person


def shuts(marks):
    """For each time that the pins were shut: instructions from the reading, or from the end of the interrupt that
    received the stop, until they were shut, without the line's interrupts. A second shutdown right afterwards does not
    count."""
    stops, begin, found = {end for _, end in stop_interrupts(marks)}, None, []
    for i, (name, _) in enumerate(marks.all):
        if name == READING or i in stops:
            begin = i
        elif name == END + SHUT and begin is not None:
            found.append(executed(marks, begin, i) + -sum(spans(marks, BYTE, begin, i) + spans(marks, SENT, begin, i)))
            begin = None
    if len(found) != 2 * TIMES:
        raise BenchError(f"the robot came to rest {len(found)} times, not {2 * TIMES}")
    return found[:TIMES], found[TIMES:]


def stop_interrupts(marks):
    """[(begin, end)] of the interrupts that saw a stop."""
    found, begin, said = [], None, False
    for i, (name, _) in enumerate(marks.all):
        if name == BYTE:
            begin, said = i, False
        elif name == STOPPED:
            said = True
        elif name == END + BYTE:
            if begin is not None and said:
                found.append((begin, i))
            begin = None
    return found


def executed(marks, begin, end):
    return marks.all[end][1] - marks.all[begin][1] + (marks.apart[end] - marks.apart[begin])


def spans(marks, interrupt, begin=0, end=None):
    """The instructions of each of these interrupts that began in the range."""
    found, since = [], None
    for i in range(begin, len(marks.all) if end is None else end + 1):
        name = marks.all[i][0]
        if name == interrupt:
            since = i
        elif name == END + interrupt and since is not None:
            found.append(int(executed(marks, since, i)))
            since = None
    return found


def of_a_stop(marks):
    """The least time of an interrupt that sees a stop."""
    return min(int(executed(marks, *interrupt)) for interrupt in stop_interrupts(marks))


def of_the_line(marks, lonely):
    """One interrupt that takes a byte and wakes the thread that waits for it, measured with single bytes; plus one that
    sends a byte, calculated from the shortest and the longest transmit interrupt."""
    first, last = lonely
    sent = spans(marks, SENT)
    return max(spans(marks, BYTE, first, last)) + min(sent) + -(-(max(sent) - min(sent)) // BURST)


def most_in_the_guard(marks):
    """The worst of the orders: what the code that is counted apart executed until the next mark."""
    orders = [after - before for (name, _), before, after in zip(marks.all, marks.apart, marks.apart[1:])
              if name == ORDER]
    if not orders:
        raise BenchError("no driver ever gave an order")
    return max(orders)


def marks_of(program, person_at):
    known = functions(READING, BYTE, SENT, STOPPED, ORDER, SHUT, SWITCH)
    known |= {name: begin_of(name) for name in (BYTE, SENT)}
    ends = {END + name: at for name in (BYTE, SENT, SHUT) for at in ends_of(name)}
    with tempfile.TemporaryDirectory() as folder:
        folder = Path(folder)
        (folder / "robot.json").write_text(CONFIG)
        (folder / "robot.rsl").write_text(program)
        image, out = folder / "robot.rsb", folder / "marks"
        rsc.run("compile", folder / "robot.rsl", "-o", image, "--anyway")
        arguments = plugin_arguments(known | ends, out, code_of([ORDER, of_the_board(PIN), SHUT]))
        with Board(icount=ROBOTS_TIME, extra=arguments) as board:
            person = drive(board, image, lambda: wait_for_readings(out, BETWEEN), lambda board: person_at(board, out))
        return Marks(known | ends, out), person.lonely


def figures_of(name, program, person_at):
    marks, lonely = marks_of(program, person_at)
    readings, stops = shuts(marks)
    line = of_the_line(marks, lonely) if lonely else 0
    return {"safety/reading_to_safe" + name: (max(readings) + line, "insn"),
            "safety/stop_frame_to_safe" + name: (max(stops) + of_a_stop(marks) + line, "insn"),
            "safety/guard_per_command" + name: (most_in_the_guard(marks), "insn")}


def calm_figures():
    return figures_of("", PROGRAM, Person)


def loaded_figures():
    figures = figures_of("_loaded", PROGRAM + LOAD, PersonInAFlood)
    del figures["safety/guard_per_command_loaded"]  # the same as without load: nothing else is counted
    return figures


def safety_figures():
    return calm_figures() | loaded_figures()

"""How fast the shipped firmware comes to rest, isolation on, and what the output guard costs.

safety/reading_to_safe     from the reading that trips a SAFETY rule in its mailbox, until the guard has shut the pins of all
                           actuators and put them into their safe state
safety/stop_frame_to_safe  from the interrupt with the last byte of rsc's `stop` to the same
safety/guard_per_command   instructions in the guard, and in what drives the pin, for one order of a driver

The arms are moving; everything that comes in between counts, interrupts too. The most of several times is the figure.
The first two are counted once more, as …_loaded, beside a behaviour that computes in a third of the time.
"""

import tempfile
from pathlib import Path

import rsc
from board import FIRMWARE, REAL_TIME, Board
from counting import BenchError, Marks, of_the_board, plugin_arguments, symbols, wait_for
from idle import code_of

READING = "robosync::layers::Mailboxes::post("
BYTE = "Uart0Receive_Handler"
ORDER = "robosync::guard::OutputGuard::drive("
SHUT = "robosync::guard::OutputGuard::halt("
PIN = "Board::pwm_write("  # of the board
TIMES = 20
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
LOAD = """
REMEMBER n = 0
EVERY 6ms
DO
  REPEAT 1000 TIMES
    RAISE n BY 1
    LOWER n BY 1
  END
END
"""


def functions(*wanted):
    found = {end: at for name, at in symbols(FIRMWARE).items() for end in wanted if name.startswith(end)}
    if len(found) != len(wanted):
        raise BenchError(f"the firmware has not all of {wanted}")
    return found


def drive(board, image, pause):
    """Trips TIMES times with moving arms, then is stopped by a person as often."""
    def touch(raw):
        board.set_touch(raw)
        pause()

    board.set_touch(LIGHT)
    rsc.run("upload", image, "--port", board.port)
    pause()
    for _ in range(TIMES):
        for raw in (FIRM, TOO_FIRM, LIGHT):
            touch(raw)
    for _ in range(TIMES):
        touch(FIRM)
        rsc.run("stop", "--port", board.port)
        touch(LIGHT)
        rsc.run("resume", "--port", board.port)
        pause()


def shuts(marks):
    """Of each time that the pins were shut: {mark: instructions since the last one of it, until that was done}. Who shuts
    them once more right away finds it done."""
    last, found, before = {}, [], None
    for (name, count), apart, after in zip(marks.all, marks.apart, marks.apart[1:]):
        if name == SHUT and before != SHUT:
            found.append({begin: count - at + (after - apart) for begin, at in last.items()})
        last[name], before = count, name
    if len(found) != 2 * TIMES:
        raise BenchError(f"the robot came to rest {len(found)} times, not {2 * TIMES}")
    return found


def most_in_the_guard(marks):
    """Of the orders: what the code that was counted apart has executed until the next mark."""
    orders = [after - before for (name, _), before, after in zip(marks.all, marks.apart, marks.apart[1:])
              if name == ORDER]
    if not orders:
        raise BenchError("no driver ever gave an order")
    return max(orders)


def marks_of(program):
    known = functions(READING, BYTE, ORDER, SHUT)
    with tempfile.TemporaryDirectory() as folder:
        folder = Path(folder)
        (folder / "robot.json").write_text(CONFIG)
        (folder / "robot.rsl").write_text(program)
        image, out = folder / "robot.rsb", folder / "marks"
        rsc.run("compile", folder / "robot.rsl", "-o", image)
        arguments = plugin_arguments(known, out, code_of([ORDER, of_the_board(PIN), SHUT]))
        with Board(icount=REAL_TIME, extra=arguments) as board:
            drive(board, image, lambda: wait_for(out, known[READING], BETWEEN))
        return Marks(known, out)


def safety_figures():
    figures = {}
    for name, program in (("", PROGRAM), ("_loaded", PROGRAM + LOAD)):
        marks = marks_of(program)
        found = shuts(marks)
        figures["safety/reading_to_safe" + name] = max(shut[READING] for shut in found[:TIMES]), "insn"
        figures["safety/stop_frame_to_safe" + name] = max(shut[BYTE] for shut in found[TIMES:]), "insn"
        if program == PROGRAM:
            figures["safety/guard_per_command"] = most_in_the_guard(marks), "insn"
    return figures

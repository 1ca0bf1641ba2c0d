"""How long a host waits for an answer while a program uses all the processor time that the link's thread, which has a
lower rank, would need.

link/answer  microseconds of the robot's time from the interrupt with the last byte of a request until its answer is
             ready for the line; the worst case over all requests to all programs. The requests come at random times,
             each in two parts, as on a line that takes milliseconds for them.

The programs fill the processor in different ways; the largest of their steps take as long as a board accepts. `rsc
check` refuses them, so they are uploaded with --anyway. A processor that never sleeps executes an instruction every 32
ns here.
"""

import random
import tempfile
import time
from pathlib import Path

import rsc
from board import Board
from counting import BenchError, Marks, ends_of, functions, plugin_arguments
from safety import BYTE, END, ROBOTS_TIME
import wire

ANSWER = "robosync::update::LineWriter::send("
US_AN_INSTRUCTION = 32e-3  # see ROBOTS_TIME
REQUESTS = 40
ROBOT = """{"sensors": [{"name": "near", "type": "VIRTUAL", "channels": {"X": {"range": [0, 10000]}}}],
 "actuators": [{"name": "arm", "type": "PWM", "pin": 3, "device": "servo", "range": ["0deg", "180deg"]}]}"""


def rounds(times):
    return f"""
  EVERY 1ms
  DO
    REPEAT {times} TIMES
      SET round TO (round * 3 + 1) MOD 1000
    END
  END
"""


def behaviors(count, times):
    return "".join(f"BEHAVIOR busy{i} PRIORITY {i + 1}{rounds(times)}END\n" for i in range(count))


# A step of 1.5 ms every millisecond; the longest that a board accepts; many threads; and less than a millisecond.
PROGRAMS = rounds(900), rounds(1900), behaviors(30, 60), rounds(250)


def ask(line, draw):
    """Asks at an unpredictable time."""
    time.sleep(draw.uniform(0.05, 0.12))
    request = wire.frame("hello", line.introduction())
    cut = draw.randrange(1, len(request))
    line.send_raw(request[:cut])
    time.sleep(draw.uniform(0, 0.006))
    line.send_raw(request[cut:])
    line.expect("hello_reply")


def answers_to(marks):
    """Instructions from the last byte of each request to its answer."""
    last, found = None, []
    for name, executed in marks.all:
        if name == END + BYTE:
            last = executed
        elif last is not None:
            found.append(executed - last)
            last = None
    if len(found) < REQUESTS:
        raise BenchError(f"the board gave {len(found)} answers to {REQUESTS} requests")
    return [int(count) for count in found[-REQUESTS:]]


def most_of(text):
    known = functions(ANSWER) | {END + BYTE: at for at in ends_of(BYTE)}
    with tempfile.TemporaryDirectory() as folder:
        folder = Path(folder)
        (folder / "robot.json").write_text(ROBOT)
        (folder / "robot.rsl").write_text("REMEMBER round = 0\n" + text)
        out = folder / "marks"
        with Board(icount=ROBOTS_TIME, extra=plugin_arguments(known, out)) as board:
            rsc.run("upload", folder / "robot.rsl", "--port", board.port, "--anyway")
            draw = random.Random(1)
            with wire.Line(board.port) as line:
                for _ in range(REQUESTS):
                    ask(line, draw)
        return max(answers_to(Marks(known, out)))


def answer_figures():
    return {"link/answer": (round(max(map(most_of, PROGRAMS)) * US_AN_INSTRUCTION), "us")}

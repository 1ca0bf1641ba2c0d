"""docs/measurements.md: every figure, how cost grows with the rules, and what other VMs need."""

import json
import re
from pathlib import Path

import growth

PEERS = json.loads((Path(__file__).parent / "peers.json").read_text())
OURS = "**RoboSync**, all checks on"
MISSED = "MISSED"

HEAD = """# Measurements

Printed by `scripts/bench --markdown`. `insn` are executed Cortex-M4 instructions, counted exactly by a plugin in
QEMU 7.2 (`bench/count_plugin/`), those of other boards than `mps2-an386` in QEMU 10.0; they are not cycles. Bytes are what the linker kept.
Times are wall clock, of `compile/…` CPU time, on the machine that printed this page. What each figure means: `bench/figures.py`,
`bench/workloads.py`, `bench/growth.py`, `bench/idle.py`, `bench/answer.py`, `bench/compile_figures.py` and `bench/boards.py`;
bars: `bench/bars.json`. `scripts/bench --only GROUP` measures one group, such as `board`.

Bars are the design's, and none is moved to what was measured: what misses one is shown as missed. `scripts/bench` fails
when a figure misses a bar that it met before, and when a counted figure is more than 2 % above what `bench/recorded.json`
says: so nothing grows unnoticed. (Of the ways of a touch that this machine gives the board, 5 to 50 % above, and of what a host
waits for, as much again: what else is due in that moment is another thing each time.) `scripts/bench --record` records what is measured now; `scripts/bench --profile NAME` says
which functions ran while a figure was counted, and how many instructions of each.

Three instructions of each switch are the time that threads ran, which no peer's figure includes. `kernel/yield_isolated` has the
second system call in it, by which the thread that was let run takes its events. Of what misses its bar: `kernel/mailbox` compares
with the last reading, keeps times and announces together; `kernel/lock_out_add` is while a program is loaded.
`path/…`: no single place is dear; of the way to the command three commands take a quarter (decoded, queued, handed over),
threads and their switches another, the rest is the step's bookkeeping for rules. `firmware/flash`: memory
as large as the board, laid out for each program, took one kilobyte, programs and numbers that outlast the power four, algorithms four and
a half, the owner's signature ten and a half.
`firmware/power_up_to_program`: the paper's program from the board's store, until its time begins; 8,000 to 15,000, by how often the host asks meanwhile. `ear/block`:
20 ms of sound, the dearest of all pitches, on a board that had a microphone. `vm/flash` has a bar of the whole language, not of the first
design's arithmetic and commands (4,096).
`path/smooth_sample` is `vm/W3_natural` with the largest window, 32 samples, in the order that moves most of them; its bands
are in it. `firmware/idle_second_paper` is without what the bit-banged I2C bus executes, `…_i2c` is that alone.
`vm/bytes_W3`: the response takes 88, the period of its EVERY, which the peers' step has not, 8 more.
`safety/stop_frame_to_safe_loaded` is the most of 20 stops, whose moments this machine chooses and not the robot: where none comes
while the tick, or who holds the switch off, has dozens of threads to see to, it is some 560; 1,584 is the most that was seen, and stays
recorded.
`link/answer`: how long a host waits for an answer from robots whose programs leave the link nothing, from the last byte of its
request until the answer is ready for the line; the most of 160 requests at random times.
`vm/W1` ends when both commands are put out, as the peers' does; `vm/W1_queue` is the same rule in the shipped firmware, until both
are in their drivers' queues: claims, two threads and their switches included. `vm/W3_staged` is W3 in the shipped firmware, until
what it has SET is staged for the next step. `vm/ram_per_thread` is all that a behaviour takes.
`vm/verify_per_word` is of
the paper's image, most of which is wiring and names; `vm/verify_64k` is of 1,000 rules in 64 behaviours at the format's
limit of 64 KB (`image/largest_bytes`), nearly all of it rules and code, of which a word costs more.

`b-l475e-iot01a/…`, `microbit-v2/…` and `nucleo-l476rg/…` are of the shipped firmware of these boards, and have the bars of the reference board's; flash and RAM have none there. QEMU
has no I2C bus of theirs: the touch sensor is played, through QEMU's debugger port, in the place of its driver's function, before the
reading is in its mailbox; all that is counted is the firmware. Readings, and the bytes of `rsc monitor`'s first messages, come when
the firmware has come to a certain place, so each of these figures is the same in each run, to the instruction. `power_up_to_first_step`: from reset, in the
emulator's time, 16 ns an instruction, until the first step begins of the paper's program, which the firmware itself has kept in its flash. Of
`b-l475e-iot01a` and `nucleo-l476rg` QEMU only reads the flash: while the program was kept, before, a debugger played what erases and writes it.

`compile/…` is CPU time of `rsc check` on that machine, start included (`bench/compile_figures.py`). `lines_per_second`: a
program of 100,000 lines that compiles: 2,500 lines of rules of every kind, about as many as an image holds, and TEST
blocks. `rule_lines_per_second`: these rules alone, which are optimised and translated too, without what the paper's program
takes. `paper`: that program. `growth_…`: something 2n times against n times, right and wrong programs (`bench/compile_programs.py`), in
time beyond what the paper's takes; `growth_of_memory` is the largest of all, in memory. A missed bar in `ms` or `lines/s` is
shown and fails nothing, for the machine may be slow. A growth of CPU time fails above 3 only: other
work on the machine moves it by some tenths.

| figure | value | unit | bar | |
|---|---|---|---|---|"""

GROWTH = """## Rules that have nothing to do

A reading is fed that concerns one rule among N, which stand evenly in the behaviours; each has a response of its own
(`bench/growth.py`). Instructions from the reading to the end of the step and of all that came of it, kernel and the
driver's command included, by the runtime linked as in the firmware (`bench/firmware/step_bench.cpp`). Up to 40 rules stand
in 10 behaviours, more in 64; there is more memory than the board is said to have. Before, each channel had a first reading; a
behaviour's first step evaluates all of its rules, so these cost more, once: `path/first_step_…`.

| rules | behaviours | instructions of the step |
|---|---|---|"""

WORKLOADS = """## Beside other virtual machines

The same three workloads, in instructions. W1: the paper's rule, from setting the reading to both commands put out. W2: one
round of `s = s + i * i mod 251` over whole numbers. W3: one step of a mean of eight readings with hysteresis, shifted
by hand. Their sources: `examples/touch_companion`, `bench/programs`. `vm/W3_natural` above is what W3 costs as users of
RSL write it, a CHECK with SMOOTH and MARGIN: from the new reading to its band, in the runtime, a median and not a mean.
Bytes: the code of W1, W2 and W3; ours have {constants} bytes of constants besides.

The peers were measured once, for the design of this VM, on their own sources and in the same way: arm-none-eabi-gcc
12.2, -O2, hard float, QEMU 7.2 (`-M mps2-an386 -icount shift=0`), exactly where a plugin counted, to 40 instructions where
SysTick did; W2 and W3 with whole numbers. `scripts/bench` does not measure them again (`bench/peers.json`).

| system | W1 | W2, a round | W3, a step | instructions an opcode, on W2 | bytes W1/W2/W3 |
|---|---|---|---|---|---|"""


MORE_IS_BETTER = {"lines/s"}  # units


def verdict(figure):
    if figure["bar"] is None:
        return ""
    value, bar = figure["value"], figure["bar"]
    met = value >= bar if figure["unit"] in MORE_IS_BETTER else value <= bar
    return "ok" if met else MISSED


def as_row(figure):
    sign = "≥" if figure["unit"] in MORE_IS_BETTER else "≤"
    bar = "–" if figure["bar"] is None else f"{sign} {figure['bar']}"
    return f"| `{figure['name']}` | {figure['value']} | {figure['unit']} | {bar} | {verdict(figure)} |"


def growth_rows(values):
    for name, value in values.items():
        if match := re.fullmatch(r"path/step_(\d+)_rules", name):
            rules = int(match[1])
            yield f"| {rules:,} | {growth.behaviors_of(rules)} | {value:,} |"


def number(value):
    return "–" if value is None else f"{value:,}"


def workload_row(system, values):
    cells = [number(values[name]) for name in ("vm/W1", "vm/W2", "vm/W3", "vm/insn_per_op")]
    sizes = [values[f"vm/bytes_{name}"] for name in ("W1", "W2", "W3")]
    return f"| {system} | {' | '.join(cells)} | {'/'.join(map(str, sizes))} |"


def page(figures):
    values = {figure["name"]: figure["value"] for figure in figures}
    constants = ", ".join(str(values[f"vm/constants_{name}"]) for name in ("W1", "W2", "W3"))
    return "\n".join([
        HEAD, *map(as_row, figures), "",
        GROWTH, *growth_rows(values), "",
        WORKLOADS.format(constants=constants), workload_row(OURS, values),
        *(workload_row(system, peer) for system, peer in PEERS.items())])

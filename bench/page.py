"""docs/measurements.md: every figure, how cost grows with the rules, and what other VMs need."""

import json
import re
from pathlib import Path

import growth

PEERS = json.loads((Path(__file__).parent / "peers.json").read_text())
OURS = "**RoboSync**, all checks on"
MISSED = "MISSED"

HEAD = """# Measurements

`scripts/bench --markdown` prints this page. The unit `insn` is executed Cortex-M4 instructions, not cycles. A plugin counts them
exactly (`bench/count_plugin/`), in QEMU 7.2 for `mps2-an386` and in QEMU 10.0 for the other boards. Figures in bytes count what
the linker kept. Times are wall-clock time on the machine that printed this page, except those of `compile/…`, which are CPU time.
`scripts/bench --only GROUP` measures one group, such as `board`.

These files define each figure: `bench/figures.py`, `bench/workloads.py`, `bench/growth.py`, `bench/idle.py`, `bench/answer.py`,
`bench/compile_figures.py` and `bench/boards.py`. `bench/bars.json` holds the bars.

## Bars and recorded values

A bar is the limit that the design sets for a figure. Bars are not adjusted to the measurements: a figure that misses its bar is
shown as missed. `scripts/bench` fails in these cases, so that no figure grows unnoticed:

* A figure misses a bar that it met when it was recorded.
* A counted figure is more than 2 % above its value in `bench/recorded.json`.

Some figures vary from run to run, because other events fall into the measured interval at different times. Their tolerance is
higher: 5 to 50 % for the paths that start with a touch or a stop from this machine, and 100 % for `link/answer` and
`firmware/power_up_to_program`.

`scripts/bench --record` records the current values. `scripts/bench --profile NAME` shows which functions ran while a figure was
counted, and how many instructions each of them executed.

## Notes on single figures

Virtual machine:

* `vm/W1` ends when both commands are issued, as in the peers' measurements. `vm/W1_queue` is the same rule in the shipped
  firmware, until both commands are in their drivers' queues. It includes the claims, two threads and their context switches.
* `vm/W3_staged` is W3 in the shipped firmware, until the values that it has SET are staged for the next step.
* `vm/bytes_W3`: the response takes 88 bytes. The period of its EVERY takes 8 more; the peers' step has no such period.
* `vm/verify_per_word` is measured on the paper's image, which is mostly wiring and names. `vm/verify_64k` is measured on an image
  of 1,000 rules in 64 behaviours, at the format's limit of 64 KB (`image/largest_bytes`). That image is nearly all rules and
  code, which cost more per word.
* `vm/flash` has a bar for the whole language. The bar of the first design (4,096) covered only arithmetic and commands.
* `vm/ram_per_thread` is everything that a behaviour takes.

Kernel:

* Every context switch spends three instructions on the CPU time of threads. No peer's figure includes this.
* `kernel/yield_isolated` includes the second system call, with which the thread that now runs takes its events.
* `kernel/mailbox` misses its bar. It includes the comparison with the last reading, the timestamps and the announcement.
* `kernel/lock_out_add` is the lock-out time while threads are added, as when a program is loaded.

Path of a reading:

* `path/…` has no single expensive part. A quarter of the path to the command goes to three commands, which are decoded, queued
  and handed over. Another quarter goes to threads and their context switches. The rest is the step's bookkeeping for rules.
* `path/step_quiet` is a reading of a fed channel that fires nothing, from the call that feeds it to the end of the step. It is on
  the same side of each constant that rules compare the channel with as the reading before, so no rule is evaluated. This holds for
  channels that rules only compare with constants ([architecture.md](architecture.md#what-a-step-costs)).
  `path/step_quiet_crossing` is the worst case: the reading crosses the constant of a rule, which is evaluated and does not fire.
  A behaviour's thread is released for it, as for each reading of a channel with another use.
* `path/load_…` includes the search for these constants.
* `path/smooth_sample` is `vm/W3_natural` with the largest window, 32 samples, in the order that moves most of them. It includes
  the bands.

Firmware:

* `firmware/flash` exceeds its bar. Memory as large as the board, laid out for each program, took one kilobyte. Programs and
  numbers that survive a power cycle took four, algorithms four and a half, and the owner's signature ten and a half.
* `firmware/power_up_to_program` is the time until the paper's program, loaded from the board's store, begins. It ranges from
  8,000 to 15,000, depending on how often the host sends requests meanwhile.
* `firmware/idle_second_paper` excludes the code of the I2C bus, which the processor drives bit by bit.
  `firmware/idle_second_paper_i2c` is that alone.
* `i2c/…_sample` is a sample of a sensor on I2C: the driver's call that asks for it, the bus interrupts, and the driver's call that
  takes the bytes. QEMU has neither the I2C masters nor the motion sensors of the other boards. So a test plays both through the
  debugger, and counts the instructions of the shipped firmware meanwhile (`bench/bus.py`). The sensor's thread wakes twice
  for a sample; the most that each takes, `wake_by_timer` of the board's `costs.def`, is added: 900 in all, and 700 on the
  reference board. There the processor drives the bus itself, and `i2c/max34451_sample` is the sample of the paper's touch sensor, with
  75 interrupts. `i2c/longest_hold_mps2` is the longest of them: nothing that the bus does holds a behaviour up for longer.
* `ear/block` is the work for 20 ms of sound at the most expensive pitch, on the micro:bit V2; `ear/spectrum` that for its spectrum, which
  `own_words` reads.

Safety and link:

* `safety/stop_frame_to_safe_loaded` is the maximum of 20 stops. This machine chooses their moments, not the robot. It is about
  560 if no stop arrives while the tick, or a thread that blocks context switches, handles dozens of threads. The highest value
  seen is 1,584, which stays recorded.
* `link/answer` is how long a host waits for an answer if the robot's program leaves the link no processor time. It runs from the
  last byte of the request until the answer is ready for the line. It is the maximum of 160 requests at random times.

### Other boards

`b-l475e-iot01a/…`, `microbit-v2/…` and `nucleo-l476rg/…` are figures of the shipped firmware of these boards. They have the
bars of the reference board, but none for flash and RAM.

* QEMU does not emulate the I2C buses of these boards. So the benchmark plays the touch sensor through QEMU's debugger port. It
  takes the place of the driver's function, before the reading is in its mailbox. Only the firmware's instructions are counted.
* Readings, and the bytes of `rsc monitor`'s first messages, arrive when the firmware reaches a certain place. So each figure is
  the same in every run, to the instruction.
* `power_up_to_first_step` runs from reset until the first step of the paper's program begins. It is in the emulator's time, 16 ns
  per instruction. The firmware itself stored the program in its flash before.
* QEMU can only read the flash of `b-l475e-iot01a` and `nucleo-l476rg`. There, a debugger performed the erasing and writing while
  the program was stored.

### Compiler

`compile/…` is the CPU time of `rsc check`, including its start, on the machine that printed this page
(`bench/compile_figures.py`).

* `lines_per_second`: a program of 100,000 lines. It has 2,500 lines of rules of every kind, about as many as an image holds; the
  rest is TEST blocks. All of it is compiled; its one error is that no board could run all these rules in time.
* `rule_lines_per_second`: only these rules, which are also optimised and translated. The time for the paper's program is
  subtracted.
* `paper`: the paper's program.
* `growth_…`: something 2n times, compared with n times, in correct and incorrect programs (`bench/compile_programs.py`). The time
  for the paper's program is subtracted from both. `growth_of_memory` is the largest growth of memory of all these programs.

A missed bar in `ms`, `lines/s` or `x` is shown but does not fail, because the machine may be slow. Only a `compile/growth_…`
above 3 fails. Below that, other work on the machine may be the reason: it changes the ratios of CPU times by some tenths.

## Figures

| figure | value | unit | bar | |
|---|---|---|---|---|"""

GROWTH = """## Idle rules

One reading is fed that concerns a single rule among N. The rules are spread evenly over the behaviours, and each has its own
response (`bench/growth.py`). The table shows the instructions from the reading to the end of the step and of everything that
follows from it. This includes the kernel and the driver's command. The runtime is linked as in the firmware
(`bench/firmware/step_bench.cpp`). Up to 40 rules are in 10 behaviours, more rules are in 64. The benchmark has more memory for
programs than the board.

Before the measurement, each channel has its first reading. The first step of a behaviour evaluates all of its rules, so these
steps cost more, once: `path/first_step_…`.

| rules | behaviours | instructions of the step |
|---|---|---|"""

WORKLOADS = """## Comparison with other virtual machines

The table compares the same three workloads, in instructions:

* W1: the paper's rule, from setting the reading until both commands are issued.
* W2: one round of `s = s + i * i mod 251` with whole numbers.
* W3: one step of a mean of eight readings with hysteresis; the readings are shifted by hand.

Their sources are in `examples/touch_companion` and `bench/programs`. `vm/W3_natural` above is the cost of W3 as users of RSL
write it: a CHECK with SMOOTH and MARGIN. It runs from the new reading to its band, in the runtime, and uses a median, not a mean.
The last column is the size of the code of W1, W2 and W3. RoboSync's programs also have {constants} bytes of constants.

The peers were measured once, for the design of this VM, on their own sources and in the same way: arm-none-eabi-gcc
12.2, -O2, hard float, QEMU 7.2 (`-M mps2-an386 -icount shift=0`). The counts are exact where a plugin counted, and accurate to 40
instructions where SysTick did. The peers' W2 and W3 use whole numbers. `scripts/bench` does not measure the peers again
(`bench/peers.json`).

| system | W1 | W2, per round | W3, per step | instructions per opcode, on W2 | bytes W1/W2/W3 |
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

"""The measurements: each function returns {name: (value, unit)}. The bars are in bars.json."""

import os
import re
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from unittest import mock

import kept
import rsc
from board import FAST, FIRMWARE, Board
from counting import BUILT, ROOT, BenchError, return_instructions, run, symbols
from tap import Tap
from workloads import PAPER

SPIN = 2_000_001  # instructions of spin() in bench/firmware/kernel_bench.cpp


def compile_example(folder, *options):
    image = Path(folder) / "paper.rsb"
    rsc.run("compile", PAPER, "-o", image, *options)
    return image


def image_figures():
    """Bytes of the paper's program, with wiring and names: without the table of source lines, as `rsc upload` sends it,
    and with it."""
    with tempfile.TemporaryDirectory() as folder:
        with_lines = compile_example(folder).stat().st_size
        size = compile_example(folder, "--strip").stat().st_size
    return {
        "image/paper_bytes": (size, "B"),
        "image/paper_bytes_with_lines": (with_lines, "B"),
    }


def tool_figures():
    """What `scripts/build --prefix` installs on a computer."""
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run(["cmake", "--install", ROOT / "build/host", "--prefix", folder, "--component", "tool",
                        "--strip"], check=True, stdout=subprocess.DEVNULL)
        size = sum(path.stat().st_size for path in Path(folder).rglob("*") if path.is_file())
    return {"tool/size": (size, "B")}


def opcode_spans(marks):
    """{opcode: [worst-case instructions in a condition or response, including dispatch]}."""
    listed = re.findall(r"^OPCODE\((\w+),.*?(\w+),\s*\w+,\s*(\d+),\s*\"",
                        (ROOT / "vm/opcodes.def").read_text(), re.M)
    counts, index, start = {name: {} for name, *_ in listed}, -1, 0
    for mark, count in marks.all:
        if mark == "mark_next_opcode":
            index += 1
        elif mark in ("mark_condition_begin", "mark_response_begin"):
            start = count
        elif mark in ("mark_condition_end", "mark_response_end"):
            of = counts[listed[index][0]]
            of[mark] = max(of.get(mark, 0), count - start)
    if index + 1 != len(listed):
        raise BenchError("the bench firmware was built from another opcodes.def")
    base = {mark: counts[end][mark]
            for mark, end in (("mark_condition_end", "ret"), ("mark_response_end", "end"))}
    # The cost of an opcode that ends or pauses includes entering and leaving the code.
    leaves = {"end", "pause", "poll_begin", "poll_end"}
    return {name: (max(worst - (0 if flow in leaves else base[mark])
                       for mark, worst in counts[name].items()), int(declared))
            for name, flow, declared in listed}


def opcode_figures():
    spans = opcode_spans(run(BUILT / "bench_vm"))
    over = {name: costs for name, costs in spans.items() if costs[0] > costs[1]}
    for name, (measured, declared) in over.items():
        print(f"opcode {name} takes {measured} instructions, declared are {declared}", file=sys.stderr)
    return {
        "vm/opcodes_over_declared_cost": (len(over), ""),
        "vm/opcodes_slack": (max(declared - measured for measured, declared in spans.values()),
                             "insn"),
    }


def tick_cost(marks):
    """Instructions that a tick adds to a spinning thread."""
    costs, ticks, start = [], 0, 0
    for name, count in marks.all:
        if name == "mark_spin_begin":
            ticks, start = 0, count
        elif name == "SysTick_Handler":
            ticks += 1
        elif name == "mark_spin_end" and ticks:
            costs.append((count - start - SPIN) / ticks)
    if not costs:
        raise BenchError("no tick came while the thread was spinning")
    return round(max(costs), 1)


def switches(marks, begin, end):
    """Instructions of each context switch from `begin` to `end`, including both. The handler has two ends: into a
    privileged thread, and into an unprivileged one (port/cortex-m4/switch.S)."""
    ends = [(name, count) for name, count in marks.all
            if name.startswith(("PendSV", "return"))]
    found = [last - first + 1 for (first_name, first), (last_name, last) in zip(ends, ends[1:])
             if (first_name, last_name) == (begin, end)]
    if not found:
        raise BenchError(f"no switch from {begin} to {end}")
    return found


def yields(marks, to):
    """Instructions from where a thread yields to another one until that one's call, in which it had left the processor,
    has returned."""
    ends = [mark for mark in marks.all if mark[0] in ("mark_yields", "mark_high_runs", "mark_open_runs")]
    return [last - first for (begin, first), (end, last) in zip(ends, ends[1:])
            if (begin, end) == ("mark_yields", to)]


def kernel_figures_of(marks):
    """Worst-case costs of the kernel's operations, in instructions."""
    return {
        "switch": max(switches(marks, "PendSV_Handler", "return")),
        "switch_isolated": max(switches(marks, "PendSV_Unprivileged_Handler", "return_open")),
        "yield": max(yields(marks, "mark_high_runs")),
        "yield_isolated": max(yields(marks, "mark_open_runs")),
        "post_to_run_isolated": max(marks.spans("mark_post_open", "mark_open_runs")),
        "block_isolated": max(marks.spans("mark_open_blocks", "mark_low_runs_again")),
        "irq_to_thread_isolated": max(marks.spans("mark_pend_open", "mark_open_runs")),
        "post_to_run": max(marks.spans("mark_post", "mark_high_runs")),
        "block": max(marks.spans("mark_high_blocks", "mark_low_runs")),
        "irq_to_thread": max(marks.spans("mark_pend", "mark_high_runs")),
        "timed_post_to_run": max(marks.spans("mark_post_timed", "mark_timed_runs")),
        "timed_block": max(marks.spans("mark_timed_blocks", "mark_low_runs_after_timed")),
        "mutex": max(marks.spans("mark_mutex_begin", "mark_mutex_end")),
        "mailbox": max(marks.spans("mark_reading_sent", "mark_reading_there")),
        "tick": tick_cost(marks),
        "tick_to_sleeper": max(marks.spans("SysTick_Handler", "mark_sleeper_runs")),
    }


CORE = (ROOT / "runtime-m4/port/cortex-m4/core.hpp").read_text("utf-8")
# Lock masks interrupts up to the kernel's level; SwitchLock masks only the context switch.
KERNEL_LEVEL, SWITCH_LEVEL = (int(re.search(rf"{name} = (0x\w+);", CORE)[1], 16)
                              for name in ("kKernelPriority", "kSwitchPriority"))


def lock_out(raised, marks):
    """The most consecutive instructions with BASEPRI at the kernel's level: how long an interrupt may be masked.
    `raised`: raised_levels()."""
    longest, levels, since = 0, [], 0
    for name, count in marks.all:
        if not name.startswith("basepri"):
            continue
        held = KERNEL_LEVEL in levels
        if name in raised:
            levels.append(raised[name])
        elif levels:
            levels.pop()
        else:
            levels.append(KERNEL_LEVEL)  # OnlyLock writes BASEPRI directly, and is never nested
        if not held and KERNEL_LEVEL in levels:
            since = count
        elif held and KERNEL_LEVEL not in levels:
            longest = max(longest, count - since)
    return longest


def idle_figures_of(marks):
    """A second in which no thread has anything to do: how often the core wakes, and how many instructions it executes.
    Also the longest stretch around the sleep with all interrupts masked."""
    [second] = marks.parts("mark_idle", "mark_idled")
    return {
        "kernel/idle_wakes": (sum(name == "robosync_count_sleep" for name, _ in second.all), "1/s"),
        "kernel/idle_second": (marks.spans("mark_idle", "mark_idled")[0], "insn"),
        "kernel/idle_lock_out": (max(marks.spans("robosync_idle_masks", "robosync_idle_unmasks")),
                                 "insn"),
    }


def listing_of(elf):
    return subprocess.run(["arm-none-eabi-objdump", "-d", str(elf)], check=True, text=True,
                          stdout=subprocess.PIPE).stdout


def basepri_instructions(elf):
    """{name: address} of the instructions that write BASEPRI."""
    found = re.findall(r"^\s*([0-9a-f]+):.*\tmsr\tBASEPRI", listing_of(elf), re.M)
    return {f"basepri {address}": int(address, 16) for address in found}


def raised_levels(elf):
    """{name: level} of the instructions that raise BASEPRI: the last value moved into their register."""
    levels, moved = {}, {}
    for line in listing_of(elf).splitlines():
        if move := re.search(r"\tmov[sw.]*\t(\w+), #(\d+)", line):
            moved[move[1]] = int(move[2])
        elif raises := re.match(r"\s*([0-9a-f]+):.*\tmsr\tBASEPRI_MAX, (\w+)", line):
            levels[f"basepri {raises[1]}"] = moved[raises[2]]
    if not set(levels.values()) <= {KERNEL_LEVEL, SWITCH_LEVEL}:
        raise BenchError(f"BASEPRI is raised to levels that are none: {levels}")
    return levels


def kernel_figures():
    """Each figure with 64 threads, and the largest growth of any figure since there were 7."""
    elf = BUILT / "bench_kernel"
    places = {name: symbols(elf)[name]
              for name in ("SysTick_Handler", "PendSV_Handler", "PendSV_Unprivileged_Handler",
                           "robosync_count_sleep", "robosync_idle_masks", "robosync_idle_unmasks")}
    returns = return_instructions(elf, "PendSV_Handler")
    if len(returns) != 2:
        raise BenchError(f"PendSV_Handler returns at {len(returns)} places")
    places["return"], places["return_open"] = returns
    marks = run(elf, extra={**places, **basepri_instructions(elf)})
    parts = marks.parts("mark_measure", "mark_measured")
    [all_due] = marks.parts("mark_wake_all", "mark_all_woken")
    few, *_, many = map(kernel_figures_of, parts)
    raised = raised_levels(elf)
    return {
        **{f"kernel/{name}": (value, "insn") for name, value in many.items()},
        "kernel/growth_to_64_threads": (max(many[name] - few[name] for name in many), "insn"),
        "kernel/lock_out": (max(lock_out(raised, part) for part in parts), "insn"),
        "kernel/set_priority": (max(marks.spans("mark_set_priority", "mark_priority_set")), "insn"),
        "kernel/lock_out_add": (max(lock_out(raised, part)
                                    for part in marks.parts("mark_add", "mark_added")), "insn"),
        "kernel/lock_out_all_due": (lock_out(raised, all_due), "insn"),
        **idle_figures_of(marks),
        "kernel/tcb": (symbols(elf)["size_tcb"], "B"),
    }


def sections_by_object(map_file):
    """[(object file, section, bytes)] of what the linker kept."""
    text = Path(map_file).read_text().split("Linker script and memory map", 1)[1]
    text = re.sub(r"^( \.\S+)\n +", r"\1 ", text, flags=re.M)  # long names are on their own line
    found = re.findall(r"^ (\.\S+) +(0x[0-9a-f]+) +(0x[0-9a-f]+) (\S+)$", text, re.M)
    return [(path, section, int(size, 16)) for section, address, size, path in found]


def sources_in(*folders):
    return {path.name for folder in folders for path in (ROOT / folder).iterdir()
            if path.suffix in (".cpp", ".S")}


def flash_of(map_file, names):
    """Bytes in flash of these sources. The map names objects by file name only."""
    loaded = (".text", ".rodata", ".data", ".init_array")
    return sum(size for path, section, size in sections_by_object(map_file)
               if section.startswith(loaded) and "robosync" in path
               and re.sub(r".*[/(](.*?)\.obj\)?$", r"\1", path) in names)


def firmware_flash():
    """The size of what is flashed to a board."""
    if not FIRMWARE.exists():
        raise BenchError(f"no {FIRMWARE}: build the preset {FIRMWARE.parent.name} first")
    listing = subprocess.run(["arm-none-eabi-size", str(FIRMWARE)], check=True, text=True,
                             stdout=subprocess.PIPE).stdout
    text, data = (int(word) for word in listing.splitlines()[1].split()[:2])
    return text + data


def size_figures():
    link_map = FIRMWARE.with_suffix(".map")
    vm = sources_in("vm")
    verifier = {name for name in vm if name.startswith("verif") or name in ("image.cpp", "opcode_traits.cpp")}
    kernel = sources_in("runtime-m4/kernel", "runtime-m4/port/cortex-m4")
    return {
        "vm/flash_interpreter": (flash_of(link_map, vm - verifier), "B"),
        "vm/flash_verifier": (flash_of(link_map, verifier), "B"),
        "vm/flash": (flash_of(link_map, vm), "B"),
        "kernel/flash": (flash_of(link_map, kernel), "B"),
        "firmware/flash": (firmware_flash(), "B"),
    }


def link_figures():
    """Uploads the paper's program over a line of 115,200 baud, timed from the start of rsc to its end."""
    with tempfile.TemporaryDirectory() as folder, Board() as board:
        image = compile_example(folder, "--strip")
        # Ignores what rsc remembers of another board with this number.
        with mock.patch.dict(os.environ, XDG_CACHE_HOME=str(Path(folder) / "cache")), Tap(folder, board.port) as tap:
            begin = time.monotonic()
            rsc.run("upload", image, "--port", tap.port)
            seconds = time.monotonic() - begin
            wire = tap.wire_seconds(image.stat().st_size)
            both_ways = tap.wire_seconds(tap.to_board + tap.to_host)
    return {
        "link/upload_time": (round(1000 * seconds), "ms"),
        "link/upload_over_wire_time": (round(seconds / wire, 1), "x"),
        "link/bytes_over_image_bytes": (round(both_ways / wire, 2), "x"),
    }


def signature_figures():
    """What the link thread does for each order to a robot that has an owner."""
    [instructions] = run(BUILT / "bench_verify").spans("mark_verify_begin", "mark_verify_end")
    return {"link/verify_signature": (instructions, "insn")}


def ear_figures():
    """What a board with a microphone would need for 20 ms of sound: the most expensive of many blocks."""
    marks = run(BUILT / "bench_ear")
    return {f"ear/{name}": (max(marks.spans(f"mark_{mark}_begin", f"mark_{mark}_end")), "insn")
            for name, mark in (("block", "ear"), ("spectrum", "spectrum"))}


def algorithms_figures():
    """What own_words does for 20 ms of sound while it recognises a word: the most expensive of many blocks."""
    return {"algorithms/own_words": (max(run(BUILT / "bench_words").spans("mark_words_begin", "mark_words_end")), "insn")}


def power_up_figures():
    """From power-up to program time 0 of the paper's program, which the board has kept."""
    with tempfile.TemporaryDirectory() as folder:
        store = kept.store_with(compile_example(folder, "--strip"), folder)
        with Board(icount=FAST, store=store) as board:
            status = kept.wait_until_kept(board.port)["status"]
    return {"firmware/power_up_to_program": (status["uptime_us"] - status["program_us"], "us")}

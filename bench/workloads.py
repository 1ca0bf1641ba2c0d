"""The workloads W1 to W3 (bench/programs; W1 is the paper's program): what they cost in the shipped interpreter, and
whether their results match the same computation in Python."""

import random
import re
import tempfile
from pathlib import Path

import rsc
from counting import BUILT, ROOT, BenchError, run_given

PROGRAMS = ROOT / "bench/programs"
PAPER = ROOT / "examples/touch_companion/robot.rsl"
W1, W2, W3, W3_NATURAL = (PAPER, *(PROGRAMS / name / "robot.rsl"
                                   for name in ("w2", "w3", "w3_natural")))
ROUNDS = 1000  # of W2's loop
NEAR, FAR = 500_000, 600_000  # thousandths of a millimetre: 50cm, 60cm
SAMPLES = 8
MOST_SAMPLES = 32  # vm::kMaxWindow

# A person comes closer, turns round between the two limits, goes away, and comes straight back.
DISTANCES = tuple(1000 * mm for mm in (
    *range(900, 380, -40), *[470] * 6, 555, *[590] * 9, 610, 601, *[599, 620] * 5, *[1234] * 4,
    *[333] * 9, 20, 4000, 501, 499))


class Workload:
    """A program, compiled as users do it. Its first rule runs once for each reading."""

    def __init__(self, folder, source, readings):
        image = Path(folder) / f"{source.parent.name}.rsb"
        rsc.run("compile", source, "-o", image)
        self.words = image.stat().st_size // 4
        self.dump = rsc.run("dump", image)
        self.marks = run_given(BUILT / "bench_workload", image, readings)
        self.spans = self.marks.spans("mark_rule_begin", "mark_rule_end")
        if len(self.spans) != len(readings):
            raise BenchError(f"{source} ran {len(self.spans)} times, not {len(readings)}")

    def number(self, pattern):
        found = re.search(pattern, self.dump, re.M)
        if not found:
            raise BenchError(f"rsc dump does not say {pattern}")
        return int(found[1])

    def bytes_of(self, part):
        return 4 * self.number(rf"^  {part} +(\d+) x")

    def inputs(self):
        """[{name: value}] after each run."""
        names = re.findall(r"^  cell \d+ = (.+)$", self.dump, re.M)
        return [dict(zip(names, values)) for values in self.marks.heard("inputs")]


def expect(what, wanted, got):
    """Raises if a workload has another result, because then it has not done the work that is measured."""
    if wanted != got:
        raise BenchError(f"{what} came to {got}, not to {wanted}")


def w1(folder):
    work = Workload(folder, W1, range(0, 6000, 1000))
    expect("W1", [[2]] * 6, work.marks.heard("words"))  # each response has two commands
    return work


def w2(folder):
    work = Workload(folder, W2, [0])
    total = sum(i * i % 251 for i in range(ROUNDS))
    expect("W2", [{"i": 1000 * ROUNDS, "s": 1000 * total}], work.inputs())
    return work


def mean(taps):
    return (sum(taps) + SAMPLES // 2) // SAMPLES  # none is negative


def filtered(readings):
    """[{name: value}] of W3's variables after each reading."""
    taps, side = [0] * SAMPLES, 0
    for reading in readings:
        taps = [reading, *taps[:-1]]
        side = 1000 if mean(taps) < NEAR else 0 if mean(taps) > FAR else side
        yield {**{f"x{i}": tap for i, tap in enumerate(taps)}, "side": side}


def w3(folder):
    work = Workload(folder, W3, DISTANCES)
    got = [{name: value for name, value in values.items() if "DISTANCE" not in name}
           for values in work.inputs()]
    expect("W3", list(filtered(DISTANCES)), got)
    return work


def median(samples):
    return sorted(samples)[(len(samples) - 1) // 2]


def bands(readings, window=SAMPLES):
    """[(whether it changed, band)] of W3's CHECK after each reading: 0 near, 1000 far."""
    band = None
    for i in range(len(readings)):
        value = median(readings[max(0, i + 1 - window):i + 1])
        before, limit = band, FAR if band == 0 else NEAR - 1
        band = 0 if value <= limit else 1000
        yield ["same" if band == before else "changed", band]


def w3_natural(folder, readings=DISTANCES, window=SAMPLES):
    """Instructions from each new reading to its band."""
    program, image = Path(folder) / "check.rsl", Path(folder) / "check.rsb"
    text = W3_NATURAL.read_text()
    program.write_text(text.replace(f"SMOOTH OVER {SAMPLES * 50}ms", f"SMOOTH OVER {window * 50}ms"))
    rsc.run("compile", program, "--config", W3_NATURAL.with_suffix(".json"), "-o", image)
    marks = run_given(BUILT / "bench_check", image, readings)
    expect("W3's CHECK", list(bands(readings, window)), marks.said)
    return marks.spans("mark_check_begin", "mark_check_end")


def smooth_readings():
    """Series that move the values in a window in every way: rising, falling, both, constant, and random."""
    random_ = random.Random(1)
    rising = [1000 * mm for mm in range(100, 1000, 9)]
    return (*rising, *reversed(rising), *[500_000] * MOST_SAMPLES, *rising[::3], *rising[::-3],
            *(random_.randrange(20_000, 4_000_000) for _ in range(300)), *[20_000, 4_000_000] * MOST_SAMPLES)


def smoothing_figures():
    with tempfile.TemporaryDirectory() as folder:
        return {"vm/W3_natural": (max(w3_natural(folder)), "insn"),
                "path/smooth_sample": (max(w3_natural(folder, smooth_readings(), MOST_SAMPLES)), "insn")}


def workload_figures():
    with tempfile.TemporaryDirectory() as folder:
        one, two, three = w1(folder), w2(folder), w3(folder)
    per_round = two.spans[0] / ROUNDS
    opcodes = two.number(r"\bagain +r\d+, -(\d+)")  # the jump back: the loop has no branches
    verify = one.marks.spans("mark_verify_begin", "mark_verify_end")[0]
    works = {"W1": one, "W2": two, "W3": three}
    return {
        "vm/W1": (max(one.spans), "insn"),
        "vm/W2": (round(per_round, 1), "insn"),
        "vm/W3": (max(three.spans), "insn"),
        "vm/insn_per_op": (round(per_round / opcodes, 1), "insn"),
        "vm/verify_per_word": (round(verify / one.words, 1), "insn"),
        **{f"vm/bytes_{name}": (work.bytes_of("code"), "B") for name, work in works.items()},
        **{f"vm/constants_{name}": (work.bytes_of("constants"), "B") for name, work in works.items()},
    }

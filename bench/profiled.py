"""scripts/bench --profile NAME: shows what ran while a figure was counted, function by function.

A figure that is counted between two marks knows which instructions ran (counting.Count). They are added up by the
functions of the ELF, and by those of the source, because most of these are inlined.
"""

import bisect
import collections
import subprocess

import counting
import growth
import path
import safety
import workloads
from board import FIRMWARE

# The groups whose figures are counted between marks, and the ELF that runs.
GROUPS = ((growth.growth_figures, growth.FIRMWARE), (path.path_figures, FIRMWARE), (safety.calm_figures, FIRMWARE),
          (safety.loaded_figures, FIRMWARE),
          (workloads.workload_figures, counting.BUILT / "bench_workload"),
          (workloads.smoothing_figures, counting.BUILT / "bench_check"))


def find(name):
    """Returns (the figure's value, the ELF that ran)."""
    counting.profiling = True
    for figures, elf in GROUPS:
        value, _ = figures().get(name, (None, None))
        if isinstance(value, counting.Count):
            return value, elf
    raise counting.BenchError(f"{name} is not counted between marks")


def by_address(count):
    found = collections.Counter()
    for line in count.places:
        for address, executed in line:
            found[address] += executed
    return found


def by_symbol(executed, elf):
    known = sorted((at, name) for name, at in counting.symbols(elf).items() if not name.startswith("$"))
    starts, found = [at for at, _ in known], collections.Counter()
    for address, times in executed.items():
        found[known[bisect.bisect_right(starts, address) - 1][1]] += times
    return found


def by_source(executed, elf):
    found = collections.Counter()
    listing = subprocess.run(["arm-none-eabi-addr2line", "-f", "-C", "-s", "-e", str(elf), *map(hex, executed)],
                             check=True, text=True, stdout=subprocess.PIPE).stdout.splitlines()
    for times, function, place in zip(executed.values(), listing[::2], listing[1::2]):
        found[f"{function}  ({place.split(':')[0]})"] += times
    return found


def table(title, found):
    yield f"{sum(found.values()):9} {title}"
    for name, times in found.most_common():
        yield f"{times:9} {name}"


def show(name):
    count, elf = find(name)
    executed = by_address(count)
    for kind, found in (("functions as linked", by_symbol(executed, elf)), ("as written", by_source(executed, elf))):
        print(*table(f"{name}, {kind}", found), "", sep="\n")

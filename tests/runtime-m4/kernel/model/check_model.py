#!/usr/bin/env python3
"""Has spin check the models of switching and waking (switch.pml) and of uploads and the store (update/model/upload.pml)
in every order, then each of their mutants, in which it must find the mistake. Ends with "N passed, N failed".

usage: tests/runtime-m4/kernel/model/check_model.py
"""

import re
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

HERE = Path(__file__).resolve().parent
# With the fewest states of the model without a mutant: fewer would mean that it got stuck.
MODELS = {HERE / "switch.pml": 1_000_000, HERE.parents[1] / "update/model/upload.pml": 100_000}
DEPTH = 500_000


def search(model, mutant):
    """(states, errors) that spin has found over all orders, or until the first error."""
    with tempfile.TemporaryDirectory(prefix="robosync-model-") as folder:
        for command in (["spin", "-a", *([f"-D{mutant}"] if mutant else []), str(model)],
                        ["gcc", "-w", "-O0", "-DSAFETY", "-DMEMLIM=1000", "-o", "pan", "pan.c"]):
            subprocess.run(command, cwd=folder, check=True, stdout=subprocess.DEVNULL)
        output = subprocess.run(["./pan", f"-m{DEPTH}"], cwd=folder, check=True, text=True,
                                stdout=subprocess.PIPE).stdout
    if "max search depth too small" in output or "Search not completed" in output and not mutant:
        return 0, -1
    states = re.search(r"(\d+) states, stored", output)
    errors = re.search(r"errors: (\d+)", output)
    return int(states[1]), int(errors[1])


def judge(job):
    """(passed, line to print)"""
    model, mutant = job
    states, errors = search(model, mutant)
    if not mutant:
        good = errors == 0 and states >= MODELS[model]
        return good, f"{model.stem}: {'no mistake' if good else f'{errors} errors'} in {states:,} states"
    good = errors > 0
    return good, f"{model.stem}, {mutant.lower()}: {'found' if good else 'NOT FOUND'} after {states:,} states"


def main():
    jobs = [(model, mutant) for model in MODELS
            for mutant in [None, *sorted(set(re.findall(r"\bMUTANT_[A-Z_]*[A-Z]\b", model.read_text())))]]
    with ThreadPoolExecutor() as pool:
        results = list(pool.map(judge, jobs))
    for good, line in results:
        print("ok  " if good else "FAIL", line)
    failed = sum(not good for good, _ in results)
    print(f"{len(results) - failed} passed, {failed} failed")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())

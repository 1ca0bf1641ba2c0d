"""scripts/mutate: runs the tests once for each check of the verifier, with that check removed.

Assumes that build/host is built. The sources with a switch at every check (checks.py) are compiled and
linked once, with the objects of build/host for the rest; which check is off is chosen at run time.
"""

import argparse
import json
import os
import random
import shlex
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import checks

ROOT = Path(__file__).resolve().parents[2]
HOST = ROOT / "build/host"
WORK = ROOT / "build/mutation"
REDUNDANT = Path(__file__).with_name("redundant.txt")
SEEDS = HOST / "tests/fuzz/seeds"
TIMEOUT = 120
# What is run, until one of them fails: the verifier's own tests, which are quick, then the rest.
OWN_TESTS = "".join(f"[#{path.stem}]," for pattern in ("verifier_*", "owned_*", "fused_*", "image_*")
                    for path in sorted((ROOT / "tests/vm").glob(pattern + "test.cpp")))


def fuzz(images, seed):
    return ("fuzz_images", "--images", str(images), "--seed", str(seed), "--seeds", str(SEEDS),
            "--saved", "/dev/null")


STAGES = (("test_vm", "--abort", "--filenames-as-tags", OWN_TESTS.rstrip(",")), fuzz(20_000, 1),
          ("test_vm", "--abort"), fuzz(200_000, 2))
QUICK = STAGES[:2]


def sources():
    """[(path, only this function)] of what is looked through, in a fixed order."""
    vm = sorted((ROOT / "vm").glob("verif*.cpp")) + sorted((ROOT / "vm").glob("verif*.hpp"))
    return [(path, None) for path in vm] + [(ROOT / "vm/image.cpp", "view_image")]


def write_instrumented():
    """Every check, in the order of its number from 1 on; and the sources to compile."""
    found, compiled = [], []
    (WORK / "vm").mkdir(parents=True, exist_ok=True)
    (WORK / "mutant.hpp").write_text(checks.HEADER)
    for path, only in sources():
        name, text = path.relative_to(ROOT).as_posix(), path.read_text()
        here = checks.find_checks(name, text, only)
        instrumented = checks.instrument(text, here, len(found) + 1)
        target = WORK / name
        if not target.exists() or target.read_text() != instrumented:
            target.write_text(instrumented)
        found += here
        if path.suffix == ".cpp":
            compiled.append(target)
    return found, compiled


def compile_command(source):
    """As build/host compiles the original, but for the place and the instrumented headers."""
    original = str(ROOT / source.relative_to(WORK))
    commands = json.loads((HOST / "compile_commands.json").read_text())
    entry = next(c for c in commands if c["file"] == original and "robosync_vm.dir" in c["command"])
    words = shlex.split(entry["command"])
    words[words.index("-o") + 1] = str(source.with_suffix(".o"))
    words[words.index("-c") + 1] = str(source)
    at = next(i for i, word in enumerate(words) if word.startswith("-I"))
    return words[:at] + [f"-I{WORK}", "-O1", "-Wno-error"] + words[at:]


def link_command(target, objects):
    """As build/host links `target`, with `objects` instead of the ones from the same sources."""
    said = subprocess.run(["ninja", "-C", str(HOST), "-t", "commands", target], check=True, text=True,
                          stdout=subprocess.PIPE).stdout.splitlines()[-1]
    words = shlex.split(said.removeprefix(": && ").removesuffix(" && :"))
    replaced = {f"/vm/{path.name.removesuffix('.o')}.cpp.o" for path in objects}
    words = [w for w in words if not any(w.endswith(name) for name in replaced)]
    at = words.index("-o")
    words[at + 1] = str(WORK / Path(target).name)
    return words[:at] + [str(path) for path in objects] + words[at:]


def build(compiled):
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        list(pool.map(lambda s: subprocess.run(compile_command(s), cwd=HOST, check=True), compiled))
    objects = [source.with_suffix(".o") for source in compiled]
    for target in ("tests/vm/test_vm", "tests/fuzz/fuzz_images"):
        subprocess.run(link_command(target, objects), cwd=HOST, check=True)


def notices(stage, number):
    """Does this stage fail with the check of this number removed?"""
    try:
        done = subprocess.run([WORK / stage[0], *stage[1:]], check=False, timeout=TIMEOUT,
                              cwd=WORK, env={**os.environ, "ROBOSYNC_MUTANT": str(number)},
                              stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        return done.returncode != 0
    except subprocess.TimeoutExpired:
        return True


def caught_by(number, stages=STAGES):
    """The first stage that notices; None: a survivor."""
    return next((i for i, stage in enumerate(stages) if notices(stage, number)), None)


def read_redundant():
    """{key of a check: why nothing can notice that it is gone}."""
    lines = REDUNDANT.read_text().splitlines() if REDUNDANT.exists() else []
    pairs = (line.split(" ## ", 1) for line in lines if " ## " in line and not line.startswith("#"))
    return {key.strip(): reason.strip() for key, reason in pairs}


def report(results, redundant):
    survivors = [check for check, stage in results if stage is None]
    explained = [check for check in survivors if check.key() in redundant]
    for check in survivors:
        why = redundant.get(check.key())
        print(f"{check.file}:{check.line}: {check.text}" + (f"  (redundant: {why})" if why else ""))
    stages = [sum(stage == i for _, stage in results) for i in range(len(STAGES))]
    print(f"{len(results)} checks removed in turn: {stages[0] + stages[2]} noticed by tests/vm, "
          f"{stages[1] + stages[3]} only by the fuzzer, {len(explained)} redundant with a reason, "
          f"{len(survivors) - len(explained)} survivors")
    failed = len(survivors) - len(explained)
    print(f"{len(results) - failed} passed, {failed} failed")
    return 1 if failed else 0


def main():
    parser = argparse.ArgumentParser(prog="scripts/mutate")
    parser.add_argument("--sample", type=int)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--list", action="store_true")
    parser.add_argument("--quick", action="store_true")
    wanted = parser.parse_args()
    found, compiled = write_instrumented()
    if wanted.list:
        for number, check in enumerate(found, 1):
            print(f"{number:4} {check.file}:{check.line}: {check.kind} {check.text}")
        return 0
    build(compiled)
    stages = QUICK if wanted.quick else STAGES
    if caught_by(0, stages) is not None:
        print("the tests fail with every check in place\n0 passed, 1 failed")
        return 1
    numbers = range(1, len(found) + 1)
    if wanted.sample:
        numbers = sorted(random.Random(wanted.seed).sample(numbers, min(wanted.sample, len(found))))
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        caught = pool.map(lambda number: caught_by(number, stages), numbers)
        results = list(zip([found[n - 1] for n in numbers], caught))
    return report(results, read_redundant())


if __name__ == "__main__":
    sys.exit(main())

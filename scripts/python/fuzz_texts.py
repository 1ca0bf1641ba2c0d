"""scripts/fuzz --texts: runs libFuzzer on each target that reads texts from outside, on several cores.

A target starts with the examples, the kept inputs of earlier findings (tests/fuzz/texts/kept) and its corpus from
earlier runs (build/fuzz/texts/NAME), and mutates them. Assumes that build/host-fuzz is built.
"""

import argparse
import os
import re
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests/fuzz"))
import make_seeds  # noqa: E402  (found by the line before)

TEXTS = ROOT / "tests/fuzz/texts"
BUILT = ROOT / "build/host-fuzz/tests/fuzz/texts"
RSC = ROOT / "build/host-fuzz/rsc"
LEARNED = ROOT / "build/fuzz/texts"
FOUND = ROOT / "build/fuzz/found"
EXAMPLES = {"rsl": "*.rsl", "robot": "robot.json", "scenario": "*.json"}
LONGEST = {"lsp": 20_000}  # bytes of an input; a larger one takes longer and finds little more
MOST_SECONDS, MOST_MEGABYTES = 10, 2048  # for one input


def targets():
    return re.findall(r"^TARGET\((\w+),", (TEXTS / "targets.def").read_text(), re.M)


def words():
    """Keywords and keys, which mutations of single letters would not find."""
    keywords = re.findall(r"^KEYWORD\((\w+),", (ROOT / "compiler/syntax/keywords.def").read_text(), re.M)
    keys = re.findall(r'"(\w+)"', (ROOT / "compiler/config/keys.def").read_text())
    return sorted({*keywords, *keys})


def images(folder):
    """The images that the fuzzer of the verifier starts with, too: of the examples and of drawn programs."""
    make_seeds.make(RSC, LEARNED / "compiled")
    for old in folder.iterdir():
        old.unlink()
    for path in (LEARNED / "compiled").glob("*.rsb"):
        (folder / path.name).write_bytes(path.read_bytes())
    return folder


def starts_of(name):
    """Copies of the examples, in their own folder: a corpus is a folder."""
    folder = LEARNED / f"{name}-examples"
    folder.mkdir(parents=True, exist_ok=True)
    if name == "image":
        return images(folder)
    for path in (ROOT / "examples").rglob(EXAMPLES[name]) if name in EXAMPLES else ():
        (folder / "-".join(path.relative_to(ROOT).parts)).write_bytes(path.read_bytes())
    return folder


def fuzz(name, seconds, dictionary):
    """(name, whether nothing was found, libFuzzer's output)"""
    learned = LEARNED / name
    learned.mkdir(parents=True, exist_ok=True)
    kept = [folder for folder in [TEXTS / "kept" / name] if folder.is_dir()]
    command = [BUILT / f"fuzz_{name}", learned, starts_of(name), *kept,
               f"-max_total_time={seconds}", f"-max_len={LONGEST.get(name, 4096)}", f"-timeout={MOST_SECONDS}",
               f"-rss_limit_mb={MOST_MEGABYTES}", f"-dict={dictionary}", f"-artifact_prefix={FOUND}/{name}-",
               "-print_final_stats=1"]
    done = subprocess.run(command, check=False, text=True, errors="replace", stdin=subprocess.DEVNULL,
                          stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
    return name, done.returncode == 0, done.stderr


def number(said, name):
    found = re.findall(rf"stat::{name}:\s+(\d+)", said)
    return int(found[-1]) if found else 0


def main():
    parser = argparse.ArgumentParser(prog="scripts/fuzz --texts")
    parser.add_argument("seconds", type=int)
    parser.add_argument("targets", nargs="*", metavar="TARGET", help=f"of {', '.join(targets())}; all of them")
    parser.add_argument("--dry-run", action="store_true", help="only says what is wrong with the arguments")
    wanted = parser.parse_args()
    unknown = set(wanted.targets) - set(targets())
    if unknown:
        parser.error(f"no target {', '.join(sorted(unknown))}; there are: {', '.join(targets())}")
    if wanted.dry_run:
        return 0
    FOUND.mkdir(parents=True, exist_ok=True)
    LEARNED.mkdir(parents=True, exist_ok=True)
    dictionary = LEARNED / "words"
    dictionary.write_text("".join(f'"{word}"\n' for word in words()))
    failed = False
    with ThreadPoolExecutor(os.cpu_count() or 1) as pool:
        for name, fine, said in pool.map(lambda name: fuzz(name, wanted.seconds, dictionary), wanted.targets or targets()):
            failed |= not fine
            print(f"{name}: {number(said, 'number_of_executed_units')} inputs, "
                  f"{len(list((LEARNED / name).iterdir()))} kept to go on with, " +
                  ("nothing found" if fine else f"FOUND, see {FOUND}:\n{said[-4000:]}"), flush=True)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())

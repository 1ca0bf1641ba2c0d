"""Mutants that somebody has thought out: one promise of the sources broken at a time (scripts/mutate safety, scripts/mutate modules).

Each is a small change of one source. It is built as build/host builds the original, linked to a program of tests, and these run. Assumes
that build/host is built. The last line is "N passed, N failed": mutants that a test notices, and survivors, which none does, though it
could."""

import json
import os
import re
import shlex
import subprocess
import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).resolve().parents[2]
HOST = ROOT / "build/host"
WORK = ROOT / "build/mutation"
TIMEOUT = 120


class Mutant(NamedTuple):
    what: str
    file: str
    is_there: str
    instead: str
    unseen: str = ""  # why no test can notice
    through: str = ""  # of a header: the source that is compiled with it


class Suite(NamedTuple):
    """What is broken, and who should notice."""
    library: str  # that build/host makes of the sources
    program: str  # of tests, below build/host
    tests: str  # of the program, as Catch2 chooses them; empty: all
    mutants: tuple


def unity_of(suite, file, work):
    """The compilation that has this source among others, or alone: (its command, a source that includes them)."""
    for entry in json.loads((HOST / "compile_commands.json").read_text()):
        if f"{suite.library}.dir" not in entry["command"]:
            continue
        if entry["file"] == str(ROOT / file):
            alone = work / "alone.cpp"
            alone.write_text(f'#include "{ROOT / file}"\n')
            return shlex.split(entry["command"]), alone
        if str(ROOT / file) in Path(entry["file"]).read_text():
            return shlex.split(entry["command"]), Path(entry["file"])
    raise LookupError(f"build/host does not compile {file}")


def compile_mutant(suite, mutant, work):
    text = (ROOT / mutant.file).read_text()
    if text.count(mutant.is_there) != 1:
        raise LookupError(f"{mutant.file} does not have `{mutant.is_there}` once: bring the mutant up to date")
    changed = work / "changed" / mutant.file
    changed.parent.mkdir(parents=True)
    changed.write_text(text.replace(mutant.is_there, mutant.instead))
    words, unity = unity_of(suite, mutant.through or mutant.file, work)
    source, target = work / "unity.cpp", work / "mutant.o"
    source.write_text(unity.read_text().replace(str(ROOT / mutant.file), str(changed)))
    words.insert(2, f"-I{work / 'changed'}")  # for a header, which is found there first
    words[words.index("-o") + 1] = str(target)
    words[words.index("-c") + 1] = str(source)
    subprocess.run([*words, "-O1", "-g0", "-Wno-error", "-w"], cwd=HOST, check=True)
    return target


def link(suite, target, work):
    """The tests as build/host links them; what the mutant's object has, the library is not asked for."""
    said = subprocess.run(["ninja", "-C", str(HOST), "-t", "commands", suite.program], check=True, text=True,
                          stdout=subprocess.PIPE).stdout.splitlines()
    words = shlex.split(next(line for line in reversed(said) if f"-o {suite.program}" in line)
                        .removeprefix(": && ").split(" && ")[0])
    at = words.index("-o")
    words[at + 1] = str(work / "tests")
    subprocess.run([*words[:at], str(target), *words[at:]], cwd=HOST, check=True)


def noticed_by(suite, mutant):
    """The first test that fails; None: all pass."""
    with tempfile.TemporaryDirectory(dir=WORK) as name:
        work = Path(name)
        link(suite, compile_mutant(suite, mutant, work), work)
        try:
            done = subprocess.run([work / "tests", "--abort", "--filenames-as-tags", "--reporter", "xml", *filter(None, [suite.tests])],
                                  check=False, timeout=TIMEOUT, cwd=work, text=True, errors="replace", stdout=subprocess.PIPE,
                                  stderr=subprocess.DEVNULL)
        except subprocess.TimeoutExpired:
            return "it never ends"
    if done.returncode == 0:
        return None
    return (re.findall(r'<TestCase name="([^"]*)"', done.stdout) or ["it crashes"])[-1]


def run(suite):
    """Prints each mutant with the first test that notices; the exit code."""
    WORK.mkdir(parents=True, exist_ok=True)
    survivors = 0
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        for mutant, test in zip(suite.mutants, pool.map(lambda mutant: noticed_by(suite, mutant), suite.mutants)):
            survivors += test is None and not mutant.unseen
            nobody = f"nobody: {mutant.unseen}" if mutant.unseen else "NOBODY notices"
            print(f"{mutant.what} ({Path(mutant.file).name}): {test or nobody}", flush=True)
    print(f"{len(suite.mutants) - survivors} passed, {survivors} failed")
    return 1 if survivors else 0

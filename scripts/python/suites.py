"""The suites of scripts/test that are not separate programs: ctest, unittest, format, tidy.

Each prints its failures and ends with the line "N passed, N failed" that scripts/test adds up.
Exit code 0 if nothing failed and something ran, otherwise 1.
"""

import argparse
import faulthandler
import itertools
import json
import os
import re
import shlex
import signal
import subprocess
import sys
import tempfile
import unittest
import xml.etree.ElementTree as ElementTree
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from board import end_on_signals

ROOT = Path(__file__).resolve().parents[2]
OURS = ("compiler", "vm", "link", "runtime-m4", "analysis", "rsc", "tests", "bench", "scripts")
CORES = os.cpu_count() or 1


def close(passed, failed):
    print(f"{passed} passed, {failed} failed")
    return 0 if passed and not failed else 1


def count_cases(output, ok):
    """(passed, failed) test cases in the output of one program: Catch2's or unittest's; otherwise the program is one case."""
    if match := re.search(r"All tests passed \(.* in (\d+) test cases?\)", output):
        return int(match[1]), 0
    if match := re.search(r"^test cases:\s+(\d+) \|(?:\s+\d+ passed \|)?\s+(\d+) failed", output, re.M):
        return int(match[1]) - int(match[2]), int(match[2])
    if match := re.search(r"^Ran (\d+) tests? in", output, re.M):
        bad = sum(int(n) for n in re.findall(r"(?:failures|errors)=(\d+)", output))
        return int(match[1]) - bad, bad
    return (1, 0) if ok else (0, 1)


def run_ctest(preset, label=None):
    """Runs all tests, or those with this label. One more program than cores runs in parallel, since rsc's tests mostly wait."""
    with tempfile.TemporaryDirectory() as folder:
        report = Path(folder) / "report.xml"
        said = subprocess.run(["ctest", "--preset", preset, f"-j{CORES + 1}", *(["-L", label] if label else []),
                               "--output-junit", str(report),
                               "--test-output-size-passed", "1000000"],
                              cwd=ROOT, check=False, text=True, errors="replace", stdout=subprocess.PIPE).stdout
        cases = ElementTree.parse(report).getroot().findall("testcase") if report.exists() else []
    passed = failed = 0
    for case in cases:
        ok = case.get("status") == "run"
        output = case.findtext("system-out") or ""
        good, bad = count_cases(output, ok)
        bad = max(bad, 0 if ok else 1)  # a program that crashed does not report its cases
        print(f"  {'ok  ' if not bad else 'FAIL'} {case.get('name')} ({good} of {good + bad}, "
              f"{float(case.get('time') or 0):.1f} s)")
        if bad:
            print(output)
        passed, failed = passed + good, failed + bad
    # Prints how each of them ended: the report lacks the signal of a program that printed nothing.
    print(said.rpartition("The following tests FAILED:")[2] if failed else "", end="")
    return close(passed, failed)


def run_unittest(place):
    """`place`: a folder with tests, or one file in it."""
    end_on_signals()
    faulthandler.register(signal.SIGTERM, file=sys.stdout, chain=True)  # shows where a test hangs
    path = ROOT / place
    folder, pattern = (path, "test*.py") if path.is_dir() else (path.parent, path.name)
    tests = unittest.defaultTestLoader.discover(str(folder), pattern)
    result = unittest.TextTestRunner(stream=sys.stdout, verbosity=2).run(tests)
    failed = len(result.failures) + len(result.errors) + len(result.unexpectedSuccesses)
    return close(max(result.testsRun - failed - len(result.skipped), 0), failed)  # a test may fail several times


def own_sources(suffixes):
    return sorted(path for folder in OURS for path in (ROOT / folder).rglob("*")
                  if path.suffix in suffixes)


FILES_AT_ONCE = 40  # starting clang-format takes longer than checking a file


def checked(command, paths):
    """What the command finds in these files: [(path, what)]. If it finds something, it checks each file separately."""
    answer = subprocess.run([*command, *map(str, paths)], cwd=ROOT, check=False, text=True,
                            stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    if answer.returncode == 0:
        return []
    if len(paths) == 1:
        return [(paths[0], answer.stdout)]
    by_itself = [found for path in paths for found in checked(command, [path])]
    return by_itself or [(paths[0], answer.stdout)]


def run_format():
    """clang-format, and pyflakes for Python: unused imports and names."""
    ours = own_sources({".hpp", ".cpp", ".h", ".c"})
    python = own_sources({".py"})
    batches = [(command, paths[i:i + FILES_AT_ONCE])
               for command, paths in ((["clang-format", "--dry-run", "-Werror"], ours), (["pyflakes3"], python))
               for i in range(0, len(paths), FILES_AT_ONCE)]
    with ThreadPoolExecutor(CORES) as pool:
        found = list(itertools.chain.from_iterable(pool.map(lambda batch: checked(*batch), batches)))
    for path, what in found:
        print(f"  FAIL {path.relative_to(ROOT)}\n{what}")
    return close(len(ours) + len(python) - len(found), len(found))


def compiled_together(path):
    """The sources of an entry in compile_commands.json: the file itself, or those that CMake has combined in it."""
    if "/Unity/unity_" not in path:
        return [path]
    return re.findall(r'^#include "(.*)"$', Path(path).read_text(), re.M)


ON_THE_BOARD = ("vm", "link", "runtime-m4")
# Sources per run: their common headers are then analyzed only once. For the board's code the sources themselves take the time, so
# a run has fewer, and those runs come first, so that no long one is left at the end.
TOGETHER, TOGETHER_ON_THE_BOARD = 24, 8
# The limit on states per function for clang's analyzer, without --deep. Its default is 225,000, which takes several
# times as long. On the host, a function that reaches the limit usually contains a std::find_if
# or a std::visit, and the analyzer follows all its paths through the standard library.
STATES_ON_THE_HOST, STATES_ON_THE_BOARD = 5_000, 20_000
# Prefixes of options that clang rejects, and of the level of optimization, which changes nothing that clang-tidy finds.
IRRELEVANT = ("-fno-tree-loop-distribute-patterns", "--param=", "-O")


def starts_with(source, folders):
    return source.startswith(tuple(str(ROOT / folder) + "/" for folder in folders))


def product_batches(preset):
    """The product's sources that the preset compiles, grouped by flags: [(flags, sources)], the slowest first. A source that
    is compiled more than once appears once."""
    product = [folder for folder in OURS if folder not in ("tests", "bench")]
    batches, seen, unfilled = [], set(), {}
    for command in json.loads((ROOT / "build" / preset / "compile_commands.json").read_text()):
        words = shlex.split(command["command"])
        compiler = next(i for i, word in enumerate(words) if word.endswith(("cc", "c++", "g++")))
        flags = [word for word in words[compiler + 1:words.index("-o")] if not word.startswith(IRRELEVANT)]
        sources = [source for source in compiled_together(command["file"])
                   if starts_with(source, product) and source not in seen]
        seen.update(sources)
        for source in sources:
            most = TOGETHER_ON_THE_BOARD if starts_with(source, ON_THE_BOARD) else TOGETHER
            batch = unfilled.get((*flags, most))
            if batch is None or len(batch[1]) == most:
                batch = unfilled[*flags, most] = (flags, [])
                batches.append(batch)
            batch[1].append(source)

    def weight(batch):
        return not starts_with(batch[1][0], ON_THE_BOARD), -sum(Path(source).stat().st_size for source in batch[1])
    return sorted(batches, key=weight)


def run_tidy(preset, deep):
    """clang-tidy over the product; `deep`: with the analyzer's own limits. Library headers take much of its time, so several
    sources are concatenated into one file (the analyzer would skip included ones). If something is found, the batch is halved
    until a single file is left: the answer then names its line."""
    batches = product_batches(preset)
    count = sum(len(sources) for _, sources in batches)

    def findings(flags, sources):
        path = sources[0]
        if len(sources) > 1:
            path = Path(tempfile.mkdtemp(dir=folder)) / "together.cpp"
            path.write_text("".join(Path(source).read_text() + "\n" for source in sources))
        answer = subprocess.run(["clang-tidy", "--quiet", f"--config-file={ROOT / '.clang-tidy'}", str(path), "--",
                                 *flags, "-Wno-unknown-warning-option"], cwd=ROOT, check=False, text=True,
                                stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        if answer.returncode == 0:
            return []
        if len(sources) == 1:
            return [(path, answer.stdout)]
        half = len(sources) // 2
        return findings(flags, sources[:half]) + findings(flags, sources[half:])

    def run(batch):
        flags, sources = batch
        if not deep:
            states = STATES_ON_THE_BOARD if starts_with(sources[0], ON_THE_BOARD) else STATES_ON_THE_HOST
            flags = [*flags, "-Xclang", "-analyzer-config", "-Xclang", f"max-nodes={states}"]
        return findings(flags, sources)

    failed = 0
    with tempfile.TemporaryDirectory() as folder, ThreadPoolExecutor(CORES) as pool:
        for found in pool.map(run, batches):
            for source, output in found:
                failed += 1
                print(f"  FAIL {Path(source).relative_to(ROOT)}\n{output}")
    return close(count - failed, failed)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("suite", choices=["ctest", "unittest", "format", "tidy"])
    parser.add_argument("argument", nargs="?")
    parser.add_argument("--label", help="ctest: only tests with this label")
    parser.add_argument("--deep", action="store_true", help="tidy: the analyzer without a limit of ours")
    wanted = parser.parse_args()
    if wanted.suite == "ctest":
        return run_ctest(wanted.argument, wanted.label)
    if wanted.suite == "unittest":
        return run_unittest(wanted.argument)
    return run_format() if wanted.suite == "format" else run_tidy(wanted.argument, wanted.deep)


if __name__ == "__main__":
    sys.exit(main())

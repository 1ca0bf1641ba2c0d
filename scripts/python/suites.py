"""The suites of scripts/test that are not programs of their own: ctest, unittest, format, tidy.

Each prints what failed, and ends with the line "N passed, N failed" that scripts/test adds up.
Exit code 0 when nothing failed and something ran, otherwise 1.
"""

import argparse
import json
import os
import re
import shlex
import subprocess
import sys
import tempfile
import unittest
import xml.etree.ElementTree as ElementTree
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
OURS = ("compiler", "vm", "link", "runtime-m4", "analysis", "rsc", "tests", "bench")
CORES = os.cpu_count() or 1


def close(passed, failed):
    print(f"{passed} passed, {failed} failed")
    return 0 if passed and not failed else 1


def count_cases(output, ok):
    """Test cases in the output of one program: Catch2's or unittest's, otherwise the program."""
    if match := re.search(r"All tests passed \(.* in (\d+) test cases?\)", output):
        return int(match[1]), 0
    if match := re.search(r"^test cases:\s+(\d+) \|(?:\s+\d+ passed \|)?\s+(\d+) failed", output, re.M):
        return int(match[1]) - int(match[2]), int(match[2])
    if match := re.search(r"^Ran (\d+) tests? in", output, re.M):
        bad = sum(int(n) for n in re.findall(r"(?:failures|errors)=(\d+)", output))
        return int(match[1]) - bad, bad
    return (1, 0) if ok else (0, 1)


def run_ctest(preset):
    with tempfile.TemporaryDirectory() as folder:
        report = Path(folder) / "report.xml"
        subprocess.run(["ctest", "--preset", preset, f"-j{CORES}", "--output-junit", str(report),
                        "--test-output-size-passed", "1000000", "--quiet"],
                       cwd=ROOT, check=False)
        cases = ElementTree.parse(report).getroot().findall("testcase") if report.exists() else []
    passed = failed = 0
    for case in cases:
        ok = case.get("status") == "run"
        output = case.findtext("system-out") or ""
        good, bad = count_cases(output, ok)
        bad = max(bad, 0 if ok else 1)  # a program that crashed says nothing about its cases
        print(f"  {'ok  ' if not bad else 'FAIL'} {case.get('name')} ({good} of {good + bad}, "
              f"{float(case.get('time') or 0):.1f} s)")
        if bad:
            print(output)
        passed, failed = passed + good, failed + bad
    return close(passed, failed)


def run_unittest(place):
    """`place`: a folder with tests, or one file of it."""
    path = ROOT / place
    folder, pattern = (path, "test*.py") if path.is_dir() else (path.parent, path.name)
    tests = unittest.defaultTestLoader.discover(str(folder), pattern)
    result = unittest.TextTestRunner(stream=sys.stdout, verbosity=2).run(tests)
    failed = len(result.failures) + len(result.errors) + len(result.unexpectedSuccesses)
    return close(result.testsRun - failed - len(result.skipped), failed)


def own_sources(suffixes):
    return sorted(path for folder in OURS for path in (ROOT / folder).rglob("*")
                  if path.suffix in suffixes)


def each(items, command):
    """Runs command(item) for all items on all cores; prints what fails."""
    def run(item):
        done = subprocess.run(command(item), cwd=ROOT, check=False, text=True,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        return item, done.returncode, done.stdout

    failed = 0
    with ThreadPoolExecutor(CORES) as pool:
        for item, code, output in pool.map(run, items):
            if code:
                failed += 1
                print(f"  FAIL {Path(item).relative_to(ROOT)}\n{output}")
    return close(len(items) - failed, failed)


def run_format():
    return each(own_sources({".hpp", ".cpp", ".h", ".c"}),
                lambda path: ["clang-format", "--dry-run", "-Werror", str(path)])


def compiled_together(path):
    """The sources behind an entry of compile_commands.json: itself, or what CMake has put together in it."""
    if "/Unity/unity_" not in path:
        return [path]
    return re.findall(r'^#include "(.*)"$', Path(path).read_text(), re.M)


def product_batches(preset):
    """What the preset compiles of the product, as it is compiled together: [(flags, sources)]. What is compiled more
    than once, for the large profile too, is there once."""
    product = tuple(str(ROOT / folder) + "/" for folder in OURS if folder not in ("tests", "bench"))
    batches, seen = [], set()
    for command in json.loads((ROOT / "build" / preset / "compile_commands.json").read_text()):
        words = shlex.split(command["command"])
        compiler = next(i for i, word in enumerate(words) if word.endswith(("cc", "c++", "g++")))
        sources = [source for source in compiled_together(command["file"])
                   if source.startswith(product) and source not in seen]
        seen.update(sources)
        if sources:
            batches.append((words[compiler + 1:words.index("-o")], sources))
    return batches


def run_tidy(preset):
    """clang-tidy over the product. Much of its time goes into what the headers of the libraries declare, so
    sources that are compiled together are put one behind the other (included, the analyzer would leave them
    out), and a file at a time only where something is found: then the answer names the file and its line."""
    batches = product_batches(preset)
    count = sum(len(sources) for _, sources in batches)

    def tidy(path, words):
        return subprocess.run(["clang-tidy", "--quiet", f"--config-file={ROOT / '.clang-tidy'}", str(path),
                               "--", *words, "-Wno-unknown-warning-option"], cwd=ROOT, check=False, text=True,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT)

    def run(numbered):
        number, (words, sources) = numbered
        if len(sources) > 1:
            together = Path(folder) / f"{number}.cpp"
            together.write_text("".join(Path(source).read_text() + "\n" for source in sources))
            if tidy(together, words).returncode == 0:
                return []
        answers = [(source, tidy(source, words)) for source in sources]
        return [(source, answer.stdout) for source, answer in answers if answer.returncode]

    failed = 0
    with tempfile.TemporaryDirectory() as folder, ThreadPoolExecutor(CORES) as pool:
        for found in pool.map(run, enumerate(batches)):
            for source, output in found:
                failed += 1
                print(f"  FAIL {Path(source).relative_to(ROOT)}\n{output}")
    return close(count - failed, failed)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("suite", choices=["ctest", "unittest", "format", "tidy"])
    parser.add_argument("argument", nargs="?")
    wanted = parser.parse_args()
    if wanted.suite == "ctest":
        return run_ctest(wanted.argument)
    if wanted.suite == "unittest":
        return run_unittest(wanted.argument)
    return run_format() if wanted.suite == "format" else run_tidy(wanted.argument)


if __name__ == "__main__":
    sys.exit(main())

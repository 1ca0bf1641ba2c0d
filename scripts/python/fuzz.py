"""scripts/fuzz: runs the fuzzer in chunks, on several cores, and adds up their results.

Each chunk has a random seed. The same seed gives the same images, as long as the images that they are mutated
from, in build/host-asan/tests/fuzz/seeds, are the same. Assumes that build/host-asan is built.
"""

import argparse
import json
import os
import shutil
import subprocess
import sys
import tempfile
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
FUZZER = ROOT / "build/host-asan/tests/fuzz/fuzz_images"
CHUNK = 1_000_000
SAVED = ROOT / "build/fuzz"


def read_state(path):
    """{seed: result} of the chunks that have been run before."""
    if path is None or not path.exists():
        return {}
    results = (json.loads(line) for line in path.read_text().splitlines() if line)
    return {result["seed"]: result for result in results}


def run_chunk(fuzzer, seeds, seed, images):
    """The fuzzer's results; None if it failed, in which case it has printed why."""
    done = subprocess.run([fuzzer, "--images", str(images), "--seed", str(seed), "--seeds", seeds,
                           "--saved", SAVED / f"failed-{seed}.rsb"],
                          check=False, text=True, stdout=subprocess.PIPE)
    return None if done.returncode else json.loads(done.stdout)


def add_up(results):
    total = {key: sum(r[key] for r in results)
             for key in ("images", "runs", "pauses", "exact", "cpu_seconds")}
    total["worst_ratio"] = max(r["worst_ratio"] for r in results)
    total["verdicts"] = {name: sum(r["verdicts"][name] for r in results)
                         for name in results[0]["verdicts"]}
    return total


def as_line(total):
    verdicts = dict(total["verdicts"])
    accepted = verdicts.pop("accepted")
    refused = ", ".join(f"{name} {count}" for name, count in verdicts.items())
    images = total["images"]
    return (f"{images} images, {accepted} accepted ({100 * accepted / images:.1f} %), "
            f"{total['runs']} runs, {total['pauses']} pauses, worst cost/declared "
            f"{total['worst_ratio']:.3f}, {total['exact']} at exactly the declared cost, "
            f"{images / max(total['cpu_seconds'], 0.1):.0f} images/s a core; refused: {refused}")


def chunks_of(images, first):
    """[(seed, images)]"""
    sizes = [CHUNK] * (images // CHUNK) + ([images % CHUNK] if images % CHUNK else [])
    return [(first + i, size) for i, size in enumerate(sizes)]


def main():
    parser = argparse.ArgumentParser(prog="scripts/fuzz")
    parser.add_argument("--images", type=int, default=CHUNK)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--jobs", type=int, default=os.cpu_count() or 1)
    parser.add_argument("--state", type=Path)
    wanted = parser.parse_args()
    SAVED.mkdir(parents=True, exist_ok=True)
    found = read_state(wanted.state)
    chunks = [c for c in chunks_of(wanted.images, wanted.seed)
              if found.get(c[0], {}).get("images") != c[1]]
    begin = time.monotonic()
    # Runs a copy, so that a build in the meantime changes nothing.
    with tempfile.TemporaryDirectory(prefix="robosync-fuzz-") as folder:
        fuzzer = shutil.copy2(FUZZER, folder)
        seeds = shutil.copytree(FUZZER.parent / "seeds", Path(folder) / "seeds")
        with ThreadPoolExecutor(wanted.jobs) as pool:
            for result in pool.map(lambda c: run_chunk(fuzzer, seeds, *c), chunks):
                if result is None:
                    pool.shutdown(cancel_futures=True)
                    return 1
                found[result["seed"]] = result
                if wanted.state:
                    with open(wanted.state, "a", encoding="utf-8") as file:
                        file.write(json.dumps(result) + "\n")
                    print(f"{len(found)} chunks, {time.monotonic() - begin:.0f} s", flush=True)
    print(as_line(add_up([found[seed] for seed, _ in chunks_of(wanted.images, wanted.seed)])))
    return 0


if __name__ == "__main__":
    sys.exit(main())

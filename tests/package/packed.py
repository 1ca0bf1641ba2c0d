"""The package of scripts/package, made once for all tests."""

import functools
import subprocess
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]


@functools.cache
def package():
    said = subprocess.run([ROOT / "scripts/package"], check=True, text=True, stdout=subprocess.PIPE).stdout
    return Path(said.split()[-1])

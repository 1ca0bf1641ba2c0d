"""Runs the tool, rsc, from the host build."""

import json
import subprocess
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
TOOL = ROOT / "build/host/rsc"
TIMEOUT = 120


class RscError(RuntimeError):
    """rsc ended with a code other than 0; the message is its output."""


def call(*arguments, timeout=TIMEOUT, cwd=None):
    """The finished process, whatever its exit code; stdout and stderr as text."""
    return subprocess.run([str(TOOL), *map(str, arguments)], check=False, text=True, cwd=cwd,
                          timeout=timeout, stdin=subprocess.DEVNULL,
                          stdout=subprocess.PIPE, stderr=subprocess.PIPE)


def run(*arguments, timeout=TIMEOUT):
    """stdout; raises if rsc fails."""
    done = call(*arguments, timeout=timeout)
    if done.returncode:
        raise RscError(f"rsc {arguments[0]} ended with {done.returncode}: {done.stderr.strip()}")
    return done.stdout


def info(port):
    return json.loads(run("info", "--port", port, "--format", "json"))

"""Random images on the Cortex-M4, behind the MPU: no fault, and the results that the host has.

The host's fuzzer (build/host) makes the images and says what it found; the firmware (build/m4) verifies
and runs them again, and ends QEMU with a failure where something differs or faults.
"""

import os
import struct
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

from board import qemu

ROOT = Path(__file__).resolve().parents[2]
FUZZER = ROOT / "build/host/tests/fuzz/fuzz_images"
SEEDS = FUZZER.parent / "seeds"
FIRMWARE = ROOT / "build/m4/bench/fuzz_vm"
BLOCK_AT = 0x21000000  # the board's RAM for blocks, 16 MB
IMAGES = 10_000  # in a block
BLOCKS = int(os.environ.get("ROBOSYNC_FUZZ_BLOCKS", "1"))  # each of another seed
TIMEOUT = 300

# tests/fuzz/block.hpp
HEADER = struct.Struct("<4I")
ENTRY = struct.Struct("<5I")
MODE_AT, RUN, STRAY = 4, 0, 1
HASH_AT = 16  # in an entry
STRAY_ADDRESS = 0x20123450  # tests/fuzz/firmware/main.cpp


def make_block(path, images, seed):
    subprocess.run([FUZZER, "--images", str(images), "--seed", str(seed), "--seeds", SEEDS,
                    "--emit", path, "--saved", path.with_suffix(".rsb")],
                   check=True, stdout=subprocess.DEVNULL, timeout=TIMEOUT)


def run_board(block):
    """The exit code, and what the firmware said."""
    done = subprocess.run([*qemu(), "-serial", "none", "-semihosting-config", "enable=on,target=native",
                           "-kernel", FIRMWARE,
                           "-device", f"loader,file={block},addr={BLOCK_AT:#x},force-raw=on"],
                          check=False, text=True, timeout=TIMEOUT, stdin=subprocess.DEVNULL,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    return done.returncode, done.stdout


def first_accepted(block):
    """Place of the first entry that has results."""
    at = HEADER.size
    while True:
        size, _, _, verdict, _ = ENTRY.unpack_from(block, at)
        if verdict & 0xFF == 0:
            return at
        at += ENTRY.size + (size + 3) // 4 * 4


class Board(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="robosync-fuzz-")
        self.addCleanup(folder.cleanup)
        self.block = Path(folder.name) / "block"

    def test_no_image_faults_and_all_do_as_on_the_host(self):
        for seed in range(1, BLOCKS + 1):
            make_block(self.block, IMAGES, seed)
            code, said = run_board(self.block)
            print(f"seed {seed}: {said.strip()}", file=sys.stderr)
            self.assertEqual(code, 0, said)
            self.assertRegex(said, rf"^{IMAGES} images, \d{{3,}} run, .*no fault")

    def test_a_stray_write_is_trapped(self):
        make_block(self.block, 1, seed=1)
        block = bytearray(self.block.read_bytes())
        struct.pack_into("<I", block, MODE_AT, STRAY)
        self.block.write_bytes(block)
        code, said = run_board(self.block)
        self.assertNotEqual(code, 0)
        self.assertRegex(said, rf"fault at pc \d+, address {STRAY_ADDRESS}, cause")

    def test_other_results_are_noticed(self):
        make_block(self.block, 20, seed=1)
        block = bytearray(self.block.read_bytes())
        block[first_accepted(block) + HASH_AT] ^= 1
        self.block.write_bytes(block)
        code, said = run_board(self.block)
        self.assertNotEqual(code, 0)
        self.assertIn("other results than the host's", said)


if __name__ == "__main__":
    unittest.main()

"""Part of the safety campaign: `scripts/soak safety` runs more of it."""

import unittest

from board import HAVE_WATCHDOG, NAME
from campaign import FAULTS, campaign

SEED = 13
RUNS = 30


@unittest.skipUnless(NAME in HAVE_WATCHDOG, "QEMU has neither the watchdog nor the I2C of this board")
class Campaign(unittest.TestCase):
    def test_outputs_are_safe_whatever_fails(self):
        seen = set()
        self.assertEqual(campaign(RUNS, SEED, show=lambda _, run, __: seen.add(run.fault)), [])
        self.assertGreater(len(seen), len(FAULTS) // 2)


if __name__ == "__main__":
    unittest.main()

"""Every example does the same on the board as in `rsc run`, whatever its sensors measure."""

import json
import os
import unittest

import examples
from traces import TraceTest

# Scripts of readings for each example; scripts/soak runs more.
SHARE = int(os.environ.get("ROBOSYNC_SOAK", "1"))


class Examples(TraceTest):
    def test_traces(self):
        folders = examples.folders()
        self.assertGreaterEqual(len(folders), 10)
        for folder in folders:
            config = self.folder / f"{folder.name}.json"
            config.write_text(json.dumps(examples.config(folder)))
            for seed in range(SHARE):
                with self.subTest(example=folder.name, seed=seed):
                    self.units = examples.units(folder)
                    self.check(folder / "robot.rsl", examples.drawn(folder, seed), config)


if __name__ == "__main__":
    unittest.main()

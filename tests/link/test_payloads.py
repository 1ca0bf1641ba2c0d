"""docs/link.md has the payloads as link/ has them."""

import os
import unittest

import payloads


class Page(unittest.TestCase):
    maxDiff = None

    def test_it_has_every_payload(self):
        before, shown, after = payloads.split_page()
        if os.environ.get("ROBOSYNC_UPDATE_GOLDEN"):
            shown = payloads.tables()
            payloads.PAGE.write_text(before + payloads.BEGIN + shown + payloads.END + after, "utf-8")
        self.assertEqual(shown, payloads.tables())

    def test_no_member_is_overlooked(self):
        """What is read of the header here, another reader of it finds, too (tests/e2e/wire.py)."""
        import sys
        sys.path += [str(payloads.ROOT / "tests/e2e"), str(payloads.ROOT / "scripts/python")]
        import wire
        known = payloads.structs()
        for name, fields in wire.STRUCTS.items():
            with self.subTest(struct=name):
                self.assertEqual([field for field, _ in fields], [field for _, _, field, _ in known[name]])
                size = sum(payloads.SIZES.get(kind, 1) * (count or 1) for kind, count, _, _ in known[name])
                self.assertEqual(size, wire.layout(name).size)


if __name__ == "__main__":
    unittest.main()

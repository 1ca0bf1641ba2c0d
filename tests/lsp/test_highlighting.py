"""The colours that editors give to RSL: made from the list of its keywords, and as that list is now."""

import os
import re
import sys
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "scripts/python"))
import highlighting  # noqa: E402

GRAMMAR = ROOT / "grammar/rsl.tmLanguage.json"


class Highlighting(unittest.TestCase):
    def test_the_grammar_is_what_the_list_of_keywords_gives(self):
        if os.environ.get("ROBOSYNC_UPDATE_GOLDEN"):
            GRAMMAR.write_text(highlighting.text(), "utf-8")
        self.assertEqual(GRAMMAR.read_text("utf-8"), highlighting.text())

    def test_every_keyword_has_one_colour(self):
        rows = (ROOT / "compiler/syntax/keywords.def").read_text("utf-8").count("\nKEYWORD(")
        words = highlighting.keywords()
        self.assertEqual(len(words), rows)
        patterns = [re.compile(highlighting.any_of(group)) for _, group in highlighting.groups()]
        for word in words:
            for spelling in (word, word.lower()):
                found = [pattern.fullmatch(spelling) is not None for pattern in patterns]
                self.assertEqual(found.count(True), 1, word)


if __name__ == "__main__":
    unittest.main()

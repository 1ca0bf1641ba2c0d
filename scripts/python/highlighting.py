#!/usr/bin/env python3
"""Generates grammar/rsl.tmLanguage.json, the colours of RSL in editors, from the list of its keywords.

usage: scripts/python/highlighting.py > grammar/rsl.tmLanguage.json
"""

import json
import re
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
OPERATORS = {"AND", "OR", "NOT", "MOD", "IS"}
TRUTHS = {"TRUE", "FALSE"}
CONTROL = {"item", "part", "statement", "opens", "begins"}  # roles that decide what a line is about
NAMED = ["DEFINE", "BEHAVIOR", "BEHAVIOUR", "SAFETY", "MOTION", "CHECK", "STATE", "FEELING", "TIMER", "LET", "REMEMBER",
         "LIST"]


def keywords():
    """{spelling: its roles} from compiler/syntax/keywords.def."""
    text = (ROOT / "compiler/syntax/keywords.def").read_text("utf-8")
    rows = re.findall(r"^KEYWORD\(([A-Z ]+), \w+, ([^)]*)\)", text, re.M)
    return {spelling: set(re.findall(r"\w+", roles)) for spelling, roles in rows}


def functions():
    text = (ROOT / "compiler/syntax/functions.def").read_text("utf-8")
    return re.findall(r"^FUNCTION\((\w+),", text, re.M)


def any_of(words):
    """A pattern for whole words, ignoring case."""
    longest_first = sorted(words, key=lambda word: (-len(word), word))
    return r"(?i)\b(?:" + "|".join(word.replace(" ", r"\s+") for word in longest_first) + r")\b"


def groups():
    """(scope, words), each keyword in one of them."""
    words = keywords()
    control = {word for word, roles in words.items() if roles & CONTROL or word in ("END", "ELSE IF")}
    return [("keyword.operator.word.rsl", OPERATORS),
            ("constant.language.rsl", TRUTHS),
            ("keyword.control.rsl", control - OPERATORS - TRUTHS),
            ("keyword.other.rsl", set(words) - control - OPERATORS - TRUTHS)]


def grammar():
    string = {"patterns": [{"name": "constant.character.placeholder.rsl", "match": r"\{[^{}\"']*\}"}]}
    return {
        "name": "RSL",
        "scopeName": "source.rsl",
        "fileTypes": ["rsl"],
        "patterns": [
            # A % after digits is a unit; anywhere else it begins a comment.
            {"name": "constant.numeric.rsl",
             "match": r"(?<![\w.])\d+(?:\.\d+)?(?:%|[A-Za-z\u00b0\u00b5\u03bc]+(?:/[A-Za-z]+)?)?"},
            {"name": "comment.line.rsl", "match": r"[%#].*$"},
            {"name": "string.quoted.double.rsl", "begin": '"', "end": r'"|$', **string},
            {"name": "string.quoted.single.rsl", "begin": "'", "end": "'|$", **string},
            {"match": any_of(NAMED) + r"\s+(?!(?i:OF|FROM)\b)([A-Za-z_]\w*)",
             "captures": {"0": {"name": "keyword.control.rsl"}, "1": {"name": "entity.name.rsl"}}},
            *({"name": scope, "match": any_of(words)} for scope, words in groups()),
            {"name": "support.function.rsl", "match": any_of(functions()) + r"(?=\s*\()"},
            {"name": "keyword.operator.rsl", "match": r"<=|>=|<>|[-+*/<>=]"},
        ],
    }


def text():
    return json.dumps(grammar(), indent=2, ensure_ascii=True) + "\n"


if __name__ == "__main__":
    print(text(), end="")

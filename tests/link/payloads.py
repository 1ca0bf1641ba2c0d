"""The payloads of all messages as tables, made from link/messages.def and link/messages.hpp: the part of docs/link.md from which a
client can be written."""

import re
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PAGE = ROOT / "docs/link.md"
BEGIN, END = "<!-- generated: payloads -->\n", "<!-- end of payloads -->\n"
SIZES = {"u8": 1, "i8": 1, "u16": 2, "i16": 2, "u32": 4, "i32": 4, "u64": 8}
ALIASES = {"Name": ("char", 16), "ProgramHash": ("u8", 8), "SessionId": ("u32", None),
           "PublicKey": ("u8", 32), "Signature": ("u8", 64), "BootId": ("u8", 16), "ImageHash": ("u8", 32)}
# Whose payload is no struct of their own name.
PAYLOADS = {"last_fault": ["Fault"], "pieces": ["Data", "Piece"], "event": ["event"], "log": []}
SIDES = {"to_board": "to the board", "to_host": "to the host", "order": "an order to the board"}
FOLLOWED = {"signed_order": "Then the payload of the order.", "data": "Then bytes of the image, to the end of the payload.", "image_data": "Then the bytes, to the end of the payload.",
            "pieces": "Then, as often as there are pieces, the following, and behind each its `count` bytes:",
            "log": "The text, to the end of the payload, in UTF-8.", "event": "Then `count` values of 4 bytes (i32)."}
EVENT = [("u64", None, "time_us", "program time of the step"), ("u32", None, "step", ""),
         ("u8", None, "kind", "see the events below"), ("u8", None, "count", "of values"),
         ("u16", None, "subject", ""), ("u16", None, "object", "")]


def _enums(text):
    """{name: [names of its values]}; those whose list is a .def from there."""
    enums = {name: re.findall(r"\w+", re.sub(r"//.*", "", body))
             for name, body in re.findall(r"enum class (\w+) : std::uint8_t \{([^#}]*)\}", text)}
    kept = (ROOT / "link/keeping.def").read_text("utf-8")
    enums["Keeping"] = re.findall(r"^KEEPING\((\w+),", kept, re.M)
    denials = (ROOT / "link/denials.def").read_text("utf-8")
    enums["Denial"] = re.findall(r"^DENIAL\((\w+),", denials, re.M)
    return enums


def _type(spelled, enums):
    """(type, how many of it or None)."""
    if match := re.fullmatch(r"std::array<([\w:]+), (\d+)>", spelled):
        return _type(match[1], enums)[0], int(match[2])
    if spelled in ALIASES:
        return ALIASES[spelled]
    if spelled in enums:
        return "u8", None
    sign, bits = re.fullmatch(r"std::(u?)int(\d+)_t", spelled).groups()
    return ("u" if sign else "i") + bits, None


def _comment(lines):
    return " ".join(line.split("//", 1)[1].strip() for line in lines if "//" in line)


def _fields(body, enums):
    for declared, spelled, names in re.findall(
            r"^  (([\w:]+(?:<[^>]*>)?)\s+([\w, ]+)(?:\{\}| = 0)?;[^\n]*(?:\n +//[^\n]*)*)", body, re.M):
        kind, count = _type(spelled, enums)
        meaning = _comment(declared.splitlines())
        if spelled in enums:
            values = ", ".join(f"{number} {value}" for number, value in enumerate(enums[spelled]))
            meaning = f"{values}{': ' if meaning else ''}{meaning}"
        for name in names.split(","):
            yield kind, count, name.strip(), meaning


def structs():
    text = (ROOT / "link/messages.hpp").read_text("utf-8")
    text = re.sub(r"\n +(\w+(?: = 0)?;)", r" \1", text)  # what the formatter has broken
    enums = _enums(text)
    found = {name: list(_fields(body, enums))
             for name, body in re.findall(r"^struct (\w+) \{[^\n]*\n(.*?)^\};", text, re.M | re.S)}
    return {**found, "event": EVENT}


def _table(fields):
    rows, at = ["| offset | type | name | |", "|---|---|---|---|"], 0
    for kind, count, name, meaning in fields:
        size = SIZES.get(kind, 1) * (count or 1)
        rows.append(f"| {at} | {kind}{f'[{count}]' if count else ''} | {name} | {meaning} |")
        at += size
    return rows


def tables():
    known, lines = structs(), []
    listed = re.findall(r'^MESSAGE\((\w+),\s*(\d+),\s*(\w+),\s*"(.*)"\)',
                        (ROOT / "link/messages.def").read_text("utf-8"), re.M)
    for name, number, direction, doc in listed:
        camel = "".join(word.capitalize() for word in name.split("_"))
        payload = PAYLOADS.get(name, [camel] if camel in known else [])
        lines += [f"#### `{name}`: {number}, {SIDES[direction]}", "", f"{doc[0].upper()}{doc[1:]}.", ""]
        if payload:
            lines += [*_table(known[payload[0]]), ""]
        if name in FOLLOWED:
            lines += [FOLLOWED[name], ""]
        for part in payload[1:]:
            lines += [*_table(known[part]), ""]
        if not payload and name not in FOLLOWED:
            lines += ["No payload.", ""]
    events = re.findall(r'^EVENT\((\w+),\s*(\d+),\s*(\w+),\s*(\w+),\s*"(.*?)",\s*"(.*)"\)',
                        (ROOT / "link/events.def").read_text("utf-8"), re.M)
    lines += ["#### Kinds of events", "", "| kind | event | subject | object | values | |", "|---|---|---|---|---|---|"]
    lines += [f"| {number} | {name} | {subject} | {object_} | {values.replace(',', ', ')} | {doc} |"
              for name, number, subject, object_, values, doc in events]
    return "\n".join(lines) + "\n"


def split_page():
    before, rest = PAGE.read_text("utf-8").split(BEGIN)
    shown, after = rest.split(END)
    return before, shown, after

"""The payloads of all messages as tables, and the numbers in them, made from link/ and the lists of vm/: the part of docs/link.md
from which a client can be written."""

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
FOLLOWED = {"signed_order": "Then the payload of the order.",
            "begin": "Then, only within `signed_order`, the end of a signed `begin` (below).",
            "data": "Then bytes of the image, to the end of the payload.", "image_data": "Then the bytes, to the end of the payload.",
            "pieces": "Then, as often as there are pieces, the following, and behind each its `count` bytes:",
            "log": "The text, to the end of the payload, in UTF-8.", "event": "Then `count` values of 4 bytes (i32)."}
# What the comments of messages.hpp say to a reader of C++, and what the page says.
REFERENCES = {"vm::Refusal, or kNothingToActivate: no complete transfer of this image": "see the refusals below",
              "vm::Section": "see the sections below",
              "driver d of vm/drivers.def is present": "driver d is present, see the drivers below",
              "of OrderText (order.hpp) and the payload": "Ed25519 (RFC 8032), of the signed text below",
              "MessageType of the order": "number of the order's message",
              "this and the next two as in Activate": "this and the next two: as in `activate`"}
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


def _categories():
    text = (ROOT / "runtime-m4/policy/standing.hpp").read_text("utf-8")
    body = re.search(r"enum class Category : std::uint8_t \{([^}]*)\}", text)[1]
    return ", ".join(f"{number} {name}" for number, name in enumerate(re.findall(r"\w+", body)))


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
    comment = " ".join(line.split("//", 1)[1].strip() for line in lines if "//" in line)
    for said, shown in REFERENCES.items():
        comment = comment.replace(said, shown)
    return comment.replace("kernel::Category", _categories())


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


def _signed_text():
    """The fields of OrderText, whose first one is always the same."""
    text = (ROOT / "link/order.hpp").read_text("utf-8")
    body = re.search(r"^struct OrderText \{[^\n]*\n(.*?)^\};", text, re.M | re.S)[1]
    words = "".join(re.findall(r"'(.)'", body))
    rest = re.sub(r"^.*?\}\};|^.*?\};", "", body, count=1, flags=re.S)
    return [("char", len(words), "words", f"`{words}`"), *_fields(rest, {})]


def _listed(path, macro):
    """The entries of a .def file: (name, its last text)."""
    return re.findall(rf'^{macro}\((\w+),.*?"([^"]*)"\)', (ROOT / path).read_text("utf-8"), re.M)


def _numbered(title, intro, what, entries):
    rows = [f"| {number} | {name} | {doc} |" if doc else f"| {number} | {name} | |" for number, (name, doc) in entries]
    return [f"#### {title}", "", intro, "", f"| number | {what} | |", "|---|---|---|", *rows, ""]


def _numbers():
    """The numbers in the payloads that the tables there only refer to."""
    refusals = [("none", "it runs"), *_listed("vm/refusals.def", "REFUSAL")]
    unsent = (255, ("nothing_to_activate", "no complete transfer of this image: begin again"))
    sections = [("header", ""), *((name, "") for name, _ in _listed("vm/sections.def", "IMAGE_SECTION"))]
    drivers = _listed("vm/drivers.def", "(?:SENSOR|ACTUATOR)_DRIVER")
    return [*_numbered("Refusals", "`refusal` of `activate_result`.", "refusal", [*enumerate(refusals), unsent]),
            *_numbered("Sections", "`section` of `activate_result`: the part of the image where the mistake is. `index` is the number "
                       "of the record in it, or of the word in the code.", "section", enumerate(sections)),
            *_numbered("Drivers", "Bits of `drivers` of `hello_reply`.", "driver", enumerate(drivers))]


def _signing():
    return ["#### The end of a signed `begin`", "", "What `activate` will say, and which image it may activate.", "",
            *_table(structs()["Grant"]), "", "#### Signed text", "", "What the signature of a `signed_order` covers.", "",
            *_table(_signed_text()), "", "Then the payload of the order.", ""]


def tables():
    known, lines = structs(), []
    listed = re.findall(r'^MESSAGE\((\w+),\s*(\d+),\s*(\w+),\s*"(.*)"\)',
                        (ROOT / "link/messages.def").read_text("utf-8"), re.M)
    for name, number, direction, doc in listed:
        camel = "".join(word.capitalize() for word in name.split("_"))
        payload = PAYLOADS.get(name, [camel] if camel in known else [])
        lines += [f"#### `{name}`: {number}, {SIDES[direction]}", "", doc[0].upper() + doc[1:] + ("" if doc.endswith("?") else "."), ""]
        if payload:
            lines += [*_table(known[payload[0]]), ""]
        if name in FOLLOWED:
            lines += [FOLLOWED[name], ""]
        for part in payload[1:]:
            lines += [*_table(known[part]), ""]
        if not payload and name not in FOLLOWED:
            lines += ["No payload.", ""]
    lines += [*_signing(), *_numbers()]
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

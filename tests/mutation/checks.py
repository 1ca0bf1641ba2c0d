"""Finds the checks in a source of the verifier, and makes each one removable while it runs.

A check is what decides to refuse: the condition of an `if` that refuses, what good_or() wants to hold,
what a predicate gives, a plain `return Refusal::x`, a call that gives a reason; and of conditions each
operand of && and ||. To remove
one is to make it say that all is well. `instrument()` writes every one of them as a switch on
ROBOSYNC_MUTANT, so that one build serves all.

This is no parser of C++: it knows how these files are written. What it does not know how to remove it
leaves alone; test_checks.py shows what it finds in small samples.
"""

import re
from typing import NamedTuple

# Predicates by which something is refused when they are true; all others, when they are false.
REFUSING = {"are_too_many", "is_counter", "is_taken", "takes_none"}
# Decided while compiling, or no check.
SKIPPED = {"ends_at", "gives_truth", "has", "is_loop", "is_named"}

# What follows an `if` that refuses.
REFUSES = re.compile(r"\{?\s*return (Refusal::(?!none)|(\w+\.)?verification\.refuse|false)|refusal = |"
                     r"good = verification\.refuse")
# A call that gives the reason to refuse, where no `if` stands before it.
CALLS = re.compile(r"\b(?:return|refusal =) (?=(?!good_or\b)[\w.]+\()([^;?]*);")

PREFIX = '#include "mutant.hpp"\n'
HEADER = """\
// Which check is switched off: the number in ROBOSYNC_MUTANT.
#pragma once
#include <cstdlib>
#include <type_traits>
namespace robosync::vm {
inline const int mutant_number =
    std::getenv("ROBOSYNC_MUTANT") != nullptr ? std::atoi(std::getenv("ROBOSYNC_MUTANT")) : 0;
constexpr bool mutant(int number) {
  return !std::is_constant_evaluated() && mutant_number == number;
}
template <typename Refusal>
Refusal pass_if(bool off, Refusal refusal) {
  return off ? Refusal::none : refusal;
}
}  // namespace robosync::vm
"""


class Check(NamedTuple):
    file: str
    line: int
    text: str  # of the expression, blanks squeezed
    begin: int
    end: int
    kind: str  # "accept": made true; "refuse": made false; "return", "call": the reason made `none`

    def key(self):
        return f"{self.file}: {self.text}"


def blank(text):
    """The same length, without what comments and strings say."""
    def spaces(match):
        return re.sub(r"[^\n]", " ", match[0])
    return re.sub(r'//[^\n]*|/\*.*?\*/|"(?:\\.|[^"\\])*"', spaces, text, flags=re.S)


def closing(text, begin):
    """Place of the bracket that closes the one at `begin`."""
    depth = 0
    for at in range(begin, len(text)):
        depth += (text[at] in "([{") - (text[at] in ")]}")
        if depth == 0:
            return at
    raise ValueError("no closing bracket")


def split(text, begin, end, operator):
    """Spans of the operands between `begin` and `end`; one if the operator is not there."""
    spans, depth, start, at = [], 0, begin, begin
    while at < end:
        depth += (text[at] in "([{") - (text[at] in ")]}")
        if depth == 0 and text.startswith(operator, at):
            spans.append((start, at))
            at += len(operator)
            start = at
            continue
        at += 1
    spans.append((start, end))
    return [trim(text, *span) for span in spans]


def trim(text, begin, end):
    while begin < end and text[begin].isspace():
        begin += 1
    while end > begin and text[end - 1].isspace():
        end -= 1
    return begin, end


def operands(text, begin, end, accepts):
    """The expression and what it is made of: [(begin, end, accepts)], each worth removing by itself."""
    begin, end = trim(text, begin, end)
    yield begin, end, accepts
    inner_begin, inner_end, inner_accepts = begin, end, accepts
    while True:  # brackets and `!` around all of it
        if text[inner_begin] == "!" and text[inner_begin + 1] == "(" and \
                closing(text, inner_begin + 1) == inner_end - 1:
            inner_begin, inner_end = trim(text, inner_begin + 2, inner_end - 1)
            inner_accepts = not inner_accepts
        elif text[inner_begin] == "(" and closing(text, inner_begin) == inner_end - 1:
            inner_begin, inner_end = trim(text, inner_begin + 1, inner_end - 1)
        else:
            break
    for operator, removable in (("?", None), ("||", not inner_accepts), ("&&", inner_accepts)):
        parts = split(text, inner_begin, inner_end, operator)
        if len(parts) == 1:
            continue
        if operator == "?":
            parts = split(text, parts[1][0], inner_end, ":") if len(parts) == 2 else []
            removable = True
        for part in parts:
            found = list(operands(text, *part, inner_accepts))
            yield from found if removable else found[1:]
        return


def functions(text):
    """{place of the body's bracket: (name, returns bool, place of its end)}."""
    pattern = re.compile(r"^ *((?:\[\[[^\]]*\]\] |static |constexpr |template .*?> )*)(bool|Refusal|Verdict) "
                         r"(?:\w+::)*(\w+)\(", re.M)
    for match in pattern.finditer(text):
        end = closing(text, match.end() - 1)
        opened = re.compile(r"(?: const)? \{").match(text, end + 1)
        if opened:
            body = opened.end() - 1
            yield match[3], match[2] == "bool", body, closing(text, body)


def polarity_of_name(text, name, begin, end):
    """Does a local flag say that all is well (True), or not (False)? None: neither."""
    for use in re.finditer(rf"(!?)\b{name}\b", text[begin:end]):
        at = begin + use.start()
        head = text.rfind(";", 0, at)
        before = text[head + 1:at]
        if "good_or(" in before:
            return not use[1]
        if re.search(r"\bif \(", before):
            return bool(use[1])
    return None


def conditions(text, name, is_bool, begin, end):
    """[(begin, end, accepts)] of the conditions in the body of one function."""
    for match in re.finditer(r"\bif \(", text[begin:end]):
        opened = begin + match.end() - 1
        closed = closing(text, opened)
        then = text[closed + 1:closed + 80].lstrip()
        if REFUSES.match(then) and not (is_bool and name in REFUSING):
            yield opened + 1, closed, False
    for match in re.finditer(r"\bgood_or\(", text[begin:end]):
        opened = begin + match.end() - 1
        comma = text.index(",", opened)
        yield comma + 1, closing(text, opened), True
    for match in re.finditer(r"\breturn ([^;]*?)\s\? Refusal::\w+ : Refusal::none;", text[begin:end]):
        yield begin + match.start(1), begin + match.end(1), False
    for match in re.finditer(r"\bbool (\w+) =\s(?!false;)([^;]*);", text[begin:end]):
        accepts = polarity_of_name(text, match[1], begin + match.end(), end)
        if accepts is not None:
            yield begin + match.start(2), begin + match.end(2), accepts
    if is_bool:
        for match in re.finditer(r"\breturn ((?!false;|true;|(?:\w+\.)?verification\.refuse)[^;]*);",
                                 text[begin:end]):
            yield begin + match.start(1), begin + match.end(1), name not in REFUSING


def find_checks(file, source, only=None):
    """Every check of one source; `only`: in the function of this name."""
    text, found = blank(source), {}

    def add(begin, end, kind):
        line = source.count("\n", 0, begin) + 1
        squeezed = " ".join(source[begin:end].split())
        found.setdefault((begin, end), Check(file, line, squeezed, begin, end, kind))

    for name, is_bool, begin, end in functions(text):
        if name in SKIPPED or only not in (None, name):
            continue
        for start, stop, accepts in conditions(text, name, is_bool, begin, end):
            for b, e, good in operands(text, start, stop, accepts):
                add(b, e, "accept" if good else "refuse")
        for match in re.finditer(r"return (Refusal::(?!none)\w+);", text[begin:end]):
            before = text[begin:begin + match.start()].rstrip()
            if before.endswith((";", "}", "{", ":")):  # not the body of an `if` that is found above
                add(begin + match.start(1), begin + match.end(1), "return")
        for match in () if is_bool else CALLS.finditer(text[begin:end]):
            before = text[begin:begin + match.start()].rstrip()
            if before.endswith((";", "}", "{", ":", "Refusal")):
                add(begin + match.start(1), begin + match.end(1), "call")
    return sorted(found.values(), key=lambda check: (check.begin, -check.end))


def instrument(source, checks, first):
    """The source with a switch at each check; they are numbered from `first` on."""
    inserts = []
    for number, check in enumerate(checks, first):
        before, behind = {
            "accept": (f"(mutant({number}) || (", "))"),
            "refuse": (f"(!mutant({number}) && (", "))"),
            "return": (f"(mutant({number}) ? Refusal::none : ", ")"),
            "call": (f"pass_if(mutant({number}), ", ")"),
        }[check.kind]
        size = check.end - check.begin
        inserts.append((check.begin, 1, -size, before))
        inserts.append((check.end, 0, size, behind))
    out, last = [], 0
    for at, _, _, text in sorted(inserts, key=lambda insert: insert[:3]):
        out += [source[last:at], text]
        last = at
    out.append(source[last:])
    return PREFIX + "".join(out)

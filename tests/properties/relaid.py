"""A program with other line breaks, drawn at random from those that the language allows; and what `rsc fmt` promises about lines,
checked without its code."""

import random
import re

WORD = re.compile(r'"[^"]*"|#.*|[^\s",]+|,')
# A line end behind the first or in front of the second does not count.
GOES_ON = {"DO", "ELSE", "AND", "OR", "NOT", "MOD", "WHEN", "WHILE", "IF"}
CONTINUES = {"DO", "ELSE", "END", "OPTION", "RESUME", "AND", "OR", "MOD", "PRIORITY", "COOLDOWN", "MARGIN", "WAITING", "RESTARTING",
             "SMOOTH", "FADES", "WITHIN"}
BLOCKS = {"IF", "REPEAT", "PICK"}


def words(line):
    return WORD.findall(line)


def relaid(text, seed):
    """The program with other line breaks, and with numbered comments."""
    drawn = random.Random(seed)
    made, before, comments = "", None, 0
    for line in filter(None, map(words, text.splitlines())):
        for at, word in enumerate(line):
            gap = separator(before, word, at == 0, drawn) if before else ""
            if "\n" in gap and drawn.random() < 0.1:
                comments += 1
                made += f"  # comment {comments}"
            made += gap + word
            before = word
    return made + "\n"


def separator(before, word, begins_line, drawn):
    """What stands between two words; in the text, the second one begins a line or not."""
    if before == "ELSE" and word == "IF":  # on one line they are a word of its own
        return "\n" if begins_line else " "
    if before in GOES_ON or word in CONTINUES or (before == "," and word[0] == '"'):
        return drawn.choice((" ", " ", "\n", "\n\n"))
    if begins_line:
        return drawn.choice(("\n", "\n", "\n\n", "\n\n\n"))
    return "" if word == "," else " "


def contents(text):
    """Words and comments in their order, without the blanks between words and the case of letters, which `rsc fmt` changes."""
    parts = re.findall(r'"[^"\n]*"|#.*|[^\s"#]', text)
    return [part if part[0] in '"#' else part.upper() for part in parts]


def crowded(text):
    """The lines of a formatted program that hold more than they may."""
    lines = [words(line) for line in text.splitlines() if line.strip() and line.strip()[0] != "#"]
    return [" ".join(line) for line, below in zip(lines, [*lines[1:], ["END"]]) if is_crowded(line, below)]


def is_crowded(line, below):
    if line[-1][0] == "#":
        line = line[:-1]
        while len(line) > 1 and line[-1] == "END" and not is_on_one_line(line):
            line, below = line[:-1], ["END"]  # the comment stays beside the statement
    if len(line) == 1 or is_on_one_line(line):
        return False
    if "END" in line or "DO" in line[1:-1] or "ELSE" in line[1:] or (line[0] == "ELSE" and line[1] != "IF"):
        return True
    statement = line[2:] if line[0] == "OPTION" and line[1][0].isdigit() else line[1:]
    if line[0] not in ("DO", "OPTION") or not statement:
        return False
    goes_on = statement[-1] in GOES_ON | {","} or below[0] in CONTINUES
    return statement[0] in BLOCKS or not goes_on


def is_on_one_line(line):
    """A rule or an IF with one statement."""
    divided = [word for word in line if word in ("DO", "ELSE", "RESUME", "END")]
    return line[0] != "DO" and divided == ["DO", "END"] and line[-1] == "END" and line[line.index("DO") + 1] not in BLOCKS


def glued(text):
    """Of a formatted program: the items that touch another one although one of both takes several lines; second blank lines."""
    lines = text.splitlines()
    wrong = [f"second blank line {at + 1}" for at in range(1, len(lines)) if not lines[at] and not lines[at - 1]]
    items, is_apart = [], True  # [first line, how many lines, is a blank line above]
    for line in lines:
        if not line:
            is_apart = True
        elif line[0] == " " or words(line)[0] in CONTINUES:
            items[-1][1] += 1
            is_apart = False
        elif line[0] != "#":
            items.append([line, 1, is_apart])
            is_apart = False
    return wrong + [line for above, (line, count, apart) in zip(items, items[1:]) if max(above[1], count) > 1 and not apart]

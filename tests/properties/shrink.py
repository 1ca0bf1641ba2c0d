"""Makes a program and its readings smaller as long as they still differ.

Lines are taken out in pieces, whole blocks among them; what no longer compiles is put back.
"""

import tempfile

import comparison


def differs(text, readings, rsc):
    """What does, at one of the levels; nothing when all is the same."""
    with tempfile.TemporaryDirectory(prefix="robosync-shrink-") as folder:
        try:
            source, images = comparison.compile_levels(text, folder, rsc)
            found = comparison.compare(source, images, readings, folder, rsc)
            return next((difference for difference in found if difference is not None and not difference.tie), None)
        except (comparison.Refused, RuntimeError):
            return None


def without_pieces(items, still_differs):
    """`items` without what is not needed: halves first, single ones at last."""
    size = max(len(items) // 2, 1)
    while True:
        at, before = 0, len(items)
        while at < len(items):
            less = items[:at] + items[at + size:]
            if still_differs(less):
                items = less
            else:
                at += 1 if size <= 4 else size
        if size == 1 and len(items) == before:
            return items
        size = max(size // 2, 1)


def shrunk(text, readings, rsc=comparison.RSC):
    """A smaller program, fewer readings, and what differs there."""
    def programs_differ(lines):
        return differs("".join(lines), readings, rsc)

    def readings_differ(less):
        return differs(text, less, rsc) if less else None

    readings = without_pieces(readings, readings_differ)
    text = "".join(without_pieces(text.splitlines(keepends=True), programs_differ))
    readings = without_pieces(readings, readings_differ)
    return text, readings, differs(text, readings, rsc)

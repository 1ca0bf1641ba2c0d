"""Decodes what a panel of WS2812 lights would show for the bytes that an SPI master is told to send."""

CODES = {"microbit-v2": ("10000", "11100"), "b-l475e-iot01a": ("100", "110")}
SILENCE = 280e-6
HERTZ = {"microbit-v2": 4e6, "b-l475e-iot01a": 2.5e6}


def colors(board, said, lights):
    """0xRRGGBB of each light, in the order of the chain; None if the bytes are not a picture with silence before and after it."""
    codes = {code: str(bit) for bit, code in enumerate(CODES[board])}
    length = len(CODES[board][0])
    bits = "".join(f"{byte:08b}" for byte in said)
    silence = (len(bits) - 24 * lights * length) // 2
    picture = bits[silence:len(bits) - silence]
    pieces = [picture[at:at + length] for at in range(0, len(picture), length)]
    if "1" in bits[:silence] + bits[len(bits) - silence:] or silence < SILENCE * HERTZ[board] or not codes.keys() >= set(pieces):
        return None
    plain = "".join(codes[piece] for piece in pieces)
    parts = [[int(plain[at + 8 * part:at + 8 * part + 8], 2) for part in (1, 0, 2)] for at in range(0, len(plain), 24)]
    return [red << 16 | green << 8 | blue for red, green, blue in parts]


def chain(picture, color, side, zigzag):
    """The same for a picture given as five rows of signs, centred on a panel with `side` rows."""
    margin = (side - 5) // 2
    rows = [[0] * side for _ in range(side)]
    for row, signs in enumerate(picture):
        for column, sign in enumerate(signs):
            rows[margin + row][margin + column] = color if sign == "#" else 0
    return [light for number, row in enumerate(rows) for light in (row[::-1] if zigzag and number % 2 else row)]

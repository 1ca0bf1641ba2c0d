"""A second implementation of the serial protocol, so that the tests can also violate it.

COBS and the CRC are implemented again; message numbers and payload layouts are read from link/, so that
they have one definition. For their meaning see link/frame.hpp and link/messages.hpp.
"""

import hashlib
import random
import re
import struct
import time
import zlib
from pathlib import Path
from types import SimpleNamespace

from board import socket_of

LINK = Path(__file__).resolve().parents[2] / "link"
REFUSALS = ["none", *re.findall(r"^REFUSAL\((\w+),", (LINK.parent / "vm/refusals.def").read_text("utf-8"), re.M)]
TYPES = {"std::uint8_t": "B", "std::int8_t": "b", "std::uint16_t": "H", "std::int16_t": "h", "std::uint32_t": "I",
         "std::int32_t": "i", "std::uint64_t": "Q", "Name": "16s",
         "ProgramHash": "8s", "SessionId": "I"}
CRC_AT, NAME_AT, LINES_AT = 4, 16, 64  # ImageHeader: CRC-32 of everything after it; program_hash; source_lines


def _read_numbers():
    text = (LINK / "messages.def").read_text("utf-8")
    found = re.findall(r"^MESSAGE\((\w+),\s*(\d+),", text, re.M)
    return {name: int(number) for name, number in found}


def _read_enums(text):
    return {name: [word.strip() for word in body.split(",") if word.strip()]
            for name, body in re.findall(r"enum class (\w+) : std::uint8_t \{([\w\s,]+)\}", text)}


def _enum_names(text):
    """Also those whose values come from a .def file."""
    return set(re.findall(r"enum class (\w+) : std::uint8_t", text))


def _read_aliases(text):
    return dict(re.findall(r"^using (\w+) = ([\w:]+<[^;]*>);", text, re.M))


def _field(type_name, enums):
    if type_name in enums:
        return "B"
    if type_name not in TYPES:
        type_name = ALIASES.get(type_name, type_name)
    if match := re.fullmatch(r"std::array<([\w:]+), (\d+)>", type_name):
        element = TYPES[match[1]]
        return f"{match[2]}s" if element == "B" else match[2] + element
    return TYPES[type_name]


def _read_structs(text, enums):
    structs = {}
    for name, body in re.findall(r"^struct (\w+) \{(.*?)^\};", text, re.M | re.S):
        fields = [(field.strip(), _field(kind, enums))
                  for kind, names in re.findall(r"([\w:]+(?:<[^;]*>)?)\s+([\w,\s]+)(?:\{\}| = 0)?;", body)
                  for field in names.split(",")]
        structs[name] = fields
    return structs


_MESSAGES = re.sub(r"//.*", "", (LINK / "messages.hpp").read_text("utf-8"))
MOST_PAYLOAD = int(re.search(r"kMaxPayload = (\d+)", _MESSAGES)[1])
NUMBERS = _read_numbers()
NAMES = {number: name for name, number in NUMBERS.items()}
ENUMS = _read_enums(_MESSAGES)
ALIASES = _read_aliases(_MESSAGES)
STRUCTS = _read_structs(_MESSAGES, _enum_names(_MESSAGES))


def layout(name):
    return struct.Struct("<" + "".join(code for _, code in STRUCTS[name]))


def pack(name, **values):
    return layout(name).pack(*(values[field] for field, _ in STRUCTS[name]))


def unpack(name, payload):
    values = layout(name).unpack(payload)
    return SimpleNamespace(**{field: value for (field, _), value in zip(STRUCTS[name], values)})


def activation(session, name):
    """Its variables begin as the program says: tests run one program after the other."""
    return pack("Activate", session=session, hash=name, trial_ms=0, goes_back=0, fresh=1, reserved=bytes(2))


def piece_head(session, offset):
    """The head of `data` and `pieces`."""
    return pack("Data", session=session & 0xFFFF, offset=offset)


def name_of(image):
    """The name in its header, which the protocol uses for it."""
    return image[NAME_AT:NAME_AT + 8].ljust(8, b"\0")


def sealed(image):
    """The same bytes with name and checksum corrected according to vm/identity.hpp. `image` has a complete header."""
    lines, = struct.unpack_from("<H", image, LINES_AT)
    counted = bytearray(image[:len(image) - 4 * lines])
    for at, length in ((CRC_AT, 8), (NAME_AT, 8), (LINES_AT, 2)):
        counted[at:at + length] = bytes(length)
    return with_crc(image[:NAME_AT] + hashlib.sha256(counted).digest()[:8] + image[NAME_AT + 8:])


def with_crc(image):
    """The same bytes with the checksum corrected."""
    return image[:CRC_AT] + struct.pack("<I", zlib.crc32(image[CRC_AT + 4:])) + image[CRC_AT + 4:]


def crc16(data):
    crc = 0xFFFF
    for byte in data:
        crc ^= byte << 8
        for _ in range(8):
            crc = (crc << 1 ^ 0x1021 if crc & 0x8000 else crc << 1) & 0xFFFF
    return crc


def cobs(data):
    """Without the delimiter. Blocks are shorter than 254 bytes here, so no block is full."""
    return b"".join(bytes([len(part) + 1]) + part for part in data.split(b"\0"))


def uncobs(data):
    out, at = bytearray(), 0
    while at < len(data):
        distance = data[at]
        out += data[at + 1:at + distance] + b"\0"
        at += distance
    return bytes(out[:-1]) if at == len(data) else None


def frame(name, payload=b"", sequence=0):
    content = bytes([NUMBERS[name], sequence]) + payload
    return cobs(content + struct.pack("<H", crc16(content))) + b"\0"


class Line:
    """The host's end of a board's serial line."""

    def __init__(self, port, timeout=20):
        self._timeout = timeout
        self._socket = socket_of(port)
        self._socket.settimeout(timeout)
        self._received = b""
        self._sequence = 0
        self.session = random.randrange(1, 1 << 32)
        self._name = bytes(8)

    def send_raw(self, data):
        self._socket.sendall(data)

    def ask(self, name, payload=b"", reply=None):
        """Sends a message and returns the payload of the next `reply`, skipping events and logs."""
        self._sequence = (self._sequence + 1) % 256
        self.send_raw(frame(name, payload, self._sequence))
        return self.expect(reply)

    def expect(self, name):
        deadline = time.monotonic() + self._timeout
        while time.monotonic() < deadline:
            got, payload = self._next_frame()
            if got == name:
                return payload
        raise TimeoutError(f"the board sent no {name}")

    def _next_frame(self):
        while b"\0" not in self._received:
            data = self._socket.recv(4096)
            if not data:
                raise ConnectionError("the line was closed")
            self._received += data
        block, self._received = self._received.split(b"\0", 1)
        content = uncobs(block)
        if content is None or len(content) < 4:
            return None, b""
        body, (crc,) = content[:-2], struct.unpack("<H", content[-2:])
        if crc16(body) != crc:
            raise ValueError("the board sent a damaged frame")
        return NAMES[body[0]], body[2:]

    def close(self):
        self._socket.close()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def status(self):
        return unpack("Status", self.ask("get_status", reply="status"))

    def hello(self, take=0):
        """Opens the session that transfer() and activate() need."""
        return unpack("HelloReply", self.ask("hello", self.introduction(take), reply="hello_reply"))

    def introduction(self, take=0):
        return pack("Hello", session=self.session, take=take, reserved=bytes(3), host=b"wire.py")

    def beginning(self, size, name):
        return pack("Begin", session=self.session, size=size, hash=name, base=bytes(8))

    def transfer(self, image):
        """Sends an image as it is; returns the last transfer_status."""
        self._name = name_of(image)
        reply = self.ask("begin", self.beginning(len(image), self._name), "transfer_status")
        status = unpack("TransferStatus", reply)
        most = MOST_PAYLOAD - layout("Data").size
        while ENUMS["TransferState"][status.state] == "receiving":
            offset = status.next_offset
            data = piece_head(self.session, offset) + image[offset:offset + most]
            status = unpack("TransferStatus", self.ask("data", data, "transfer_status"))
        return status

    def resumption(self):
        """The payload of `resume`."""
        return pack("Resume", session=self.session)

    def activate(self):
        """Activates the image that was transferred last."""
        return unpack("ActivateResult", self.ask("activate", activation(self.session, self._name), reply="activate_result"))

    def try_image(self, image):
        """Transfers and activates the image, unchecked: (why the board refuses it or "none", whether it now runs)."""
        state = ENUMS["TransferState"][self.transfer(image).state]
        if state != "complete":
            raise ValueError(f"the transfer is {state}")
        result = self.activate()
        return REFUSALS[result.refusal], bool(result.running)

"""docs/link.md is sufficient to write a client: this one reads only the page, talks to the shipped firmware, uploads a
program and receives the program's trace."""

import re
import struct
import unittest
from pathlib import Path
from types import SimpleNamespace

from board import ROOT, socket_of
from support import PROGRAMS, RobotTest

PAGE = (ROOT / "docs/link.md").read_text("utf-8")
CODES = {"u8": "B", "i8": "b", "u16": "H", "i16": "h", "u32": "I", "i32": "i", "u64": "Q", "char": "s"}
SESSION = 0x1234ABCD
NO_BASE = bytes(8)


class Message:
    """A section of the page: number and layout."""

    def __init__(self, number, text):
        self.number = int(number)
        head, *rest = re.split(r"^(?:Then|The text).*$", text, maxsplit=1, flags=re.M)
        self.fields = re.findall(r"^\| (\d+) \| (\w+)(?:\[(\d+)\])? \| (\w+) \|", head, re.M)
        self.values = {name: dict(re.findall(r"(\d+) (\w+)(?=[,:| ])", line)) for name, line in
                       re.findall(r"^\| \d+ \| u8 \| (\w+) \|(.*)$", head, re.M)}
        form = "".join((count + "s" if kind in ("u8", "char") and count else (count or "") + CODES[kind])
                       for _, kind, count, _ in self.fields)
        self.layout = struct.Struct("<" + form)
        self.offsets_are_right = all(int(offset) == struct.calcsize("<" + re.match(r"(?:\d*[a-zA-Z]){%d}" % n, form)[0])
                                     for n, (offset, *_) in enumerate(self.fields))

    def pack(self, **values):
        return self.layout.pack(*(values.get(name, b"" if code in ("u8", "char") and count else 0)
                                  for _, code, count, name in self.fields))

    def unpack(self, payload):
        values = self.layout.unpack_from(payload)
        return SimpleNamespace(**{name: value for (*_, name), value in zip(self.fields, values)})


def messages():
    part = PAGE.split("## Payloads", 1)[1].split("#### Kinds of events")[0]
    return {name: Message(number, text)
            for name, number, text in re.findall(r"^#### `(\w+)`: (\d+), [\w ]+\n(.*?)(?=^#### |\Z)", part, re.M | re.S)}


def crc16(data):
    crc = 0xFFFF
    for byte in data:
        crc ^= byte << 8
        for _ in range(8):
            crc = (crc << 1 ^ 0x1021 if crc & 0x8000 else crc << 1) & 0xFFFF
    return crc.to_bytes(2, "little")


def encoded(content):
    return b"".join(bytes([len(part) + 1]) + part for part in (content + crc16(content)).split(b"\0")) + b"\0"


def decoded(block):
    out = b""
    while block:
        distance = block[0]
        out, block = out + block[1:distance] + b"\0", block[distance:]
    content, crc = out[:-3], out[-3:-1]
    assert crc16(content) == crc
    return content


class Client:
    def __init__(self, port):
        self.messages = messages()
        self._names = {message.number: name for name, message in self.messages.items()}
        self._line = socket_of(port)
        self._line.settimeout(20)
        self._line.sendall(b"\0")
        self._received = b""
        self._sequence = 0

    def ask(self, name, reply, more=b"", **values):
        self._sequence = (self._sequence + 1) % 255
        message = self.messages[name]
        self._line.sendall(encoded(bytes([message.number, self._sequence]) + message.pack(**values) + more))
        while True:
            got, sequence, payload = self.next()
            if (got, sequence) == (reply, self._sequence):
                return self.messages[got].unpack(payload)
            assert got != "busy" or sequence != self._sequence, "busy"

    def next(self):
        while b"\0" not in self._received:
            self._received += self._line.recv(4096)
        block, self._received = self._received.split(b"\0", 1)
        if not block:
            return self.next()
        content = decoded(block)
        return self._names[content[0]], content[1], content[2:]

    def close(self):
        self._line.close()


class FromThePage(RobotTest):
    def setUp(self):
        super().setUp()
        self.status()  # the board has started: the client of the page repeats no request
        self.client = Client(self.board.port)
        self.addCleanup(self.client.close)

    def hello(self):
        return self.client.ask("hello", "hello_reply", session=SESSION, host=b"page")

    def upload(self, image):
        """Alternates between pieces that copy nothing, and data."""
        name = image[16:24]
        status = self.client.ask("begin", "transfer_status", session=SESSION, size=len(image), hash=name, base=NO_BASE)
        states = self.client.messages["transfer_status"].values["state"]
        while states[str(status.state)] == "receiving":
            offset = status.next_offset
            part = image[offset:offset + 200]
            how, head = ("data", b"") if offset % 400 == 0 else ("pieces", struct.pack("<HHH", 0, 0, len(part)))
            status = self.client.ask(how, "transfer_status", head + part, session=SESSION & 0xFFFF, offset=offset)
        self.assertEqual(states[str(status.state)], "complete")
        return self.client.ask("activate", "activate_result", session=SESSION, hash=name)

    def test_a_client_written_from_the_page_uploads_and_listens(self):
        board = self.hello()
        self.assertEqual(board.running, 0)
        self.assertGreaterEqual(board.receive_window, 492)
        image = Path(self.compile(PROGRAMS / "paper.rsl")).read_bytes()
        self.assertEqual(self.upload(image).running, 1)
        self.assertEqual(self.hello().program_hash, image[16:24])
        self.client.ask("trace_on", "status", on=1)
        self.assertEqual(self.client.ask("feed", "feed_result", session=SESSION, channel=0, value=1000).error, 0)
        kinds = dict(re.findall(r"^\| (\d+) \| (\w+) \| \w+ \| \w+ \| ", PAGE.split("#### Kinds of events")[1], re.M))
        seen = set()
        while "command" not in seen:
            name, _, payload = self.client.next()
            if name == "event":
                seen.add(kinds[str(self.client.messages["event"].unpack(payload).kind)])
        self.assertLessEqual({"input", "fire", "win", "command"}, seen)

    def test_offsets_are_those_of_the_types(self):
        self.assertGreater(len(self.client.messages), 25)
        for name, message in self.client.messages.items():
            self.assertTrue(message.offsets_are_right, name)

    def test_what_names_no_session_changes_nothing(self):
        image = Path(self.compile(PROGRAMS / "paper.rsl")).read_bytes()
        with self.assertRaisesRegex(AssertionError, "busy"):
            self.upload(image)
        self.assertEqual(self.hello().running, 0)

    def test_the_example_of_a_frame_is_right(self):
        shown = bytes.fromhex(re.search(r"^((?:[0-9a-fA-F]{2} )+)  +03: the first zero", PAGE, re.M)[1])
        trace_on = self.client.messages["trace_on"]
        self.assertEqual(encoded(bytes([trace_on.number, 7]) + trace_on.pack(on=0)), shown)


if __name__ == "__main__":
    unittest.main()

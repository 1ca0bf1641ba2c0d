"""docs/link.md is sufficient to write a client: this one reads only the page, talks to the shipped firmware, uploads a
program and receives the program's trace."""

import ctypes
import hashlib
import os
import re
import struct
import unittest
from pathlib import Path
from types import SimpleNamespace

from board import ROOT, socket_of
from support import PROGRAMS, RobotTest
from test_store import Switched

PAGE = (ROOT / "docs/link.md").read_text("utf-8")
CODES = {"u8": "B", "i8": "b", "u16": "H", "i16": "h", "u32": "I", "i32": "i", "u64": "Q", "char": "s"}
SESSION = 0x1234ABCD
NO_BASE = bytes(8)
END_OF_BEGIN = "The end of a signed `begin`"
TRIES = 20


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


def section(title):
    """A part of the page behind the messages: the text up to the next heading."""
    return re.search(rf"^#### {re.escape(title)}\n(.*?)(?=^#### |\Z)", PAGE, re.M | re.S)[1]


def numbered(title):
    """{number: name} of a table of numbers."""
    return {int(number): name for number, name in re.findall(r"^\| (\d+) \| (\w+) \|", section(title), re.M)}


class Key:
    """A private key of Ed25519 (RFC 8032), with libsodium."""

    def __init__(self):
        self._sodium = ctypes.CDLL("libsodium.so.23")
        self._secret, public = ctypes.create_string_buffer(64), ctypes.create_string_buffer(32)
        self._sodium.crypto_sign_seed_keypair(public, self._secret, os.urandom(32))
        self.public = public.raw

    def sign(self, text):
        signature = ctypes.create_string_buffer(64)
        self._sodium.crypto_sign_detached(signature, None, text, ctypes.c_ulonglong(len(text)), self._secret)
        return signature.raw


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

    def order(self, key, name, payload, reply):
        """Sends an order signed with `key`."""
        said = self.ask("get_authority", "authority")
        number = self.messages[name].number
        text = Message(0, section("Signed text"))
        words = re.search(r"\| words \| `(.*)` \|", section("Signed text"))[1].encode()
        signed = text.pack(words=words, boot=said.boot, number=said.next, type=number, length=len(payload)) + payload
        return self.ask("signed_order", reply, payload, signature=key.sign(signed), boot=said.boot, number=said.next, type=number)

    def transfer(self, image, status):
        """What follows the reply to `begin`. Alternates between pieces that copy nothing, and data. Returns the last state."""
        states = self.messages["transfer_status"].values["state"]
        while states[str(status.state)] == "receiving":
            offset = status.next_offset
            part = image[offset:offset + 200]
            how, head = ("data", b"") if offset % 400 == 0 else ("pieces", struct.pack("<HHH", 0, 0, len(part)))
            status = self.ask(how, "transfer_status", head + part, session=SESSION & 0xFFFF, offset=offset)
        return states[str(status.state)]

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
        name = image[16:24]
        status = self.client.ask("begin", "transfer_status", session=SESSION, size=len(image), hash=name, base=NO_BASE)
        self.assertEqual(self.client.transfer(image, status), "complete")
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
        others = {title: Message(0, section(title)) for title in (END_OF_BEGIN, "Signed text")}
        for name, message in {**self.client.messages, **others}.items():
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


class Owner(Switched):
    """The page is enough to own a robot, too."""

    def setUp(self):
        super().setUp()
        self.key = Key()

    def pair(self):
        """Tries several times: the board's first minute is short, since its time runs ahead of the host's."""
        for _ in range(TRIES):
            self.power_cycle()
            client = Client(self.board.port)
            names = client.messages["authority"].values
            seed = os.urandom(16)
            said = client.ask("pair", "authority", key=self.key.public, seed=seed)
            while names["denial"][str(said.denial)] == "starting":
                said = client.ask("pair", "authority", key=self.key.public, seed=seed)
            if names["pairing"][str(said.pairing)] == "paired":
                self.addCleanup(client.close)
                return client
            client.close()
        return self.fail("never in time")

    def upload(self, client, image):
        begin = client.messages["begin"].pack(session=SESSION, size=len(image), hash=image[16:24], base=NO_BASE)
        ends = Message(0, section(END_OF_BEGIN)).pack(image=hashlib.sha512(image).digest()[:32])
        self.assertEqual(client.transfer(image, client.order(self.key, "begin", begin + ends, "transfer_status")), "complete")
        return client.ask("activate", "activate_result", session=SESSION, hash=image[16:24])

    def test_a_client_written_from_the_page_signs_an_upload_and_understands_a_refusal(self):
        image = Path(self.compile(PROGRAMS / "paper.rsl")).read_bytes()
        client = self.pair()
        client.ask("hello", "hello_reply", session=SESSION, host=b"page")
        denied = client.ask("begin", "authority", session=SESSION, size=len(image), hash=image[16:24], base=NO_BASE)
        self.assertEqual(client.messages["authority"].values["denial"][str(denied.denial)], "unsigned_order")
        damaged = image[:4] + bytes([image[4] ^ 1]) + image[5:]  # in its CRC
        result = self.upload(client, damaged)
        self.assertEqual((result.running, numbered("Refusals")[result.refusal], numbered("Sections")[result.section]),
                         (0, "bad_crc", "header"))
        result = self.upload(client, image)
        self.assertEqual((result.running, numbered("Refusals")[result.refusal]), (1, "none"))
        self.assertEqual(client.ask("hello", "hello_reply", session=SESSION, host=b"page").program_hash, image[16:24])


if __name__ == "__main__":
    unittest.main()

"""A robot with an owner: the shipped firmware verifies what rsc has signed with libsodium, accepts nothing from anybody else, and
remembers its owner after it was switched off. A stranger replays frames that he has recorded on the line."""

import base64
import os
import re
import stat
import unittest
from unittest import mock

import rsc
import wire
from board import NAME, PRESETS
from support import PROGRAMS
from tap import Tap
from test_store import Switched

# Bytes of the link's stack that a signature does not need: an interrupt and a switch store 72 there (stack_depth.FRAMES).
# test_stack_depth.py bounds all paths.
SPARE = 100
TRIES = 20
FAST_LINE = 2_000_000
# The boards whose firmware is built without signatures.
UNSIGNED = {told["ROBOSYNC_BOARD"] for told in (preset.get("cacheVariables", {}) for preset in PRESETS)
            if told.get("ROBOSYNC_AUTHENTICATION") == "OFF"}
DENIALS = re.findall(r"^DENIAL\((\w+),", (wire.LINK / "denials.def").read_text("utf-8"), re.M)


class Recorder(Tap):
    """A line that records the bytes to the board (`heard`) and from it (`said`)."""

    def __init__(self, folder, port):
        self.heard = self.said = b""
        super().__init__(folder, port, FAST_LINE)

    def note(self, counter, data):
        if counter == "to_board":
            self.heard += data
        else:
            self.said += data


def ways_to_write(secret):
    """The bytes themselves, and how a text could show them."""
    return [secret, secret.hex().encode(), secret.hex().upper().encode(), base64.b64encode(secret)]


def shows(data, secret):
    return any(way in data for way in ways_to_write(secret))


def contents(line):
    """What the frames of a line contain: on the line, zeros are replaced."""
    return b"\n".join(wire.uncobs(part) or b"" for part in line.split(b"\0"))


@unittest.skipIf(NAME in UNSIGNED, "the firmware of this board verifies no signatures")
class Owner(Switched):
    def setUp(self):
        super().setUp()
        settings = {name: value for name, value in os.environ.items() if name != "XDG_CONFIG_HOME"}
        settings["XDG_CONFIG_HOME"] = str(self.folder / "settings")
        patch = mock.patch.dict(os.environ, settings, clear=True)
        patch.start()
        self.addCleanup(patch.stop)

    def refused(self, says, *arguments):
        done = rsc.call(*arguments, "--port", self.board.port)
        self.assertEqual(done.returncode, 3, (arguments, done.stdout, done.stderr))
        self.assertIn(says, done.stderr)

    def owner(self):
        return rsc.info(self.board.port)["owner"]

    def link_thread(self):
        return next(thread for thread in rsc.info(self.board.port)["threads"] if thread["name"] == "link")

    def order(self, line, name, payload=b"", **changes):
        """Sends a stranger's signed order, correct except for the signature; returns why it is denied."""
        said = wire.unpack("Authority", line.ask("get_authority", reply="authority"))
        parts = {"signature": bytes(range(64)), "boot": said.boot, "number": said.next, "type": wire.NUMBERS[name],
                 "reserved": bytes(7), **changes}
        reply = line.ask("signed_order", wire.pack("SignedOrder", **parts) + payload, "authority")
        return DENIALS[wire.unpack("Authority", reply).denial]

    def test_from_keygen_to_unpair(self):
        image = self.compile(PROGRAMS / "priorities.rsl")
        self.assertEqual(self.owner(), {"pairing": "unpaired", "key": None})
        said = rsc.run("monitor", "--port", self.board.port, "--duration", "50ms").splitlines()
        self.assertIn("nobody: anyone on this line can give the robot orders, until `rsc pair`", said[1])
        self.refused("there is no key: make one with rsc keygen", "pair")

        key = rsc.run("keygen").split(" is your key ")[1].split()[0]
        file = self.folder / "settings/robosync/key"
        self.assertEqual(stat.S_IMODE(file.stat().st_mode), 0o600)
        kept = file.read_bytes()
        self.assertEqual(rsc.call("keygen").returncode, 3)
        self.assertEqual(file.read_bytes(), kept)
        self.assertIn(key, self.pair())
        self.assertEqual(self.owner(), {"pairing": "paired", "key": key})

        self.owner_and_stranger(image)
        self.after_the_power(image)
        rsc.run("unpair", "--port", self.board.port)
        self.assertEqual(self.owner()["pairing"], "unpaired")
        file.unlink()
        self.upload(image)

    def test_the_secrets_are_in_no_image_recording_trace_or_reply(self):
        image = self.compile(PROGRAMS / "priorities.rsl")
        rsc.run("keygen")
        self.pair()
        key_file = self.folder / "settings/robosync/key"
        key = bytes.fromhex(key_file.read_text().split()[-1])
        texts = {}
        with Recorder(self.folder, self.board.port) as line:
            rsc.run("upload", image, "--port", line.port)
            for name, *words in (("monitor", "--duration", "500ms", "--format", "json", "--record", self.folder / "record.jsonl"),
                                 ("info",), ("stop",), ("resume",)):
                texts[name] = rsc.run(name, "--port", line.port, *words).encode()
        self.await_kept("kept")
        self.board.stop()
        file = self.folder / "store"
        store = file.read_bytes()
        seed = store[store.index(b"RSO1") + 40:][:16]  # KeyStore::Record: magic, number, public key, seed
        self.assertNotIn(seed, (bytes(16), b"\xff" * 16))
        self.assertTrue(shows(key_file.read_bytes(), key))  # the search finds what is there
        places = {**{str(path): path.read_bytes() for path in self.folder.rglob("*") if path.is_file()}, **texts,
                  "to the board": contents(line.heard), "from the board": contents(line.said)}
        self.assertLess({str(image), str(self.folder / "record.jsonl"), str(file)}, set(places))
        self.assertEqual([name for name, data in places.items() if shows(data, key)], [str(key_file)])
        self.assertEqual([name for name, data in places.items() if shows(data, seed)], [str(file)])

    def pair(self):
        """Tries several times: the board's first minute is short, since its time runs ahead of the host's."""
        for _ in range(TRIES):
            self.power_cycle()
            done = rsc.call("pair", "--port", self.board.port)
            if done.returncode == 0:
                return done.stdout
            self.assertIn("in the first minute after it is switched on", done.stderr)
        return self.fail("never in time")

    def owner_and_stranger(self, image):
        with Recorder(self.folder, self.board.port) as line:
            rsc.run("upload", image, "--port", line.port)
            rsc.run("stop", "--port", line.port)
            rsc.run("resume", "--port", line.port)
        before = rsc.info(self.board.port)
        self.assertFalse(before["state"]["stopped"])
        other = ("--key", self.folder / "other")
        rsc.run("keygen", *other)
        for arguments in (("upload", image), ("resume",), ("unpair",), ("feed", "touch.LEVEL=1")):
            self.refused("the robot's owner has the key", *arguments, *other)
        self.refused("already has an owner", "pair", *other)
        self.refused("there is no key", "resume", "--key", self.folder / "none")
        with wire.Line(self.board.port) as stranger:
            self.replay(stranger, line.heard)
            self.forge(stranger, before["board"]["program"]["hash"])
        after = rsc.info(self.board.port)
        for name in ("activations", "faults"):
            self.assertEqual(after["status"][name], before["status"][name])
        self.assertEqual(after["board"]["program"]["hash"], before["board"]["program"]["hash"])
        rsc.run("stop", "--port", self.board.port)  # everybody may send it
        self.refused("the robot's owner has the key", "resume", *other)
        rsc.run("resume", "--port", self.board.port)  # waits until the board verifies signatures again
        self.assertFalse(rsc.info(self.board.port)["state"]["stopped"])
        thread = self.link_thread()
        self.assertLess(thread["stack_used"] + SPARE, thread["stack_bytes"])

    def replay(self, stranger, heard):
        """Replays all frames except those of `stop`, which would stop the robot."""
        frames = [part + b"\0" for part in heard.split(b"\0") if part and part + b"\0" != wire.frame("stop", sequence=255)]
        self.assertTrue(any(wire.uncobs(part[:-1])[0] == wire.NUMBERS["signed_order"] for part in frames))
        for part in frames:
            stranger.send_raw(part)
        stranger.status()

    def forge(self, stranger, name):
        clear = wire.pack("Clear", session=1, hash=bytes.fromhex(name))
        for name, payload in (("clear", clear), ("resume", b""), ("begin", wire.pack("Begin", session=1, size=8, hash=bytes(8), base=bytes(8)))):
            reply = wire.unpack("Authority", stranger.ask(name, payload, "authority"))
            self.assertEqual(DENIALS[reply.denial], "unsigned_order")
        self.assertEqual(self.order(stranger, "clear", clear, number=0), "stale")
        self.assertEqual(self.order(stranger, "clear", clear), "bad_signature")
        self.assertEqual(self.order(stranger, "stop"), "bad_signature")
        stranger.send_raw(b"".join(wire.frame("signed_order", os.urandom(length)) for length in range(0, 240, 5)))
        stranger.status()

    def after_the_power(self, image):
        self.await_kept("kept")
        with Recorder(self.folder / "settings", self.board.port) as line:
            rsc.run("upload", image, "--port", line.port)
        key = self.owner()["key"]
        self.power_cycle()
        self.await_kept("kept")
        self.assertEqual(self.owner(), {"pairing": "paired", "key": key})
        activations = rsc.info(self.board.port)["status"]["activations"]
        with wire.Line(self.board.port) as stranger:
            self.replay(stranger, line.heard)
        self.assertEqual(rsc.info(self.board.port)["status"]["activations"], activations)
        self.upload(image)
        self.assertEqual(rsc.info(self.board.port)["status"]["activations"], activations + 1)


if __name__ == "__main__":
    unittest.main()

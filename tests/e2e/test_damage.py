"""Damaged data is refused with a reason, and the running program continues."""

import random
import struct
import time
import unittest

import rsc
import wire
from support import PROGRAMS, LineReader, RobotTest

BODY_AT = 8  # ImageHeader: magic, CRC-32 of everything after it
SILENCE = 3.5  # s, after which a host in the middle of a transfer counts as gone


class Damage(RobotTest):
    def setUp(self):
        super().setUp()
        self.image = self.compile(PROGRAMS / "priorities.rsl").read_bytes()
        self.upload(self.compile(PROGRAMS / "paper.rsl"))
        self.line = wire.Line(self.board.port)
        self.addCleanup(lambda: self.line.close())
        self.before = self.line.hello()

    def activate(self, image):
        """The name of the refusal, or "none" if the image now runs."""
        name, running = self.line.try_image(image)
        self.assertEqual(running, name == "none")
        return name

    def assert_goes_on(self):
        """The paper's program still runs, and reacts to a reading."""
        now = self.line.hello()
        self.assertEqual((now.program_hash, now.running), (self.before.program_hash, 1))
        self.line.close()
        reader = LineReader("feed", "touch.LEVEL=1", "touch.LEVEL=8", "--port", self.board.port,
                            "--watch", "20s", "--format", "json")
        reacted = reader.wait_for(lambda lines: any('"fire"' in line for line in lines), 20)
        errors = reader.stop()
        self.assertTrue(reacted, errors)
        self.line = wire.Line(self.board.port)

    def test_the_undamaged_image_runs(self):
        self.assertEqual(self.activate(self.image), "none")
        self.assertEqual(self.line.hello().running, 1)
        self.assertNotEqual(self.line.hello().program_hash, self.before.program_hash)

    def test_flipped_bytes(self):
        for at in range(0, len(self.image), 7):
            damaged = bytearray(self.image)
            damaged[at] ^= 0x10
            with self.subTest(at=at):
                self.assertNotEqual(self.activate(bytes(damaged)), "none")
        self.assert_goes_on()

    def test_flipped_bytes_with_the_checksum_put_right(self):
        """Some are still programs; then they run, and nothing faults, hangs or restarts."""
        random_ = random.Random(7)
        uptime, seen = self.line.status().uptime_us, set()
        for _ in range(300):
            damaged = bytearray(self.image)
            for _ in range(random_.choice([1, 1, 2, 5])):
                damaged[random_.randrange(BODY_AT, len(damaged))] = random_.randrange(256)
            seen.add(self.activate(wire.sealed(bytes(damaged))))
        status = self.line.status()
        self.assertGreater(status.uptime_us, uptime)
        self.assertEqual((status.faults, status.reset_reason), (0, 0))
        self.assertGreater(len(seen - {"none"}), 5, seen)  # the verifier has checked more than the CRC
        self.assertFalse({"bad_crc", "wrong_name"} & seen)
        self.assertEqual(self.activate(self.image), "none")

    def test_reasons(self):
        def patched(offset, data):
            return wire.sealed(self.image[:offset] + data + self.image[offset + len(data):])

        cases = {
            "bad_magic": b"ELF!" + self.image[4:],
            "bad_crc": self.image[:-1] + bytes([self.image[-1] ^ 1]),
            "wrong_name": wire.with_crc(self.image[:24] + bytes([self.image[24] ^ 1]) + self.image[25:]),  # in its seed
            "wrong_version": patched(12, b"\x09"),
            "wrong_opcodes": patched(14, b"\xde\xad"),
            "bad_length": patched(8, struct.pack("<I", len(self.image) - 4)),
            "too_short": patched(8, struct.pack("<I", len(self.image) + 4)),
            "cost_differs": patched(28, struct.pack("<I", 1)),
        }
        for reason, image in cases.items():
            with self.subTest(reason=reason):
                self.assertEqual(self.activate(image), reason)
        self.assert_goes_on()

    def test_an_image_for_nobody(self):
        self.assertEqual(wire.ENUMS["TransferState"][self.line.transfer(bytes(100_000)).state],
                         "too_large")
        self.assert_goes_on()

    def test_activating_again_does_nothing_twice(self):
        """The reply may have been lost, so the host asks again and gets the same."""
        self.assertEqual(self.activate(self.image), "none")
        activations = self.line.status().activations
        again = [self.line.activate() for _ in range(3)]
        self.assertEqual(again[0], again[2])
        self.assertEqual(again[0].running, 1)
        self.assertEqual(self.line.status().activations, activations)

    def test_half_a_transfer(self):
        self.line.ask("begin", self.line.beginning(len(self.image), bytes(7) + b"1"), "transfer_status")
        self.line.ask("data", wire.piece_head(self.line.session, 0) + self.image[:100], "transfer_status")
        result = self.line.activate()
        self.assertEqual((result.running, result.refusal), (0, 0xFF))
        time.sleep(SILENCE)
        self.assert_goes_on()

    def test_bad_frames(self):
        """Only the bad frame itself is lost: the request after it is answered."""
        good = wire.frame("get_status")
        random_ = random.Random(3)
        bad = [b"\0\0\0", b"\x01\0", b"\xff" * 2000 + b"\0", good[:3] + b"\0", good[:-1] + b"\x55\0",
               bytes([good[0], good[1] ^ 1]) + good[2:],
               random_.randbytes(5000) + b"\0", wire.frame("begin", b"\x01"),
               wire.frame("feed", bytes(200)), wire.frame("hello_reply", bytes(66)),
               wire.cobs(b"\xee\x01" + struct.pack("<H", wire.crc16(b"\xee\x01"))) + b"\0"]
        for noise in bad:
            with self.subTest(noise=noise[:12]):
                self.line.send_raw(noise)
                self.assertEqual(self.line.status().faults, 0)
        self.assertGreater(self.line.status().bad_frames, 3)
        self.assert_goes_on()

    def test_a_flood(self):
        """A flood of bytes delays nothing: the link's thread has the lowest rank, and its interrupts are short."""
        self.line.send_raw(random.Random(5).randbytes(20_000) + b"\0")
        status = self.line.status()
        self.assertLessEqual(status.safety_late_us, 1000)
        self.assertEqual((status.faults, status.reset_reason), (0, 0))
        self.assertGreater(status.bad_frames, 20)
        self.assert_goes_on()

    def test_rsc_says_why(self):
        damaged = self.folder / "damaged.rsb"
        damaged.write_bytes(self.image[:-1] + bytes([self.image[-1] ^ 1]))
        self.line.close()
        done = rsc.call("upload", damaged, "--port", self.board.port)
        self.assertEqual(done.returncode, 1)
        self.assertIn("checksum", done.stderr)
        self.line = wire.Line(self.board.port)
        self.assert_goes_on()


if __name__ == "__main__":
    unittest.main()

"""own_words: which of the words it has been taught it hears of synthetic voices, also in noise, and what it refuses."""

import array
import random
import re
import resource
import subprocess
import sys
import tempfile
import unittest
import wave
import zlib
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))
from recordings import RATE, needs, program_of, run, samples_of, speak  # noqa: E402

USUAL = ("--period", 60_000, "--strict", 50, "--shown_for", 0.5)
# Voice to the words that it teaches, and others that it says. None of the words were there when the settings were chosen.
VOICES = {
    "en-us+m1": (["robot", "forward", "goodbye", "lamp"], ["window", "yesterday", "cheese", "twelve"]),
    "fr+f2": (["bonjour", "avance", "merci", "doucement"], ["fromage", "demain", "chaise", "vendredi"]),
    "tr": (["merhaba", "dur", "ileri", "oyun"], ["pencere", "yarin", "ekmek", "deniz"]),
    "pl+f4": (["czesc", "stoj", "tancz", "dziekuje"], ["okno", "jutro", "telefon", "sobota"]),
}
TAUGHT = ((150, 45), (165, 50), (180, 55))  # speed, pitch
SAID = ((157, 48), (140, 42), (195, 57))
LEVELS = 20
FRAME = "R" * LEVELS


def shorts(path):
    return array.array("h", samples_of(path))


def write(path, samples, rate=RATE, channels=1):
    with wave.open(str(path), "wb") as out:
        out.setparams((channels, 2, rate, 0, "NONE", ""))
        out.writeframes(samples.tobytes())
    return path


def noise(count, loudness, seed=1):
    """Not white: each sample is near the one before."""
    random_, last, samples = random.Random(seed), 0.0, array.array("h")
    for _ in range(count):
        last = 0.7 * last + random_.gauss(0, loudness)
        samples.append(max(-32768, min(32767, round(last))))
    return samples


def quiet(seconds):
    return array.array("h", bytes(int(seconds * RATE) * 2))


def changes(values):
    return [value for before, value in zip([None, *values], values) if value != before]


class WordsTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="robosync-words-")
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        self.file = self.folder / "my.words"

    def call(self, *arguments):
        done = subprocess.run([program_of("own_words"), "--words", self.file, *map(str, arguments)], check=False, text=True,
                              timeout=60, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        return done.returncode, done.stdout, done.stderr

    def teach(self, word, *recordings):
        return self.call("--teach", word, *(part for path in recordings for part in ("--recording", path)))

    def recordings(self, text, voice="en-us", how=TAUGHT):
        return [speak(text, self.folder / f"{text}-{speed}-{pitch}.wav", voice, speed, pitch) for speed, pitch in how]

    def teach_all(self, words, voice="en-us"):
        for word in words:
            code, _, errors = self.teach(word, *self.recordings(word, voice))
            self.assertEqual((code, errors), (0, ""), word)

    def hear(self, source, words):
        said, errors, code = run("own_words", source, "--words", self.file, *USUAL,
                                 *(part for word in ["none", *words] for part in ("--word", word)))
        self.assertEqual((code, errors), (0, ""))
        self.assertEqual({output for output, _ in said}, {"WORD"})
        return [value for value in changes([value for _, value in said]) if value != "none"]

    def write_words(self, body):
        text = "robosync words 2\n" + body
        self.file.write_text(f"{text}sum {zlib.crc32(text.encode()):08x}\n")

    def in_room(self, path, loudness=3.0):
        """With a second before it, and noise all over it."""
        said = quiet(1) + shorts(path) + quiet(0.6)
        hiss = noise(len(said), loudness)
        mixed = array.array("h", (max(-32768, min(32767, a + b)) for a, b in zip(said, hiss)))
        return write(self.folder / "room.wav", mixed)


@needs("own_words")
class Hearing(WordsTest):
    def rates(self, loudness):
        """(words said, of them heard, taken for another one; other words said, taken for a word), over all voices."""
        counts = [0] * 5
        for voice, (words, others) in VOICES.items():
            self.file.unlink(missing_ok=True)
            self.teach_all(words, voice)
            for word in words:
                for path in self.recordings(word, voice, SAID):
                    heard = self.hear(self.in_room(path, loudness), words)
                    counts[0] += 1
                    counts[1] += heard == [word]
                    counts[2] += any(one != word for one in heard)
            for word in others:
                for path in self.recordings(word, voice, SAID[:1]):
                    counts[3] += 1
                    counts[4] += self.hear(self.in_room(path, loudness), words) != []
        return counts

    def test_voices_in_a_quiet_room(self):
        said, heard, wrong, others, alarms = self.rates(3)
        self.assertEqual((said, others), (48, 16))
        self.assertGreaterEqual(heard, 46)
        self.assertEqual(wrong, 0)
        self.assertLessEqual(alarms, 1)

    def test_voices_in_noise(self):
        """About 20 dB below the loudest of a word."""
        said, heard, wrong, _, alarms = self.rates(400)
        self.assertGreaterEqual(heard, 42)
        self.assertEqual(wrong, 0)
        self.assertLessEqual(alarms, 1)

    def test_a_robot_that_knows_one_word_does_not_hear_it_everywhere(self):
        alarms = 0
        for voice, (words, others) in VOICES.items():
            self.file.unlink(missing_ok=True)
            self.teach_all(words[:1], voice)
            self.assertEqual(self.hear(self.in_room(self.recordings(words[0], voice, SAID)[0]), words[:1]), words[:1])
            for word in words[1:] + others:
                alarms += self.hear(self.in_room(self.recordings(word, voice, SAID[:1])[0]), words[:1]) != []
        self.assertLessEqual(alarms, 1)

    def test_noise_alone_is_no_word(self):
        words, _ = VOICES["tr"]
        self.teach_all(words, "tr")
        for loudness in (1, 100, 3000):
            self.assertEqual(self.hear(write(self.folder / "noise.wav", noise(8 * RATE, loudness)), words), [])
        bursts = array.array("h")
        for i in range(8):
            bursts += noise(RATE // 2, 3) + noise(RATE // 8 * (i % 4 + 1), 4000, i)
        self.assertEqual(self.hear(write(self.folder / "bursts.wav", bursts + quiet(0.5)), words), [])
        tone = array.array("h", [8000 if i // 40 % 2 else -8000 for i in range(RATE)])
        self.assertEqual(self.hear(write(self.folder / "tone.wav", quiet(1) + tone + quiet(1)), words), [])

    def test_a_sentence_is_no_word(self):
        words, _ = VOICES["en-us+m1"]
        self.teach_all(words, "en-us+m1")
        path = speak("the robot went forward to the lamp and said goodbye", self.folder / "s.wav", "en-us+m1", 165)
        self.assertEqual(self.hear(self.in_room(path), words), [])

    def test_one_after_the_other_as_soon_as_they_are_over(self):
        words, _ = VOICES["en-us+m1"]
        self.teach_all(words, "en-us+m1")
        said = quiet(1)
        order = ["lamp", "robot", "robot", "forward"]
        for word in order:
            said += shorts(self.recordings(word, "en-us+m1", SAID[:1])[0]) + quiet(0.9)
        path = write(self.folder / "all.wav", said)
        said, _, _ = run("own_words", path, "--words", self.file, "--period", 20, "--strict", 50, "--shown_for", 0.2,
                         *(part for word in ["none", *words] for part in ("--word", word)))
        values = [value for _, value in said]
        self.assertEqual(changes(values), ["none", *(part for word in order for part in (word, "none"))])
        self.assertAlmostEqual(values.count("lamp"), 0.2 / 0.02, delta=2)
        again, _, _ = run("own_words", path, "--words", self.file, "--period", 20, "--strict", 50, "--shown_for", 0.2,
                          *(part for word in ["none", *words] for part in ("--word", word)))
        self.assertEqual(said, again)

    def test_strict_is_strict(self):
        words, _ = VOICES["fr+f2"]
        self.teach_all(words, "fr+f2")
        path = self.in_room(self.recordings("merci", "fr+f2", SAID[1:2])[0])
        asked = [part for word in ["none", *words] for part in ("--word", word)]
        for strict, expected in ((50, {"none", "merci"}), (200, {"none"})):
            said, _, _ = run("own_words", path, "--words", self.file, "--period", 20, "--shown_for", 0.5, "--strict", strict,
                             *asked)
            self.assertEqual({value for _, value in said}, expected)

    def test_what_the_program_does_not_ask_for_is_not_said(self):
        words, _ = VOICES["en-us+m1"]
        self.teach_all(words, "en-us+m1")
        path = self.in_room(self.recordings("lamp", "en-us+m1", SAID[:1])[0])
        self.assertEqual(self.hear(path, words), ["lamp"])
        self.assertEqual(self.hear(path, ["robot"]), [])

    def test_formats(self):
        """A microphone has the one, a recorder another."""
        self.teach_all(VOICES["en-us+m1"][0], "en-us+m1")
        words = VOICES["en-us+m1"][0]
        path = self.in_room(self.recordings("forward", "en-us+m1", SAID[:1])[0])
        samples = shorts(path)
        stereo = array.array("h", (sample for one in samples for sample in (one, one // 2)))
        self.assertEqual(self.hear(write(self.folder / "stereo.wav", stereo, channels=2), words), ["forward"])
        fast = array.array("h", (sample for one in samples for sample in (one, one, one)))
        self.assertEqual(self.hear(write(self.folder / "fast.wav", fast, rate=48_000), words), ["forward"])
        with wave.open(str(self.folder / "bytes.wav"), "wb") as out:
            out.setparams((1, 1, RATE, 0, "NONE", ""))
            out.writeframes(bytes((sample >> 8) + 128 for sample in samples))
        self.assertEqual(self.hear(self.folder / "bytes.wav", words), ["forward"])

    def test_the_largest_file_takes_a_bounded_time(self):
        """To start, and for an utterance as long as there is."""
        random_ = random.Random(9)
        frames = ("".join(chr(48 + random_.randrange(64)) for _ in range(LEVELS)) for _ in range(92))
        sample = "\n".join(["sample 92", *frames]) + "\n"
        self.write_words("".join(f"word w{i} 400\n" + sample * 8 for i in range(24)))
        times = []
        for said in (bytes(2), noise(RATE * 17 // 10, 3000)):
            sound = (quiet(0.5) + array.array("h", said)) * 3 + quiet(0.5)
            began = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
            self.assertEqual(self.hear(write(self.folder / "said.wav", sound), ["w0"]), [])
            times.append(resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - began)
        start, each = times[0], max(0, times[1] - times[0]) / 3
        print(f"with the largest file: {start:.1f} s of a processor to start, {each:.2f} s an utterance", file=sys.stderr)
        self.assertLess(start, 15)  # after 20 s without a word, it counts as one that hangs
        self.assertLess(each, 2)

    def test_what_it_refuses(self):
        self.teach_all(["robot"])
        silent = write(self.folder / "silent.wav", quiet(1))
        self.assertEqual(self.hear(silent, ["robot"]), [])
        self.assertEqual(self.hear(write(self.folder / "empty.wav", quiet(0)), ["robot"]), [])
        for source, words, code, part in ((silent, ["hello"], 2, "`hello` is not in"), (__file__, ["robot"], 2, "is no sound"),
                                          ("nobody", ["robot"], 3, "the microphone")):
            said, errors, exit_code = run("own_words", source, "--words", self.file, *USUAL,
                                          *(part for word in words for part in ("--word", word)))
            self.assertEqual(exit_code, code, errors)
            self.assertIn(part, errors.splitlines()[-1])
        self.file.unlink()
        _, errors, code = run("own_words", silent, "--words", self.file, *USUAL, "--word", "robot")
        self.assertEqual((code, errors.count("\n")), (2, 1))
        self.assertIn("there is no file of words", errors)


@needs("own_words")
class Teaching(WordsTest):
    def refuse(self, answer, code, *parts):
        self.assertEqual(answer[0], code, answer)
        self.assertEqual(answer[1], "")
        self.assertEqual(answer[2].count("\n"), 1, answer[2])
        for part in parts:
            self.assertIn(part, answer[2])

    def test_recordings_that_are_none_of_a_word(self):
        good = self.recordings("robot")
        long_word = array.array("h")
        for i in range(6):
            long_word += shorts(speak("banana", self.folder / "b.wav", speed=160))[800:8000]
        bad = {
            write(self.folder / "silent.wav", quiet(1)): "no word is heard in it",
            write(self.folder / "short.wav", noise(RATE // 20, 3000)): "no word is heard in it",
            write(self.folder / "empty.wav", quiet(0)): "no word is heard in it",
            write(self.folder / "hour.wav", quiet(11)): "longer than 10 s",
            write(self.folder / "long.wav", quiet(0.5) + long_word): "takes more than 1.8 s",
            write(self.folder / "two.wav", shorts(good[0]) + quiet(0.8) + shorts(good[1])): "2 words are heard in it",
            Path(__file__): "is no sound",
        }
        for path, why in bad.items():
            with self.subTest(path=path.name):
                self.refuse(self.teach("robot", good[0], good[1], path), 2, path.name, why)
        self.refuse(self.teach("robot", good[0], good[1], self.folder / "none.wav"), 3, "there is no file", "none.wav")
        slow = write(self.folder / "slow.wav", shorts(good[0]), rate=4000)
        self.refuse(self.teach("robot", good[0], good[1], slow), 2, "slow.wav has fewer than 8000 samples a second")
        self.assertFalse(self.file.exists())

    def test_how_many_samples(self):
        good = self.recordings("robot")
        self.refuse(self.teach("robot", *good[:2]), 2, "`robot` needs 3 samples: give 1 more")
        self.assertEqual(self.teach("robot", *good)[0], 0)
        code, out, _ = self.teach("Robot", good[0])  # a word is the same in capitals
        self.assertEqual(code, 0)
        self.assertIn("robot ", out)
        self.assertIn("4 samples", out)
        self.refuse(self.teach("robot", *good, *good[:2]), 2, "would have 9 samples, and 8 is the most")

    def test_another_word_among_the_samples(self):
        good = self.recordings("robot")
        other = self.recordings("yesterday")[0]
        self.refuse(self.teach("robot", *good, other), 2, "yesterday-150-45.wav does not sound like the other samples")
        self.assertFalse(self.file.exists())

    def test_names(self):
        good = self.recordings("robot")
        for name in ("", "two words", "1st", "gr\u00fcezi", "none", "UNKNOWN", "x" * 32, "a\nb", "../a"):
            with self.subTest(name=name):
                code, _, errors = self.teach(name, *good)
                self.assertEqual(code, 2)
                self.assertIn("cannot be the name of a word", errors)

    def test_from_a_microphone(self):
        said = quiet(0.5)
        for path in self.recordings("robot"):
            said += shorts(path) + quiet(0.8)
        code, out, _ = self.call("--teach", "robot", "--source", write(self.folder / "three.wav", said))
        self.assertEqual(code, 0)
        self.assertIn("say `robot` (3 of 3)", out)
        words = self.file.read_text()
        self.assertEqual(words.count("sample "), 3)
        self.file.unlink()
        short = write(self.folder / "two.wav", said[:int(len(said) * 0.6)])
        code, _, errors = self.call("--teach", "robot", "--source", short)
        self.assertEqual(code, 2)
        self.assertIn("is heard 2 times in it, and not 3 times", errors)
        code, _, errors = self.call("--teach", "robot", "--source", write(self.folder / "quiet.wav", quiet(12)))
        self.assertEqual(code, 3)
        self.assertIn("nothing that could be a word was heard for 10 s", errors)

    def test_list_and_forget(self):
        self.teach_all(["robot", "lamp"])
        code, out, errors = self.call("--list", "yes")
        self.assertEqual((code, errors), (0, ""))
        self.assertRegex(out, r"^robot +3 samples, \d+ % apart, \d+ % from `lamp`; is heard up to \d+ %\nlamp ")
        self.assertNotIn("warning", out)
        self.refuse(self.call("--forget", "cheese"), 2, "has no word `cheese`")
        self.assertEqual(self.call("--forget", "ROBOT"), (0, "", ""))
        self.assertRegex(self.call("--list", "yes")[1], r"^lamp +3 samples, \d+ % apart; is heard up to \d+ %\n$")
        self.assertEqual(self.call("--forget", "lamp"), (0, "", ""))
        self.assertEqual(self.call("--list", "yes"), (0, "", ""))

    def test_words_that_sound_alike(self):
        self.teach_all(["robot", "lamp"])
        code, out, _ = self.teach("lamb", *self.recordings("lamp"))
        self.assertEqual(code, 0)
        self.assertIn("warning: `lamp` and `lamb` sound alike", out)
        self.assertEqual(out.count("warning"), 1)
        words = re.findall(r"^(\w+) .* (\d+) % from `(\w+)`; is heard up to (\d+) %", self.call("--list", "yes")[1], re.M)
        self.assertEqual([(word, other) for word, _, other, _ in words if word != "robot"], [("lamp", "lamb"), ("lamb", "lamp")])
        for _, nearest, _, most in words:
            self.assertLessEqual(int(most), 0.65 * int(nearest) + 1)

    def test_more_words_than_there_is_room_for(self):
        sample = "\n".join(["sample 8", *[FRAME] * 8])
        self.write_words("".join(f"word w{i} 400\n{sample}\n" for i in range(24)))
        self.assertEqual(self.call("--list", "yes")[0], 0)
        self.refuse(self.teach("robot", *self.recordings("robot")), 2, "has 24 words, which is the most")

    def test_a_file_that_is_none(self):
        self.teach_all(["robot"])
        good, recordings = self.file.read_bytes(), self.recordings("robot")
        random_ = random.Random(7)
        broken = [b"", b"\n", b"robosync words 1\n", b"robosync words 3\n" + good[17:], good[:-1], good + b"\n", good * 2,
                  good.replace(b"\n", b"\r\n"), bytes(1 << 21), random_.randbytes(5000)]
        broken += [good[:random_.randrange(len(good))] for _ in range(10)]
        for _ in range(20):
            flipped = bytearray(good)
            flipped[random_.randrange(len(good))] ^= 1 << random_.randrange(8)
            broken.append(bytes(flipped))
        for content in broken:
            self.file.write_bytes(content)
            for arguments in (("--list", "yes"), ("--forget", "robot"), ("--teach", "robot", "--recording", recordings[0])):
                answer = self.call(*arguments)
                self.refuse(answer, 2, "my.words")
                self.assertNotIn("\0", answer[2])
            self.assertEqual(self.file.read_bytes(), content)  # it is never written over

    def test_lines_that_mean_nothing(self):
        frames = "\n".join([FRAME] * 8)
        for body, line in (("word a 400\n", 2), ("sample 8\n" + frames + "\n", 2), (f"word a 400\nsample 6\n{frames}\n", 3),
                           (f"word a 400\nsample 93\n{frames}\n", 3), (f"word a 400\nsample 9\n{frames}\n", 12),
                           (f"word a 400\nsample 8\n{frames}0\n", 11), (f"word a 400\nsample 8x\n{frames}\n", 3),
                           (f"word a 400\nsample 8\n{frames}\nword A 400\nsample 8\n{frames}\n", 12),
                           (f"word none 400\nsample 8\n{frames}\n", 2),
                           ("hello\n", 2), (f"word a 400\nsample 8\n{frames}\n" + f"sample 8\n{frames}\n" * 8, 75),
                           ("word a 400\n" + f"sample 8\n{frames}\n".replace("R", "~"), 4),
                           (f"word a\nsample 8\n{frames}\n", 2), (f"word a 551\nsample 8\n{frames}\n", 2)):
            with self.subTest(body=body[:30]):
                self.write_words(body)
                self.refuse(self.call("--list", "yes"), 2, f"my.words:{line}: ")

    def test_the_file_is_replaced_as_a_whole(self):
        self.teach_all(["robot"])
        good = self.file.read_bytes()
        (self.folder / "my.words.new").mkdir()  # nobody can write there
        self.refuse(self.teach("lamp", *self.recordings("lamp")), 3, "cannot write", "my.words")
        self.assertEqual(self.file.read_bytes(), good)
        (self.folder / "my.words.new").rmdir()
        self.assertEqual(self.teach("lamp", *self.recordings("lamp"))[0], 0)
        self.assertFalse((self.folder / "my.words.new").exists())
        self.file = self.folder / "nobody/my.words"
        self.refuse(self.teach("lamp", *self.recordings("lamp")), 3, "cannot write")


if __name__ == "__main__":
    unittest.main()

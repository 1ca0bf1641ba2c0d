"""command_words: which words it hears of people and of a synthetic voice, and what it refuses."""

import sys
import tempfile
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))
from recordings import TEST_DATA, as_wav, needs, run, speak  # noqa: E402

USUAL = ("--period", 200, "--strict", 47, "--shown_for", 0.5)


@needs("command_words")
class CommandWords(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="robosync-companion-")
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def hear(self, source, *words, how=USUAL):
        said, errors, code = run("command_words", source, *how, *(part for word in words for part in ("--word", word)))
        self.assertEqual((code, errors), (0, ""))
        self.assertEqual({output for output, _ in said}, {"WORD"})
        return [value for _, value in said]

    @staticmethod
    def changes(values):
        return [value for before, value in zip([None, *values], values) if value != before]

    def test_a_person_says_a_word(self):
        sound = as_wav(TEST_DATA / "goforward.raw", self.folder / "go.wav")  # "go forward ten meters"
        heard = self.hear(sound, "silence", "forward", "meters", "goodbye")
        self.assertEqual(self.changes(heard), ["silence", "forward", "silence", "meters", "silence"])

    def test_words_that_nobody_says_are_not_heard(self):
        sound = as_wav(TEST_DATA / "goforward.raw", self.folder / "go.wav")
        self.assertEqual(self.changes(self.hear(sound, "banana", "goodbye")), ["silence"])

    def test_a_synthetic_voice_says_stop(self):
        sound = speak("please stop now", self.folder / "stop.wav")  # 22,050 samples a second
        self.assertEqual(self.changes(self.hear(sound, "silence", "stop")), ["silence", "stop", "silence"])

    def test_it_says_what_it_knows_once_a_period(self):
        sound = as_wav("/dev/null", self.folder / "quiet.wav", silence=2.0)
        count = len(self.hear(sound, "hello"))
        self.assertTrue(11 <= count <= 15, count)  # 2 s, and the half after its end

    def test_a_word_is_shown_for_so_long(self):
        sound = as_wav(TEST_DATA / "goforward.raw", self.folder / "go.wav")
        short, long = (self.hear(sound, "forward", how=("--period", 20, "--strict", 47, "--shown_for", shown))
                       for shown in (0.1, 0.4))
        self.assertEqual(short.count("forward"), 5)
        self.assertEqual(long.count("forward"), 20)

    def test_two_words_are_one(self):
        sound = as_wav(TEST_DATA / "goforward.raw", self.folder / "go.wav")
        self.assertIn("ten_meters", self.hear(sound, "ten_meters"))

    def refuse(self, source, words, code, *parts):
        said, errors, exit_code = run("command_words", source, *USUAL,
                                      *(part for word in words for part in ("--word", word)))
        self.assertEqual(exit_code, code, errors)
        for part in parts:
            self.assertIn(part, errors.splitlines()[-1])

    def test_what_it_refuses(self):
        quiet = as_wav("/dev/null", self.folder / "quiet.wav", silence=0.1)
        self.refuse(quiet, ["hello", "helo"], 2, "`helo` is not in the dictionary", "another word")
        self.refuse(quiet, ["silence"], 2, "no word to listen for")
        self.refuse(__file__, ["hello"], 2, "is no sound")
        self.refuse("nobody", ["hello"], 3, "the microphone")  # there is none here

    def test_how_it_is_asked(self):
        quiet = as_wav("/dev/null", self.folder / "quiet.wav", silence=0.1)
        for wrong in (["--period", "0"], ["--period", "nan"], ["--strict"], ["period", "5"]):
            with self.subTest(wrong=wrong):
                _, errors, code = run("command_words", quiet, *USUAL, "--word", "hello", *wrong)
                self.assertEqual(code, 2, errors)


if __name__ == "__main__":
    unittest.main()

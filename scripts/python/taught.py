"""Measures how often own_words is right (scripts/rates), as a table.

Each word is taught with three samples, in a quiet room, and then said in other ways. There is one recording of each word that a
person says: sox makes the samples and the variants from it, faster or slower, higher or lower. Each is as loud as the others in
its loudest 20 ms, with noise before, during and after it."""

import subprocess
import sys
import tempfile
from pathlib import Path
from typing import NamedTuple

import rates
import sounds
from sounds import BYTES, NOISES_DB

PROGRAM = rates.ROOT / "build/companion/bin/robosync-own-words"
RATE = 16_000
REFUSED = 2  # companion/exit.hpp: asked_wrongly
# (tempo, pitch shift in hundredths of a semitone).
TAUGHT, SAID = ((1, 0), (0.93, -30), (1.07, 30)), ((0.87, 50), (1.13, -50), (0.96, 20))
LONGEST = 4 * RATE * BYTES  # of sounds that are none of the words
DIGITS = tuple("1 2 3 4 5 6 7 8 9 10 20 30".split())
# A synthetic voice's language, words in it, and other words; below, (speed, pitch) of the samples, and of the words that are said.
SPEAKS = {
    "de": ("German", "hallo komm stopp links rechts singen tanzen schlafen", "eins zwei banane fenster himmel regen schule lampe"),
    "cmn": ("Mandarin", "你好 停下 过来 左边 右边 唱歌 跳舞 睡觉", "苹果 电话 学校 朋友 天气 再见 老师 水"),
    "vi": ("Vietnamese", "xin_chào dừng_lại lại_đây bên_trái bên_phải hát nhảy ngủ", "táo điện_thoại trường bạn nước thời_tiết thầy hai"),
    "pt-br+f3": ("Portuguese", "olá vem pare esquerda direita canta dança dorme", "um dois banana janela chuva escola amigo água"),
    "fi": ("Finnish", "hei tule seis vasen oikea laula tanssi nuku", "yksi kaksi omena ikkuna taivas sade koulu lamppu"),
    "yue": ("Cantonese", "你好 過嚟 停低 左邊 右邊 唱歌 跳舞 瞓覺", "蘋果 電話 學校 朋友 天氣 再見 老師 水"),
    "hi+f1": ("Hindi", "नमस्ते आओ रुको बाएँ दाएँ गाओ नाचो सो_जाओ", "एक दो सेब खिड़की आकाश बारिश स्कूल दीपक"),
    "sw": ("Swahili", "habari njoo simama kushoto kulia imba cheza lala", "moja mbili ndizi dirisha anga mvua shule taa"),
}
# Those with which settings have been chosen. A voice that served for that goes here, and another one takes its place in the rates.
FOR_SETTINGS = ("de", "cmn", "vi", "pt-br+f3")
VOICE_TAUGHT, VOICE_SAID = ((150, 45), (165, 50), (180, 55)), ((140, 60), (172, 40), (195, 52))


class Set(NamedTuple):
    name: str
    taught: dict  # word to its samples
    said: list  # (word, sound)
    others: list  # sounds that are none of the words


def sox(source, effects=(), **more):
    return subprocess.run(["sox", "-R", *source, *sounds.raw(RATE), *effects], capture_output=True, check=True, **more).stdout


def loud(sound):
    return sounds.as_loud(sound, RATE)


def changed(path, tempo, cents):
    return loud(sox([path], ["pitch", str(cents), "tempo", "-s", str(tempo)]))


def digits(package):
    """({word: its recording}, the other recordings)."""
    found = rates.recordings(package, {".wav", ".gsm"})
    folder = next(path.parent for path in found if path.parent.name == "digits" and path.stem == "1")
    words = {path.stem: path for path in found if path.parent == folder and path.stem in DIGITS}
    return words, [path for path in found if path not in words.values()]


def of_people(package):
    words, others = digits(package)
    others_loud = (loud(sox([path])[:LONGEST]) for path in others[::4])
    return Set(f"12 numbers, a person ({package})",
               {word: [changed(path, *how) for how in TAUGHT] for word, path in words.items()},
               [(word, changed(path, *how)) for word, path in words.items() for how in SAID],
               [sound for sound in others_loud if sound])


def of_two_people(package, other):
    words, _ = digits(package)
    said, _ = digits(other)
    return Set(f"12 numbers, taught by a person ({package}), said by another one ({other})",
               {word: [changed(path, *how) for how in TAUGHT] for word, path in words.items()},
               [(word, loud(sox([said[word]]))) for word in words if word in said], [])


def of_voice(voice):
    def say(text, speed, pitch):
        spoken = subprocess.run(["espeak-ng", "-v", voice, "-s", str(speed), "-p", str(pitch), "--stdout", text.replace("_", " ")],
                                capture_output=True, check=True).stdout
        return loud(sox(["-t", "wav", "-"], input=spoken))
    language, *texts = SPEAKS[voice]
    words, others = (text.split() for text in texts)
    return Set(f"{len(words)} words of {language}, a synthetic voice (espeak-ng, {voice})",
               {word: [say(word, *how) for how in VOICE_TAUGHT] for word in words},
               [(word, say(word, *how)) for word in words for how in VOICE_SAID],
               [say(word, *how) for word in others for how in VOICE_TAUGHT])


def sets(settings):
    voices = [of_voice(voice) for voice in SPEAKS if (voice in FOR_SETTINGS) == settings]
    if settings:
        return [*(of_people(f"asterisk-core-sounds-{language}-wav") for language in ("en", "fr", "it")), *voices]
    return [*(of_people(f"asterisk-core-sounds-{language}-wav") for language in ("es", "ru")),
            of_two_people("asterisk-core-sounds-fr-wav", "asterisk-prompt-fr-armelle"), *voices]


def write(path, sound):
    return sounds.write(path, sound, RATE)


class Robot:
    """A file with the words of a set, and the program that listens for them. A word whose samples it refuses is one that it misses."""

    def __init__(self, folder, taught):
        self.folder = folder
        self.file = folder / "my.words"
        self.file.unlink(missing_ok=True)
        self.names = {word: f"w{i}" for i, word in enumerate(taught)}  # names in the file must be ASCII
        hiss = sounds.noise(12 * RATE * BYTES, RATE)
        for word, samples_of_it in taught.items():
            samples = [write(folder / f"sample{i}.wav", in_noise(sound, hiss, NOISES_DB[0], 0)) for i, sound in enumerate(samples_of_it)]
            done = subprocess.run([PROGRAM, "--words", self.file, "--teach", self.names[word],
                                   *(part for path in samples for part in ("--recording", path))],
                                  check=False, stdout=subprocess.DEVNULL)
            if done.returncode == REFUSED:
                self.names[word] = None
            else:
                done.check_returncode()

    def hears(self, sound):
        asked = [part for name in self.names.values() if name for part in ("--word", name)]
        done = subprocess.run([PROGRAM, "--words", self.file, "--source", write(self.folder / "said.wav", sound), "--no-pace", "--period",
                               "60000", "--shown_for", "0.1", "--strict", "50", *asked], check=True, text=True, stdout=subprocess.PIPE)
        return [line.split()[1] for line in done.stdout.splitlines() if not line.endswith(" none")]


def in_noise(sound, hiss, below, place):
    sound = bytes(RATE * BYTES) + sound + bytes(RATE * BYTES * 3 // 4)
    begin = place * 8_000 % (len(hiss) - len(sound)) // BYTES * BYTES
    return sounds.mixed(sound, hiss[begin:begin + len(sound)], below)


def counts(robot, one, below, hiss):
    """(heard, mistaken for another word, other sounds mistaken for a word)."""
    hits = wrong = alarms = 0
    for place, (word, sound) in enumerate(one.said):
        heard = robot.hears(in_noise(sound, hiss, below, place))
        hits += heard == [robot.names[word]]
        wrong += any(name != robot.names[word] for name in heard)
    for place, sound in enumerate(one.others):
        alarms += robot.hears(in_noise(sound, hiss, below, place)) != []
    return hits, wrong, alarms


def row(one, columns):
    others = f", and {len(one.others)} other sounds" if one.others else ""
    cells = (" · ".join(map(str, column if one.others else column[:2])) for column in columns)
    return f"| {one.name}: said {len(one.said)} times{others} | " + " | ".join(cells) + " |"


def table(all_sets):
    lines = sounds.head("said")
    hiss = sounds.noise(60 * RATE * BYTES, RATE)
    with tempfile.TemporaryDirectory() as name:
        for one in all_sets:
            robot = Robot(Path(name), one.taught)
            lines.append(row(one, [counts(robot, one, below, hiss) for below in NOISES_DB]))
            print(lines[-1], file=sys.stderr, flush=True)
    return "\n".join(lines)


def main():
    rates.show(table(sets("--settings" in sys.argv)), "<!-- scripts/rates: taught -->")


if __name__ == "__main__":
    main()

"""Measures how often command_words is right (scripts/rates), as a table.

It hears people in equally loud recordings, with pauses in between, and listens for as many words as a robot has. A word counts as
heard if it is named between its recording's beginning and a second after its end; anything else it names is a false alarm."""

import re
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import NamedTuple

import rates
import sounds

PROGRAM = rates.ROOT / "build/companion/bin/robosync-command-words"
PAGE = rates.ROOT / "docs/companion.md"
RATE = 16_000
LINE_MS = 20  # the period of its output when it hears nothing new
SENTENCES, WORDS = "pocketsphinx-testdata", "asterisk-core-sounds-en-g722"
DATA = Path("/usr/share/pocketsphinx/test/data")
# The words it listens for in sentences: some are in them, others are not.
LISTENED_FOR = ("forward ten meters queen clubs seven eight spades hearts four "
                "hello stop robot dance back left right music goodbye faster").split()
# The single words of one woman, by the names of her recordings; without words of one syllable, and without "echo", which is also
# in her sentences.
CALLED = {f"digits/day-{i}": word for i, word in enumerate("sunday monday tuesday wednesday thursday friday saturday".split())}
CALLED |= {f"digits/mon-{i}": word for i, word in enumerate(
    "january february - april - - july august september october november december".split()) if word != "-"}
CALLED |= {f"phonetic/{word[0]}_p": word for word in
           "alpha bravo charlie delta foxtrot hotel india juliet kilo lima oscar papa quebec romeo sierra tango uniform victor "
           "whiskey yankee zulu".split()}
USUAL = int(re.search(r"PARAMETER\(strict, \w+, (\d+)", (rates.ROOT / "companion/modules.def").read_text())[1]) // 1000


class Set(NamedTuple):
    name: str
    words: list  # words that it listens for
    said: dict  # {path of each recording: the words in it, in order}


def of_sentences(which):
    said = {DATA / "goforward.raw": "go forward ten meters"}
    for kind, transcription in (("cards", "cards.transcription"), ("librivox", "transcription")):
        for text, name in re.findall(r"<s> (.*?) *</s> \((.*)\)", (DATA / kind / transcription).read_text()):
            said[DATA / kind / f"{name}.wav"] = text
    chosen = sorted(said, key=lambda path: path.relative_to(DATA).as_posix())[which::2]
    return Set(f"{len(chosen)} sentences of several people ({SENTENCES})", LISTENED_FOR,
               {path: [word for word in said[path].split() if word in LISTENED_FOR] for path in chosen})


def of_words(which):
    """Her other recordings, with none of the words, are there for false alarms."""
    paths = rates.recordings(WORDS, {".g722"})
    words = sorted(CALLED.values())[which::2]
    by_path = {path: CALLED.get(f"{path.parent.name}/{path.stem}") for path in paths}
    alone = {path: [word] for path, word in by_path.items() if word in words}
    others = {path: [] for path in [path for path in paths if path.parent.name == "en_US_f_Allison"][which::2]}
    return [Set(f"{len(alone)} words of a woman, one by one ({WORDS})", words, alone),
            Set(f"{len(others)} other recordings of her ({WORDS})", words, others)]


def read(path):
    if path.suffix == ".g722":  # sox cannot read it
        done = subprocess.run(["ffmpeg", "-v", "error", "-nostdin", "-f", "g722", "-i", path, "-f", "s16le", "-"], capture_output=True,
                              check=True)
        return sounds.as_loud(done.stdout, RATE)
    how = sounds.raw(RATE)[:-1] if path.suffix == ".raw" else ()
    return sounds.as_loud(subprocess.run(["sox", "-R", *how, path, *sounds.raw(RATE)], capture_output=True, check=True).stdout, RATE)


def named(sound, words, strict):
    """[(time in seconds, word)]: the words that it names."""
    with tempfile.TemporaryDirectory() as folder:
        file = sounds.write(Path(folder) / "said.wav", sound, RATE)
        done = subprocess.run([PROGRAM, "--source", file, "--no-pace", "--period", str(LINE_MS), "--shown_for", "0.1", "--strict", str(strict),
                               *(part for word in words for part in ("--word", word))], check=True, text=True, stdout=subprocess.PIPE)
    time, now, found = 0, "silence", []
    for line in done.stdout.splitlines():
        word = line.split()[1]
        if word not in (now, "silence"):
            found.append((time / 1000, word))
        # A heard word is printed immediately, and once more after that block.
        time += LINE_MS * (word == now or word == "silence")
        now = word
    return found


def counts(one, places, events):
    """(words said, heard of these, false alarms)."""
    said, alarms = {path: list(words) for path, words in one.said.items()}, 0
    for time, word in events:
        here = next((path for path, begin, end in places if begin <= time <= end + 1 and word in said[path]), None)
        if here is None:
            alarms += 1
        else:
            said[here].remove(word)
    total = sum(map(len, one.said.values()))
    return total, total - sum(map(len, said.values())), alarms


def row(one, strict):
    sound, places = sounds.lay_out(one.said, read, RATE)
    hiss, cells = sounds.noise(len(sound), RATE), []
    for below in sounds.NOISES_DB:
        total, heard, alarms = counts(one, places, named(sounds.mixed(sound, hiss, below), one.words, strict))
        cells.append(f"{heard} of {total} · {alarms}" if total else f"– · {alarms}")
    minutes = sounds.seconds(sound, RATE) / 60
    return f"| {one.name}, {minutes:.1f} min; listens for {len(one.words)} | " + " | ".join(cells) + " |"


def table(which, strict=USUAL):
    sets = [of_sentences(which), *of_words(which)]
    with ThreadPoolExecutor(2) as pool:
        return "\n".join([*sounds.head("said"), *pool.map(lambda one: row(one, strict), sets)])


def main():
    if "--settings" in sys.argv:
        for strict in (45, 47, 49):
            print(f"strict {strict}\n{table(rates.half(), strict)}")
    else:
        rates.show(table(rates.half()), "<!-- scripts/rates: words -->", PAGE)


if __name__ == "__main__":
    main()
